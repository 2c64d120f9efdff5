#include "libvdbsynth/coordinates/coordinate_charts.h"

#include "libvdbsynth/coordinates/coordinate_neighbourhood.h"

namespace vdbsynth {
namespace {

constexpr float kChartDiffers = 0.4f;  // [steps] most that a chart's sites may differ from their mean

// Charts under construction.
class Charts {
public:
    Charts(CoordinateLevel& level, std::uint32_t number, const RunContext& ctx)
        : mLevel(level),
          mNumber(number),
          mContext(ctx),
          mDone(level.sites.size(), 0),
          mInChart(level.sites.size(), 0) {
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
        mDone[site] = mInChart[site] = 1;
        mOpen.assign(1, site);
        for (std::size_t k = 0; k < mOpen.size(); ++k) grow(mOpen[k], sample);
        for (std::uint32_t member : mOpen) mInChart[member] = 0;
    }

    void grow(std::uint32_t from, const SampleLevel& sample) {
        for (std::size_t k = mLevel.sites.begin[from]; k < mLevel.sites.begin[from + 1]; ++k) {
            const std::uint32_t to = mLevel.sites.neighbours[k];
            if (mDone[to]) continue;
            Placed placed;
            if (mLevel.label[to] != mLevel.label[from] || !continues(from, to, placed) ||
                !sample.isSource(placed.at)) {
                mEdge.push_back(to);
                continue;
            }
            mLevel.coordinate[to] = placed.at;
            mLevel.tangent[to] = placed.tangent;
            mDone[to] = mInChart[to] = 1;
            mOpen.push_back(to);
        }
    }

    // The mean of what the chart's sites around say; false where they differ, or are rotated too far from the
    // field.
    bool continues(std::uint32_t from, std::uint32_t to, Placed& placed) const {
        const Vec3f& normal = mLevel.sites.normal[to];
        const SiteFrame frame = siteFrame(mLevel.sites.normal[from], mLevel.tangent[from]);
        const Vec2f offset = flattened(frame, mLevel.sites.point[to] - mLevel.sites.point[from]);
        placed.at = mLevel.coordinate[from] + offset * (1 / float(mLevel.texel));
        placed.tangent =
            tangentNear(normal, carried(mLevel.tangent[from], mLevel.sites.normal[from], normal));
        const Neighbourhood near(mLevel, to, mInChart.data());
        if (near.empty()) return dot(placed.tangent, mLevel.field[to]) >= mLevel.leastCosine - 1e-5f;
        return near.meanNear(placed, placed, kChartDiffers) == near.count();
    }

    CoordinateLevel& mLevel;
    std::uint32_t mNumber;
    const RunContext& mContext;
    std::vector<char> mDone, mInChart;
    std::vector<std::uint32_t> mOpen, mEdge;
};

}  // namespace

void layCharts(CoordinateLevel& level, std::uint32_t number, const RunContext& ctx) {
    Charts(level, number, ctx).lay();
}

}  // namespace vdbsynth
