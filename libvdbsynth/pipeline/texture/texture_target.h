#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/pipeline/convert/model.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// What texturing treats a target as.
enum class TargetKind { Points, Mesh, LevelSet };

/// A target of texturing: points, the vertices of a mesh, or those of a level set's zero level. Elements at
/// the same place are one site, so that they get the same colour.
struct TextureShape {
    TargetKind kind = TargetKind::Points;
    std::string name;                   ///< of its file, for messages
    Vec3d origin;                       ///< [world] that all positions are relative to
    std::vector<Vec3f> points;          ///< [elements] points or vertices
    std::vector<Triangle> triangles;    ///< [triangles] of elements; empty for points
    Attributes attributes;              ///< [elements] of the file
    std::vector<std::uint32_t> siteOf;  ///< [elements]
    std::vector<Vec3f> site;            ///< [sites] different places
    std::vector<Vec3f> normal;          ///< [sites] outward, length 1
    std::vector<Vec3f> moved;           ///< [sites] where displacement puts them; empty: where they are
    LevelSet model;                     ///< only of a level set

    /// [sites] where outputs have them.
    const std::vector<Vec3f>& placed() const { return moved.empty() ? site : moved; }
};

/// Reads a target. By extension, unless `kind` is given: a .ply and other files of points are points, other
/// meshes are meshes, everything else is a level set (loadModel). Meshes and level sets may be taken as
/// points; meshes and points as level sets, with the voxels of `options`. Normals of points are the file's,
/// else estimated (geometry/point_cloud.h); those of vertices are the mean of their faces', by area.
/// What is left out or guessed is a note.
/// @throw Error as loadModel, readMesh, readPoints; Unusable (points as a mesh)
/// @par Repeats same bits for any number of threads
TextureShape loadTarget(const std::string& path, std::optional<TargetKind> kind, const ModelOptions& options,
                        const RunContext& ctx = {});

/// The same of what is in memory already: points, the vertices of a mesh, or those of a level set's zero
/// level, which TextureShape::model keeps.
/// @param name  for messages
/// @throw Error as levelSetToMesh (vdb/convert/level_set_to_mesh.h)
/// @par Repeats same bits for any number of threads; a file's content gives what loadTarget gives
TextureShape targetOf(const PointCloud& cloud, const std::string& name, const RunContext& ctx = {});
TextureShape targetOf(const Mesh& mesh, const std::string& name, const RunContext& ctx = {});
TextureShape targetOf(const LevelSet& model, const std::string& name, const RunContext& ctx = {});

/// The kind that loadTarget takes a file as if none is given. @throw Error as holdsPoints
TargetKind kindOf(const std::string& path);

/// Sites and their normals from elements. @param normals  [elements] or empty: from triangles, or estimated
void makeSites(TextureShape& shape, const std::vector<Vec3f>& normals, const RunContext& ctx = {});

/// How far points are apart: the mean distance of a site to the nearest that faces the same way, the width of
/// a pixel at a texture's scale of 1; 0 if no site has another. [world]
/// @throw Error Cancelled   @par Cost O(sites * log sites)   @par Repeats same bits for any number of threads
double siteSpacing(const TextureShape& shape, const RunContext& ctx = {});

}  // namespace vdbsynth
