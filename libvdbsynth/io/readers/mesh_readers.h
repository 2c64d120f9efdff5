#pragma once
#include "libvdbsynth/geometry/mesh.h"

#include <string>

namespace vdbsynth {

// One reader per format, behind readMesh (mesh_file.h), which checks the indices and faces they return.
// `path` is for messages, `content` is the whole file.
// @throw Error BadData
Mesh readGltf(const std::string& path, const std::string& content);
Mesh readMedit(const std::string& path, const std::string& content);
Mesh readObj(const std::string& path, const std::string& content);
Mesh readOff(const std::string& path, const std::string& content);
Mesh readPly(const std::string& path, const std::string& content);
Mesh readStl(const std::string& path, const std::string& content);

// The content of a .glb or .gltf file. The same mesh gives the same bytes.
std::string gltfBytes(const Mesh& mesh, bool binary);

}  // namespace vdbsynth
