#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/math/pca.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbsynth {

inline constexpr std::size_t kAppearance = 8;  ///< numbers that describe a texel's window
inline constexpr std::size_t kFeature = 8;     ///< numbers that describe the four taps around a texel

inline constexpr std::size_t kRanks = 16;  ///< parts of a channel's values, equally many in each

/// Where neighbourhoods are compared: at (+-1, +-1) steps from the middle.
inline constexpr std::array<Vec2f, 4> kTaps{{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

/// The sample as a level of the hierarchy with sites `step` texels apart sees it [lefebvre2006, 3 and 4]: on
/// a lattice of nodes every texel's window of 5 x 5 places a step apart, reduced to its kAppearance principal
/// components (its appearance), and the appearances of the four taps around, reduced to kFeature (its
/// feature). The image is smoothed for coarse steps. Near the border of a sample that is not tileable windows
/// are mirrored, and nodes in the margin are no sources; the same holds beside texels that are not valid.
struct SampleLevel {
    double step = 1;                        ///< [texels]
    int stride = 1;                         ///< [texels] between nodes
    int width = 0, height = 0, margin = 0;  ///< [nodes]
    bool tileable = false;
    std::vector<char> usable;       ///< [height x width] 0: no source; empty: only the margin is none
    std::vector<float> appearance;  ///< [height x width x kAppearance]
    std::vector<float> feature;     ///< [height x width x kFeature]
    double spread = 0;              ///< mean squared distance of a feature from the mean of all
    std::size_t channels = 0;
    /// [height x width x channels] which sixteenth of the channel's values a node's value is in, by rank.
    std::vector<std::uint8_t> rank;
    PrincipalAxes taps;  ///< from four appearances to a feature
    std::size_t similarCount = 0;
    std::vector<std::int32_t> similar;  ///< [height x width x similarCount] nodes with a like feature, far
                                        ///< from the node and each other; -1: none

    /// The node that a coordinate lies in, folded into the sample.
    std::int32_t node(const Vec2f& at) const {
        const int x = foldedTexel(int(std::floor(at.x / float(stride))), width, tileable);
        const int y = foldedTexel(int(std::floor(at.y / float(stride))), height, tileable);
        return std::int32_t(y) * width + x;
    }
    Vec2f centre(std::int32_t node) const {
        return {(float(node % width) + 0.5f) * float(stride), (float(node / width) + 0.5f) * float(stride)};
    }
    /// False in the margin and beyond it, and beside texels that are not valid.
    bool isSource(const Vec2f& at) const {
        if (!tileable) {
            const float m = float(margin * stride);
            if (!(at.x >= m && at.y >= m && at.x < float(width * stride) - m &&
                  at.y < float(height * stride) - m))
                return false;
        }
        return usable.empty() || usable[std::size_t(node(at))] != 0;
    }
    /// out[kFeature] from [4 x kAppearance].
    void toFeature(const float* fourAppearances, float* out) const { taps.project(fourAppearances, out); }
};

/// @param step     [texels] above 0
/// @param similar  number of similar nodes kept for each, 0..8
/// @throw Error EmptyInput (no texels, or none valid), Cancelled
/// @par Cost    O(texels * channels) for the windows, and a search among at most 16384 nodes
/// @par Repeats same bits for any number of threads
SampleLevel sampleLevel(const SampleImage& image, double step, std::size_t similar,
                        const RunContext& ctx = {});

/// Fills SampleLevel::similar of a level that has features: for every source the `count` sources with the
/// nearest features, far from it and each other.
/// @throw Error Cancelled   @par Repeats same bits for any number of threads
void findSimilarNodes(SampleLevel& level, std::size_t count, const RunContext& ctx = {});

/// The image smoothed by a Gaussian. @param sigma  [texels]; at most 0.3: unchanged
SampleImage smoothed(const SampleImage& image, double sigma, const RunContext& ctx = {});

}  // namespace vdbsynth
