#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/io/readers/mesh_content.h"
#include "libvdbsynth/io/textured_mesh.h"

#include <string>

namespace vdbsynth {

// One reader per format, behind readMesh (mesh_file.h), which checks the corners and faces they return.
// `path` is for messages, `content` is the whole file. What a reader guesses or leaves out is a message.
// @throw Error BadData
MeshContent read3mf(const std::string& path, const std::string& content, const RunContext& ctx = {});
MeshContent readGltf(const std::string& path, const std::string& content, const RunContext& ctx = {});
MeshContent readMedit(const std::string& path, const std::string& content, const RunContext& ctx = {});
MeshContent readObj(const std::string& path, const std::string& content, const RunContext& ctx = {});
MeshContent readOff(const std::string& path, const std::string& content, const RunContext& ctx = {});
MeshContent readPly(const std::string& path, const std::string& content, const RunContext& ctx = {});
MeshContent readStl(const std::string& path, const std::string& content, const RunContext& ctx = {});

// The content of a .3mf file: an object for each solid part with its cavities, one for all open parts;
// several are components of one that is built. The same mesh gives the same bytes. @throw Error Unusable
// (over 4 GB of text)
std::string threemfBytes(const Mesh& mesh);
// True if a file of that kind holds the mesh's colours: all within 0..1.
bool holds3mfColours(const Mesh& mesh);
// The content of a .glb or .gltf file. The same mesh gives the same bytes.
std::string gltfBytes(const Mesh& mesh, bool binary);
// The same with pictures: each part shows those of its first triangle, and has one attribute `uv` a vertex.
std::string texturedGltfBytes(const std::vector<TexturedMesh>& parts,
                              const std::vector<MeshPictures>& materials, bool binary);

}  // namespace vdbsynth
