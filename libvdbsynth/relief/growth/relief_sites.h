#pragma once
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth {

/// A surface with relief: sites on its base, the orientation field there, and the way from the base to the
/// surface.
struct ReliefSites {
    SurfaceSites sites;          ///< on the base
    std::vector<Vec3f> tangent;  ///< [sites] the orientation field; any length but 0, not along the normal
    std::vector<Vec3f> displacement;  ///< [sites] [world] from the base to the surface
};

/// The frame of a site: tangent, normal x tangent, normal; of length 1 and perpendicular to each other.
/// What is mapped from one site to another rigidly keeps its coordinates in their frames.
struct ReliefFrame {
    Vec3f point, tangent, binormal, normal;

    Vec3f toLocal(const Vec3f& vector) const {
        return {dot(vector, tangent), dot(vector, binormal), dot(vector, normal)};
    }
    Vec3f toWorld(const Vec3f& local) const {
        return tangent * local.x + binormal * local.y + normal * local.z;
    }
};

/// A vector of one frame in another.
inline Vec3f mapped(const Vec3f& vector, const ReliefFrame& from, const ReliefFrame& to) {
    return to.toWorld(from.toLocal(vector));
}

/// @param normal   length 1
/// @param tangent  projected to the tangent plane; any tangent where nothing is left
ReliefFrame reliefFrame(const Vec3f& point, const Vec3f& normal, const Vec3f& tangent);

/// The frames of all sites.
/// @throw Error Cancelled
std::vector<ReliefFrame> reliefFrames(const SurfaceSites& sites, const std::vector<Vec3f>& tangent,
                                      const RunContext& ctx = {});

/// @param what  begins the message, for example "the target"
/// @throw Error EmptyInput (no sites), ShapeMismatch (arrays of different lengths, a neighbour that is no
///     site), Unusable (a point, normal or tangent that is not finite)
void requireSites(const SurfaceSites& sites, const std::vector<Vec3f>& tangent, const std::string& what);
/// The same for a sample, and its displacements.
void requireReliefSites(const ReliefSites& relief, const std::string& what);

/// N(t) of all sites t: the sites within a radius of t that a walk over neighbours reaches without leaving
/// it, so that the far side of a thin wall stays out; t itself is none of them. Nearest first, equal
/// distances by number.
struct ReliefNeighbourhoods {
    std::vector<std::size_t> begin;  ///< [sites + 1] of t: member[begin[t]] to member[begin[t + 1] - 1]
    std::vector<std::uint32_t> member;
    std::vector<float> weight;  ///< w_v of eq. 1: exp(-d^2 / (2 (falloff radius)^2)) at distance d
    std::size_t cut = 0;        ///< sites of which only the nearest kMostNeighbours were taken

    std::size_t size(std::size_t site) const { return begin[site + 1] - begin[site]; }
};

inline constexpr std::size_t kMostNeighbours = 512;

/// [world] side of the square that a site has to itself, from the distances to the last of its neighbours,
/// on average; 0 if none has a neighbour. Unlike meanNearestDistance it is not misled by pairs of close
/// sites. Summed in double in the order of the sites.
double meanSpacing(const SurfaceSites& sites);

/// @param radius   [world] above 0
/// @param falloff  above 0: the Gaussian's sigma as a share of the radius
/// @throw Error Memory, Cancelled
/// @par Cost    O(sites * members)   @par Repeats same bits for any number of threads
ReliefNeighbourhoods reliefNeighbourhoods(const SurfaceSites& sites, double radius, double falloff,
                                          const RunContext& ctx = {});

}  // namespace vdbsynth
