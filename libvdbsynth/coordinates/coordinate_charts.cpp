#include "libvdbsynth/coordinates/coordinate_charts.h"

#include "libvdbsynth/coordinates/coordinate_neighbourhood.h"

namespace vdbsynth {
namespace {

// Charts under construction.
class Charts {
public:
    Charts(CoordinateLevel& level, std::uint32_t number, const RunContext& ctx)
        : mLevel(level), mNumber(number), mContext(ctx), mDone(level.sites.size(), 0) {
        mLevel.coordinate.assign(level.sites.size(), {});
    }

    void lay() {
        for (std::uint32_t i = 0; i < mDone.size(); ++i) {
            if (mDone[i]) continue;
            begin(i);
            // Sites that a chart reached but not into: the next charts begin there, beside it.
            for (std::size_t k = 0; k < mEdge.size(); ++k)
                if (!mDone[mEdge[k]]) begin(mEdge[k]);
            mEdge.clear();
            throwIfCancelled(mContext);
        }
    }

private:
    void begin(std::uint32_t site) {
        const SampleLevel& sample = mLevel.samples[std::size_t(mLevel.label[site])];
        const Neighbourhood near(mLevel, site, mDone.data());
        if (near.empty()) {
            mLevel.coordinate[site] = randomSource(sample, mContext.seed, site, mNumber);
        } else {
            std::array<float, kFeature> feature;
            near.wanted(feature.data());
            mLevel.coordinate[site] = sample.centre(near.nearestNode(feature.data()));
        }
        mDone[site] = 1;
        mOpen.assign(1, site);
        for (std::size_t k = 0; k < mOpen.size(); ++k) grow(mOpen[k], sample);
    }

    void grow(std::uint32_t from, const SampleLevel& sample) {
        const SiteFrame frame = siteFrame(mLevel.sites.normal[from], mLevel.tangent[from]);
        for (std::size_t k = mLevel.sites.begin[from]; k < mLevel.sites.begin[from + 1]; ++k) {
            const std::uint32_t to = mLevel.sites.neighbours[k];
            if (mDone[to]) continue;
            const Vec2f offset = flattened(frame, mLevel.sites.point[to] - mLevel.sites.point[from]);
            const Vec2f at = mLevel.coordinate[from] + offset * (1 / float(mLevel.texel));
            if (mLevel.label[to] != mLevel.label[from] || !sample.isSource(at)) {
                mEdge.push_back(to);
                continue;
            }
            mLevel.coordinate[to] = at;
            mDone[to] = 1;
            mOpen.push_back(to);
        }
    }

    CoordinateLevel& mLevel;
    std::uint32_t mNumber;
    const RunContext& mContext;
    std::vector<char> mDone;
    std::vector<std::uint32_t> mOpen, mEdge;
};

}  // namespace

void layCharts(CoordinateLevel& level, std::uint32_t number, const RunContext& ctx) {
    Charts(level, number, ctx).lay();
}

}  // namespace vdbsynth
