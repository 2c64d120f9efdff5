#pragma once
#include "libvdbsynth/coordinates/coordinate_level.h"

namespace vdbsynth {

/// How often every part of the samples, and every part of their values, is used by a level's sites, and what
/// more use costs. Matching alone prefers what is easily matched: bland places spread, and the result's
/// histogram is not the sample's [kopf2007, 3.2, reweights votes for the same reason].
class SourceUse {
public:
    /// @param uniformity, histogram  as in CoordinateOptions
    SourceUse(const CoordinateLevel& level, double uniformity, double histogram);

    /// Counts the level's coordinates as they are.
    void count(const CoordinateLevel& level);

    /// What a node of a sample costs beside its feature's distance: the sample's spread times the weights
    /// times (use / expected use - 1), of the part of the sample, and the mean of that over the channels'
    /// values; use counts to four times what is expected. Below 0 where there is less use than expected.
    /// Weights fall to 0 on levels as fine as the texels, which keep what coarser ones balanced, and where
    /// sites are few.
    float cost(std::int32_t label, std::int32_t node) const {
        return mSamples[std::size_t(label)].cost[std::size_t(node)];
    }

private:
    struct Sample {
        std::vector<std::uint32_t> part;     // [nodes] of the sample's area
        std::vector<double> expectedInPart;  // [parts] share of the sources
        std::vector<double> expectedOfRank;  // [channels x kRanks] share of the sources
        std::vector<std::uint32_t> usedNode;
        std::vector<float> cost;  // [nodes]
    };
    void weigh(const SampleLevel& level, Sample& sample) const;

    double mUniformity, mHistogram;
    std::vector<Sample> mSamples;
};

}  // namespace vdbsynth
