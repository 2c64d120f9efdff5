#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A surface that patches are laid over: in place of the columns of a sheet's lattice it has sites about a
/// field step apart, each with a frame.
struct OntoSurface {
    SurfaceSites sites;                ///< neighbours of each other both ways, ascending
    std::vector<Vec3f> tangent;        ///< [sites] length 1: where the exemplar's first axis runs
    std::vector<Vec3d> singularities;  ///< where no direction is continuous, one place each
};

/// @param points      [sites] finite, about `spacing` apart   @param normals  [sites] outward, length 1
/// @param directions  [sites] of the exemplar's first axis, 0 where none is given; empty: the smoothest field
/// @throw Error EmptyInput (no points), ShapeMismatch (other numbers), InvalidOption (a spacing that is not
/// above 0), Unusable (directions only along normals), Cancelled
/// @par Cost    O(n log n)   @par Repeats same bits for any number of threads
OntoSurface ontoSurface(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                        const std::vector<Vec3f>& directions, double spacing, const RunContext& ctx = {});

/// The same with directions that are known already, as of a surface that was kept.
/// @param tangents  [sites] length 1
/// @throw Error EmptyInput, ShapeMismatch, Cancelled   @par Repeats as ontoSurface
OntoSurface ontoSurfaceAlong(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                             std::vector<Vec3f> tangents, const RunContext& ctx = {});

}  // namespace vdbsynth
