#pragma once
#include "libvdbsynth/coordinates/coordinate_level.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/coordinates/source_use.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vdbsynth {

inline constexpr std::size_t kMostNeighbours = 16;  ///< that a site looks at
inline constexpr float kSame = 0.6f;                ///< [steps] within which continuations are one
inline constexpr float kSameRotation = 0.95f;       ///< cosine of the angle within which they are
inline constexpr float kJump = 0.03f;  ///< of the features' variance, what a jump costs however well it fits

/// A neighbour as a site sees it.
struct Continuation {
    Vec2f here;           ///< [texels] where its coordinates continue to at the site
    Vec2f rotation;       ///< from the site's frame to its own
    Vec2f place;          ///< [texels] of the neighbour, in the site's frame
    Vec3f tangent;        ///< its tangent, carried to the site
    bool allowed = true;  ///< its tangent is within the largest rotation from the site's field
};

/// What a site gets.
struct Placed {
    Vec2f at;
    Vec3f tangent;
};

/// A site's neighbourhood and its candidates.
class Neighbourhood {
public:
    /// @param only  [sites] neighbours for which this is zero are left out; null: none is
    Neighbourhood(const CoordinateLevel& level, std::size_t site, const char* only = nullptr);

    bool empty() const { return mCount == 0; }
    std::size_t count() const { return mCount; }
    const Continuation& operator[](std::size_t k) const { return mNear[k]; }

    /// The feature that would fit: appearances at the taps, as the neighbours continue to them.
    void wanted(float* feature) const;

    /// The best of the site's own place, its neighbours' continuations and the texels like these. What
    /// continues several neighbours becomes their mean, so that charts do not shear.
    Placed best(const float* feature, float jumpFactor, const SourceUse& use) const;

    /// True if the site continues all its neighbours. @param mean  then set to their mean
    bool settled(Placed& mean) const;

    /// The mean of the continuations within some steps of a place and kSameRotation of its tangent.
    /// @return their number
    std::size_t meanNear(const Placed& placed, Placed& mean, float steps = kSame) const;

    /// The node whose feature is nearest to one, the first of equally near ones.
    std::int32_t nearestNode(const float* feature) const;

private:
    void addTap(std::size_t k, std::size_t quadrant, float* sum) const;

    std::size_t nearestTo(std::size_t quadrant) const;

    float costOf(std::int32_t node, const float* feature) const;

    struct Choice {
        Placed placed;
        float cost = std::numeric_limits<float>::infinity();
    };

    void take(const Placed& placed, std::int32_t node, float cost, const SourceUse& use,
              Choice& choice) const;

    void consider(const Placed& placed, const float* feature, float jumpFactor, float jumpCost,
                  const SourceUse& use, Choice& choice) const;

    Vec2f foldedIn(const Vec2f& at) const;

    const CoordinateLevel& mLevel;
    const SampleLevel& mSample;
    std::size_t mSite;
    std::size_t mCount = 0;
    std::array<Continuation, kMostNeighbours> mNear;
};

}  // namespace vdbsynth
