#include "libvdbsynth/relief/transfer/relief_charts.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr float kSameRotation = 0.95f;  // cosine between tangents that neighbours in a chart carry to a site
constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

// Charts under construction.
class Charts {
public:
    Charts(const SurfaceSites& sites, const std::vector<Vec3f>& tangent, double spacing,
           const ReliefChartOptions& options, const RunContext& ctx)
        : mSites(sites),
          mField(tangent),
          mDiffers(float(options.differs * spacing)),
          mLeastCosine(float(cosine(options.maxRotation * kPi / 180))),
          mSteps(std::uint32_t(std::min(1e6, std::ceil(options.overlap / spacing)))),
          mOptions(options),
          mContext(ctx),
          mCovered(sites.size(), 0),
          mChart(sites.size(), kNever),
          mDepth(sites.size(), 0),
          mAt(sites.size()),
          mTangent(sites.size()) {}

    std::vector<ReliefChart> lay() {
        std::vector<ReliefChart> charts;
        ReliefChart largest;
        Stage stage(mContext, "charts of the sample", mSites.size());
        const std::size_t wanted = std::size_t(std::ceil(mOptions.covered * double(mSites.size())));
        for (std::uint32_t made = 0; mCount < wanted && charts.size() < mOptions.most; ++made) {
            const std::size_t before = mCount;
            ReliefChart chart = grown(made == 0 ? evenest() : farthest(), made);
            stage.advance(mCount - before);
            if (chart.site.size() > largest.site.size()) largest = chart;
            if (chart.site.size() >= mOptions.fewest) charts.push_back(std::move(chart));
            throwIfCancelled(mContext);
        }
        if (charts.empty()) charts.push_back(std::move(largest));
        return charts;
    }

private:
    // The site whose normal differs least from its neighbours'.
    std::uint32_t evenest() const {
        std::uint32_t best = 0;
        float most = -2;
        for (std::uint32_t i = 0; i < mSites.size(); ++i) {
            float least = mSites.degree(i) > 0 ? 1.f : -1.f;
            for (std::size_t k = mSites.begin[i]; k < mSites.begin[i + 1]; ++k)
                least = std::min(least, dot(mSites.normal[i], mSites.normal[mSites.neighbours[k]]));
            if (least > most) {
                most = least;
                best = i;
            }
        }
        return best;
    }

    // The uncovered site with the most steps to the next covered one; sites that no step reaches come first.
    std::uint32_t farthest() {
        std::vector<std::uint32_t> steps(mSites.size(), kNever), open;
        for (std::uint32_t i = 0; i < mSites.size(); ++i)
            if (mCovered[i]) {
                steps[i] = 0;
                open.push_back(i);
            }
        std::uint32_t last = open.back();
        for (std::size_t k = 0; k < open.size(); ++k) {
            last = open[k];
            for (std::size_t n = mSites.begin[last]; n < mSites.begin[last + 1]; ++n) {
                const std::uint32_t j = mSites.neighbours[n];
                if (steps[j] != kNever) continue;
                steps[j] = steps[last] + 1;
                open.push_back(j);
            }
        }
        const auto unreached = std::find(steps.begin(), steps.end(), kNever);
        return unreached != steps.end() ? std::uint32_t(unreached - steps.begin()) : last;
    }

    ReliefChart grown(std::uint32_t seed, std::uint32_t number) {
        ReliefChart chart;
        place(seed, number, {{0, 0}, mField[seed]}, 0);
        chart.site.push_back(seed);
        for (std::size_t k = 0; k < chart.site.size(); ++k) {
            const std::uint32_t from = chart.site[k];
            for (std::size_t n = mSites.begin[from]; n < mSites.begin[from + 1]; ++n) {
                const std::uint32_t to = mSites.neighbours[n];
                if (mChart[to] == number) continue;
                const std::uint32_t depth = mCovered[to] ? mDepth[from] + 1 : 0;
                Member member;
                if (depth > mSteps || !continued(to, number, member)) continue;
                place(to, number, member, depth);
                chart.site.push_back(to);
            }
        }
        for (std::uint32_t site : chart.site) {
            chart.at.push_back(mAt[site]);
            mCount += !mCovered[site];
            mCovered[site] = 1;
        }
        return chart;
    }

    struct Member {
        Vec2f at;
        Vec3f tangent;
    };

    void place(std::uint32_t site, std::uint32_t number, const Member& member, std::uint32_t depth) {
        mChart[site] = number;
        mDepth[site] = depth;
        mAt[site] = member.at;
        mTangent[site] = member.tangent;
    }

    Member continuedFrom(std::uint32_t from, std::uint32_t to) const {
        const SiteFrame frame = siteFrame(mSites.normal[from], mTangent[from]);
        return {mAt[from] + flattened(frame, mSites.point[to] - mSites.point[from]),
                carried(mTangent[from], mSites.normal[from], mSites.normal[to])};
    }

    // The mean of what the chart's sites around say; false where they differ, or are rotated too far.
    bool continued(std::uint32_t to, std::uint32_t number, Member& mean) const {
        Vec2f at;
        Vec3f tangent;
        std::size_t count = 0;
        const auto each = [&](const auto& take) {
            for (std::size_t n = mSites.begin[to]; n < mSites.begin[to + 1]; ++n)
                if (mChart[mSites.neighbours[n]] == number) take(continuedFrom(mSites.neighbours[n], to));
        };
        each([&](const Member& m) {
            at = at + m.at;
            tangent = tangent + m.tangent;
            ++count;
        });
        if (count == 0) return false;
        mean = {at * (1 / float(count)), tangentNear(mSites.normal[to], tangent)};
        bool agree = dot(mean.tangent, mField[to]) >= mLeastCosine - 1e-5f;
        each([&](const Member& m) {
            agree =
                agree && length(m.at - mean.at) <= mDiffers && dot(m.tangent, mean.tangent) > kSameRotation;
        });
        return agree;
    }

    const SurfaceSites& mSites;
    const std::vector<Vec3f>& mField;
    float mDiffers, mLeastCosine;
    std::uint32_t mSteps;
    const ReliefChartOptions& mOptions;
    const RunContext& mContext;
    std::vector<char> mCovered;
    std::size_t mCount = 0;
    std::vector<std::uint32_t> mChart, mDepth;
    std::vector<Vec2f> mAt;
    std::vector<Vec3f> mTangent;
};

}  // namespace

void validate(const ReliefChartOptions& options) {
    const auto require = [](bool good, const char* what) {
        if (!good) throw Error(ErrorCode::InvalidOption, what);
    };
    require(options.differs >= 0 && options.differs <= 1, "`differs`: is not between 0 and 1");
    require(options.maxRotation >= 0 && options.maxRotation <= 180,
            "`maxRotation`: is not between 0 and 180 degrees");
    require(options.overlap >= 0, "`overlap`: is below 0");
    require(options.covered >= 0 && options.covered <= 1, "`covered`: is not between 0 and 1");
    require(options.most > 0, "`most`: is 0");
}

std::vector<ReliefChart> layReliefCharts(const SurfaceSites& sites, const std::vector<Vec3f>& tangent,
                                         double spacing, const ReliefChartOptions& options,
                                         const RunContext& ctx) {
    validate(options);
    if (!(spacing > 0)) throw Error(ErrorCode::InvalidOption, "`spacing`: is not above 0");
    if (sites.size() == 0) throw Error(ErrorCode::EmptyInput, "there are no sites");
    if (tangent.size() != sites.size())
        throw Error(ErrorCode::ShapeMismatch, "sites and tangents differ in number");
    return Charts(sites, tangent, spacing, options, ctx).lay();
}

}  // namespace vdbsynth
