#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"

#include <cstddef>

namespace vdbsynth {

/// What correlateDensities did.
struct DensityCorrelation {
    double sample = 0, target = 0;  ///< [vertices / world^2] before
    std::size_t added = 0;          ///< vertices of the sparser one
    bool targetRefined = false;     ///< the target was the sparser one; false: the sample, or none
};

/// Meshes within this factor of each other's density stay as they are: spacings within 10 %.
inline constexpr double kSameDensity = 1.21;

/// [vertices / world^2] vertices that faces use, over area; 0 without area.
double vertexDensity(const Mesh& mesh);

/// Splits edges at their middles, the longest first, equal lengths by the vertices' numbers, until the mesh
/// has `vertices`. Splits stay in the planes of the faces, so that the surface keeps its shape and gets no
/// frequencies that it did not have ([breckon2006], planar tessellation); all faces of an edge are split
/// together, so that no gap opens. Attributes of the new vertices are the means of the edge's ends. Quads
/// become triangles.
/// @return vertices added; fewer than asked for only where every edge has length 0
/// @throw Error Memory, Cancelled
/// @par Cost    O((faces + added) log(faces + added))   @par Repeats yes
std::size_t refineToVertices(Mesh& mesh, std::size_t vertices, const RunContext& ctx = {});

/// Refines the sparser of two meshes until both have the same density of vertices, so that matching their
/// neighbourhoods does not alias. Scale the meshes first to the size at which relief is transferred.
/// @throw Error EmptyInput (a mesh without area), Memory, Cancelled
/// @par Repeats yes
DensityCorrelation correlateDensities(Mesh& sample, Mesh& target, const RunContext& ctx = {});

}  // namespace vdbsynth
