#pragma once
#include "libvdbsynth/texture/point_matching.h"
#include "libvdbsynth/texture/site_queue.h"

#include <array>
#include <limits>

namespace vdbsynth {

/// Eighths of a texel.
inline constexpr int kPhases = 8;
/// Texels that are compared at once.
inline constexpr int kBlock = 32;

/// A sample read at eighths of texels, one plane for each phase and channel, with a margin all around that
/// continues it. Without room for 64 times the sample a phase is computed when asked for.
class MatchPlanes {
public:
    MatchPlanes(const SampleImage& image, int margin, bool all);

    /// Bytes of all planes.
    static double bytes(const SampleImage& image, int margin);

    std::ptrdiff_t stride() const { return mStride; }
    std::size_t planeSize() const { return std::size_t(mStride) * std::size_t(mRows); }

    /// The plane at an offset [eighths of texels]: its values at texel (x, y) moved by the offset are at
    /// [y * stride + x]. @param room  where it is computed if it is not there yet
    const float* plane(int x8, int y8, int channel, std::vector<float>& room) const;

private:
    void compute(int phaseX, int phaseY, int channel, float* out) const;

    int mMargin, mChannels;
    std::ptrdiff_t mStride, mRows;
    bool mAll;
    std::vector<float> mBase;    // [channels] planes of the texels themselves
    std::vector<float> mPhases;  // [8 x 8 x channels] planes, if all
};

/// One comparison: a plane's value at a texel with a neighbour's.
struct MatchTerm {
    const float* plane;
    float value;
};

/// Texels x0..x1-1, y0..y1-1.
struct MatchWindow {
    int x0, x1, y0, y1;
};

struct MatchBest {
    float cost = std::numeric_limits<float>::infinity();
    std::int32_t texel = std::numeric_limits<std::int32_t>::max();

    void offer(float c, std::int32_t t) {
        if (c < cost || (c == cost && t < texel)) {
            cost = c;
            texel = t;
        }
    }
};

/// The sum of squared differences at one texel, in the terms' order.
float matchCost(const std::vector<MatchTerm>& terms, std::ptrdiff_t at);

/// Compares all texels of a window, giving up on those that are already worse than the best.
void matchAll(const std::vector<MatchTerm>& terms, std::ptrdiff_t stride, int width,
              const MatchWindow& window, MatchBest& best);

/// The uncoloured sites of a level, those with the most coloured neighbours first, several at once.
class MatchQueue {
public:
    explicit MatchQueue(const MatchLevel& level);

    /// A site has got its colour.
    void raiseAround(std::uint32_t site);

    /// Up to `most` sites of which none is a neighbour of another, none with less than 3/4 of the count of
    /// the first. @param all  also sites that have no coloured neighbours of their own
    void next(std::size_t most, bool all, std::vector<std::uint32_t>& sites);

private:
    bool seesColour(std::uint32_t site) const;
    bool besideBatch(std::uint32_t site) const;
    void mark(std::uint32_t site);

    const MatchLevel& mLevel;
    const SurfaceSites& mSites;
    SiteQueue mQueue;
    std::vector<std::uint64_t> mMark;  // 2 * batch: beside a site of the batch, + 1: in it
    std::vector<SiteQueue::Entry> mAside;
    std::uint64_t mBatch = 0;
};

}  // namespace vdbsynth
