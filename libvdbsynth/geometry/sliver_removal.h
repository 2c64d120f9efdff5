#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"

#include <cstddef>

namespace vdbsynth {

struct SliverOptions {
    double angle = 5;  ///< [degrees] above 0, to 30: a triangle with a smaller angle is a sliver
    /// [world] 0..1e30: how far the surface may move in all. With 0 it moves only within its planes.
    double tolerance = 0;
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const SliverOptions& options);

struct SliverResult {
    std::size_t before = 0;     ///< slivers of the mesh as given, its quads split along the shorter diagonal
    std::size_t left = 0;       ///< slivers of the result
    std::size_t collapses = 0;  ///< edges that were collapsed, each takes one vertex and two triangles away
    std::size_t flips = 0;      ///< edges that were flipped
};

/// Replaces slivers, triangles that solvers and slicers handle badly, by better shaped ones. A sliver has a
/// short edge (a needle) or a corner close to its longest edge (a cap); the sine of its smallest angle is
///     s = 2 area / (product of its two longest edges).
/// For each, worst first, two kinds of change are compared [botsch2010, section 6.5]: an edge from one of
/// its corners is collapsed into its other end, or one of its edges is flipped. Of those that leave fewer
/// slivers around it, or as many with a larger smallest s, the best is made. Not considered are changes that
///   - move the surface by more than `tolerance`, measured at the removed vertex, at the middles of its edges
///     and where a flipped edge crosses its successor; what earlier changes moved there is added;
///   - break the link condition [dey1999] or make an edge twice, so the topology stays;
///   - turn a normal over: 60 degrees and more for faces that are no slivers, 78 against the mean normal of
///     the faces that are replaced;
///   - remove a vertex at an open edge, or at one with more than two faces, or flip such an edge.
/// Repeated until no sliver can be improved. A closed manifold mesh stays one, with the same orientation and
/// Euler number. No vertex moves: those that stay keep position, order and attributes. Sheets that are closer
/// than `tolerance` may cross. Quads become triangles.
/// @throw Error as requireMesh (mesh_check.h); InvalidOption, Cancelled
/// @par Cost    O(faces + slivers log slivers), about 0.3 microseconds a face
/// @par Repeats yes
SliverResult removeSlivers(Mesh& mesh, const SliverOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
