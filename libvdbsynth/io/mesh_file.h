#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"

#include <string>

namespace vdbsynth {

/// Kinds of mesh file, by extension.
enum class MeshFormat { Obj, Ply, Stl, Off, Medit, Gltf, Glb, ThreeMf };

/// True, with the format, if the path ends in .obj, .ply, .stl, .off, .gltf, .glb, .3mf or .mesh (MEDIT), in
/// any case; a path to read may also have .gz after that.
bool meshFormatOf(const std::string& path, MeshFormat& format);
/// The formats that writeMesh writes: all but MEDIT, never .gz.
bool writableMeshFormatOf(const std::string& path, MeshFormat& format);

/// Reads a triangle or polygon mesh. Strict: counts are checked against the file's size before memory is
/// allocated, indices against the vertices, coordinates for finiteness. STL corners with the same bits are
/// welded. Polygons of more than four corners become fans.
/// Attributes of vertices: any scalar property of ply (see groupColumns), colours of obj ("v x y z r g b")
/// and off (COFF), texture coordinates of obj (a vertex at a seam is duplicated for each), colours, texture
/// coordinates and custom attributes of glTF. Of glTF all meshes of the scene are read, with their nodes'
/// transforms, instances (EXT_mesh_gpu_instancing), skins and morph targets in their default pose; buffers
/// may be files beside it; sparse and quantised data is supported, Draco and meshopt compression (but from a
/// fallback), glTF 1.0 and other required extensions are errors that name them. What is left out is a note.
/// Of 3MF all objects that are built are read, with components, transforms and parts of other model files
/// (production extension); colours of base materials and colour groups, a vertex with several duplicated for
/// each; coordinates as they are, whatever the unit, which a message names.
/// @throw Error  Io (missing, a directory, not readable), BadData (truncated, corrupt, an index out of
///               range, NaN or infinite coordinates), EmptyInput (no faces)
/// @par Cost     O(file size) time and memory    @par Repeats yes
Mesh readMesh(const std::string& path, const RunContext& ctx = {});

/// Writes a mesh: obj text, ply and stl binary little-endian, off text, glTF with normals. Shortest decimals
/// that read back to the same floats. Attributes: ply and glTF all of them (ply colours as 8 bits where they
/// are within 0..1), obj and off colours, 3mf colours and opacity as 8
/// bits, stl none. 3mf in millimetres, an object for each solid part with its cavities; lostIn3mf says the
/// rest.
/// @param path  the file to write (see io/output_set.h for writes that cannot harm an old file)
/// @throw Error Io (cannot be created, disk full), Unusable (3mf over 4 GB of text)
void writeMesh(const std::string& path, MeshFormat format, const Mesh& mesh);

/// Names of the attributes that a .3mf file of the mesh cannot hold, with commas; empty if none.
std::string lostIn3mf(const Mesh& mesh);

/// Writes points with normals and attributes as binary ply (float x y z nx ny nz ...).
/// @throw Error Io
void writePointsPly(const std::string& path, const PointCloud& cloud);

}  // namespace vdbsynth
