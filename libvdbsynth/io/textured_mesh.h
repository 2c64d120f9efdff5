#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/math/vec2.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth {

/// The pictures of one material, each the bytes of a PNG file; empty: none.
struct MeshPictures {
    std::string name;
    std::string colour;     ///< sRGB
    std::string roughness;  ///< green: roughness, blue: metalness (glTF's order)
    std::string normal;     ///< tangent space, +u red, +v green
    bool repeats = true;    ///< outside 0..1; else mirrored
};

/// A mesh of triangles that shows pictures.
struct TexturedMesh {
    Mesh mesh;                            ///< triangles only
    std::vector<Vec3f> normals;           ///< [vertices] length 1
    std::vector<Vec2f> corner;            ///< [triangles x 3] picture coordinates, 0..1, v up
    std::vector<std::uint32_t> pictures;  ///< [triangles] number in `materials`
    std::vector<MeshPictures> materials;
    std::vector<std::string> comments;  ///< lines for formats with comments
};

/// Writes .glb or .gltf: a primitive for each material, vertices duplicated where corners differ, pictures
/// embedded, wrapped by repeating or mirroring. Colours of vertices (Cd) are the custom attribute _Cd: glTF
/// multiplies COLOR_0 with the picture. @throw Error Io, Solver
void writeTexturedGltf(const std::string& path, bool binary, const TexturedMesh& textured);

/// Writes .obj: colours of vertices, `vt` and `vn`, faces by material; comments begin with #. No pictures.
/// @throw Error Io
void writeTexturedObj(const std::string& path, const TexturedMesh& textured);

/// writeMesh and writePointsPly (mesh_file.h) for .ply with normals and comments. @throw Error Io
void writePly(const std::string& path, const Mesh& mesh, const std::vector<Vec3f>& normals,
              const std::vector<std::string>& comments);
void writePly(const std::string& path, const PointCloud& cloud, const std::vector<std::string>& comments);

/// The comments in a .ply file's header, in order, without the word. @throw Error Io, BadData
std::vector<std::string> plyComments(const std::string& path);

}  // namespace vdbsynth
