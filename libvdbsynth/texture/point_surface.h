#pragma once
#include "libvdbsynth/points/surface_sites.h"
#include "libvdbsynth/texture/point_chart.h"
#include "libvdbsynth/texture/surface_texture.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// How the texture stands where no direction is given [zhang2004, 3.2].
enum class PointOrientation {
    Up,     ///< +v is the projection of `up` on the tangent plane
    Random  ///< drawn at every point
};

struct PointOrientationOptions {
    PointOrientation orientation = PointOrientation::Up;
    Vec3f up{0, 1, 0};  ///< not 0
};

/// A target as the paper's three methods work on it: a graph of neighbours, numbered along a Morton curve, so
/// that what lies near in space lies near in memory.
struct PointSurface {
    SurfaceSites sites;
    std::vector<Vec3f> direction;      ///< [sites] as the target's; empty: none given
    std::vector<std::uint32_t> order;  ///< [sites] the target's number of each
    double spacing = 1;  ///< [world] mean distance to the nearest; 1 where no point has a neighbour
};

/// The target's labels are not used: these methods take one sample.
/// @param neighbours  of each point, 3..256
/// @throw Error as requireTarget, InvalidOption (neighbours), Memory, Cancelled
/// @par Repeats same bits for any number of threads
PointSurface pointSurface(const TextureTarget& target, int neighbours, const RunContext& ctx = {});

/// The direction of +u at a site: the given one where there is one, else as the options say.
Vec3f siteTangent(const PointSurface& surface, std::size_t site, const PointOrientationOptions& options,
                  std::uint64_t seed);

/// siteTangent at all sites.
/// @par Repeats same bits for any number of threads
std::vector<Vec3f> siteTangents(const PointSurface& surface, const PointOrientationOptions& options,
                                const RunContext& ctx = {});

/// In double, length 1.
inline Vec3d siteNormal(const SurfaceSites& sites, std::size_t site) {
    return normalized(cast<double>(sites.normal[site]));
}

/// The middle of a new patch.
ChartSite seedChart(const SurfaceSites& sites, std::size_t site, const Vec3f& tangent);

/// A chart's direction on the surface itself, of length 1.
Vec3f surfaceTangent(const PointSurface& surface, std::size_t site, const Vec3d& direction);

/// @throw Error InvalidOption (an up vector of length 0 or not finite)
void validate(const PointOrientationOptions& options);

/// A result per site, renumbered as the target's points.
TexturedSites inTargetOrder(const TexturedSites& sites, const std::vector<std::uint32_t>& order);

/// All places of a result of `sites` sites, without colour.
TexturedSites uncoloured(std::size_t sites, int channels);

/// @throw Error EmptyInput (no texels or channels), ShapeMismatch (not as many values as it says), Unusable
/// (values that are not finite)
void requireSample(const SampleImage& sample);

/// The numbers 0 to count - 1, each once, drawn by (seed, purpose).
class RandomOrder {
public:
    RandomOrder(std::size_t count, std::uint64_t seed, std::uint32_t purpose);
    /// The next number that `wanted` accepts, or `count` if there is none. Numbers it refuses do not come
    /// again.
    template <typename Wanted>
    std::uint32_t next(const Wanted& wanted) {
        while (mDone < mNumbers.size()) {
            const std::uint32_t number = draw();
            if (wanted(number)) return number;
        }
        return std::uint32_t(mNumbers.size());
    }

private:
    std::uint32_t draw();

    std::vector<std::uint32_t> mNumbers;
    std::size_t mDone = 0;
    std::uint64_t mSeed;
    std::uint32_t mPurpose;
};

}  // namespace vdbsynth
