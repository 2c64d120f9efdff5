#pragma once
#include "libvdbsynth/surface/surface_shell.h"

#include <vector>

namespace vdbsynth {

/// Unit tangents on a surface.
struct DirectionField {
    std::vector<Vec3f> tangent;        ///< length 1, perpendicular to the normal, one per site
    std::size_t known = 0;             ///< sites whose direction was given, not diffused
    std::vector<Vec3f> singularities;  ///< one position in each region without a continuous direction
};

/// Extends directions given at some sites to all of them [turk2001]: given directions are projected to the
/// tangent plane and stay; the others are averaged over their neighbours in rounds, coarse to fine. Only
/// directions within 35 degrees of the surface are used: an axis that meets a surface more steeply determines
/// little there, and its projection has a singularity at every bump (53 on a bunny, 10 with the limit). On a
/// component of the surface with less than a quarter of such directions, the limit is 90 % of the sine that
/// its best quarter reaches; directions within 10 degrees of the normal are never used. A site is singular
/// where the mean of its own and its neighbours' directions is shorter than 0.7.
/// @param places  [sites] their cells on a lattice about as fine as the sites (sitePlaces): what shares a
/// cell
///                of 2^3 of them is merged on the next coarser level
/// @param given   [sites] any length, 0 where none is given
/// @throw Error Unusable (no direction is given, or only along normals)
/// @par Cost    O(sites * rounds of averaging)
/// @par Repeats same bits for any number of threads
DirectionField directionField(const SurfaceSites& sites, const std::vector<Index3>& places,
                              const std::vector<Vec3f>& given, const RunContext& ctx = {});
/// The same for a shell, whose voxels are the places.
DirectionField directionField(const SurfaceShell& shell, const std::vector<Vec3f>& given,
                              const RunContext& ctx = {});

/// The smoothest field that averaging finds, where no direction matters: begun on the coarsest level along
/// `axis`, none kept. It has few singularities. `known` is 0.
/// @param axis  not zero
DirectionField smoothDirectionField(const SurfaceSites& sites, const std::vector<Index3>& places,
                                    const Vec3f& axis, const RunContext& ctx = {});

/// The cells of side `cell` that sites lie in. @param cell  above 0
std::vector<Index3> sitePlaces(const SurfaceSites& sites, double cell);

}  // namespace vdbsynth
