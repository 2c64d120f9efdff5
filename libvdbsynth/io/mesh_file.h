#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"

#include <string>

namespace vdbsynth {

/// Kinds of mesh file, by extension.
enum class MeshFormat { Obj, Ply, Stl, Off, Medit };

/// True, with the format, if the path ends in .obj, .ply, .stl, .off or .mesh (MEDIT), any case; for a path
/// to read also with .gz after that.
bool meshFormatOf(const std::string& path, MeshFormat& format);
/// The formats that writeMesh writes: all but MEDIT, never .gz.
bool writableMeshFormatOf(const std::string& path, MeshFormat& format);

/// Reads a triangle or polygon mesh. Strict: counts are checked against the file's size before anything
/// is allocated, indices against the vertices, coordinates for finiteness. STL corners with the same bits
/// are welded. Polygons of more than four corners become fans; texture coordinates, colours and unknown
/// properties are passed over.
/// @throw Error  Io (missing, a directory, not readable), BadData (truncated, corrupt, an index out of
///               range, NaN or infinite coordinates), EmptyInput (no faces)
/// @par Cost     O(file size) time and memory    @par Repeats yes
Mesh readMesh(const std::string& path, const RunContext& ctx = {});

/// Writes a mesh: obj text, ply and stl binary little-endian, off text. Shortest decimals that read
/// back to the same floats.
/// @param path  the file to write (see io/output_set.h for writes that cannot harm an old file)
/// @throw Error Io (cannot be created, disk full)
void writeMesh(const std::string& path, MeshFormat format, const Mesh& mesh);

/// Writes points with normals as binary ply (float x y z nx ny nz).
/// @throw Error Io
void writePointsPly(const std::string& path, const PointCloud& cloud);

}  // namespace vdbsynth
