#include "libvdbsynth/relief/transfer/relief_charts.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>

namespace vdbsynth {
namespace {

constexpr float kSameRotation = 0.95f;  // cosine between tangents that neighbours in a chart carry to a site
constexpr double kApartSpacings = 2;    // in a chart, within which only near sites may lie
constexpr double kFarSpacings = 4;      // on the surface, from which sites are not near
constexpr double kRingSpacings = 2;
constexpr double kMostRefused = 0.1;  // share of a ring at which a chart ends
constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

// Which sites lie where in a chart, so that none is laid over another: growing round a limb, a chart meets
// itself on the far side in the plane, and would show two places of the surface at one.
class Occupied {
public:
    explicit Occupied(float cell) : mCell(cell) {}

    void clear() { mSites.clear(); }
    void add(std::uint32_t site, const Vec2f& at) { mSites[key(cellOf(at.x), cellOf(at.y))].push_back(site); }

    /// True if a site that is far on the surface is within a cell's side in the chart.
    template <typename Far>
    bool taken(const Vec2f& at, const std::vector<Vec2f>& places, const Far& far) const {
        const int x = cellOf(at.x), y = cellOf(at.y);
        for (int i = x - 1; i <= x + 1; ++i)
            for (int j = y - 1; j <= y + 1; ++j) {
                const auto found = mSites.find(key(i, j));
                if (found == mSites.end()) continue;
                for (std::uint32_t site : found->second)
                    if (length(places[site] - at) < mCell && far(site)) return true;
            }
        return false;
    }

private:
    int cellOf(float x) const { return int(std::floor(x / mCell)); }
    static std::uint64_t key(int x, int y) {
        return std::uint64_t(std::uint32_t(x)) << 32 | std::uint64_t(std::uint32_t(y));
    }

    float mCell;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> mSites;
};

// How much of every ring round a chart's seed was refused.
class Rings {
public:
    explicit Rings(float width) : mWidth(width) {}

    void count(float distance, bool joined) {
        const std::size_t ring = std::size_t(distance / mWidth);
        if (ring >= mJoined.size()) {
            mJoined.resize(ring + 1);
            mRefused.resize(ring + 1);
        }
        ++(joined ? mJoined : mRefused)[ring];
    }

    /// True if the ring before that of a distance was refused to more than kMostRefused.
    bool endBefore(float distance) const {
        const std::size_t ring = std::size_t(distance / mWidth);
        if (ring == 0 || ring > mJoined.size()) return false;
        const double refused = double(mRefused[ring - 1]);
        return refused > kMostRefused * (refused + double(mJoined[ring - 1]));
    }

private:
    float mWidth;
    std::vector<std::size_t> mJoined, mRefused;
};

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
          mFar(float(kFarSpacings * spacing)),
          mRing(float(kRingSpacings * spacing)),
          mOptions(options),
          mContext(ctx),
          mOccupied(float(kApartSpacings * spacing)),
          mCovered(sites.size(), 0),
          mChart(sites.size(), kNever),
          mRefused(sites.size(), kNever),
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
    struct Member {
        Vec2f at;
        Vec3f tangent;
    };

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

    // Outward by the distance from the seed in the chart, until a ring of it is mostly refused.
    ReliefChart grown(std::uint32_t seed, std::uint32_t number) {
        ReliefChart chart;
        mOccupied.clear();
        Rings rings(mRing);
        std::priority_queue<Open> open;
        place(seed, number, {{0, 0}, mField[seed]}, 0);
        addNeighbours(seed, number, open);
        chart.site.push_back(seed);
        while (!open.empty()) {
            const Open next = open.top();
            open.pop();
            if (mChart[next.site] == number) continue;
            if (rings.endBefore(next.distance)) break;
            const std::uint32_t depth = mCovered[next.site] ? mDepth[next.from] + 1 : 0;
            if (depth > mSteps) continue;
            Member member;
            const bool joins = continued(next.site, number, member) && !overlaps(next.site, member);
            if (!joins && mRefused[next.site] == number) continue;
            rings.count(next.distance, joins);
            if (!joins) {
                mRefused[next.site] = number;
                continue;
            }
            place(next.site, number, member, depth);
            chart.site.push_back(next.site);
            addNeighbours(next.site, number, open);
        }
        finish(chart);
        return chart;
    }

    void finish(ReliefChart& chart) {
        for (std::uint32_t site : chart.site) {
            chart.at.push_back(mAt[site]);
            mCount += !mCovered[site];
            mCovered[site] = 1;
        }
    }

    // A site that a chart may take next, nearest to the seed first, ties by number.
    struct Open {
        float distance;
        std::uint32_t site, from;
        bool operator<(const Open& other) const {
            return distance != other.distance ? distance > other.distance
                   : site != other.site       ? site > other.site
                                              : from > other.from;
        }
    };

    void addNeighbours(std::uint32_t from, std::uint32_t number, std::priority_queue<Open>& open) const {
        for (std::size_t n = mSites.begin[from]; n < mSites.begin[from + 1]; ++n) {
            const std::uint32_t to = mSites.neighbours[n];
            if (mChart[to] != number) open.push({length(continuedFrom(from, to).at), to, from});
        }
    }

    bool overlaps(std::uint32_t site, const Member& member) const {
        return mOccupied.taken(member.at, mAt, [&](std::uint32_t other) {
            return length(mSites.point[other] - mSites.point[site]) > mFar;
        });
    }

    void place(std::uint32_t site, std::uint32_t number, const Member& member, std::uint32_t depth) {
        mChart[site] = number;
        mDepth[site] = depth;
        mAt[site] = member.at;
        mTangent[site] = member.tangent;
        mOccupied.add(site, member.at);
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
    float mFar, mRing;
    const ReliefChartOptions& mOptions;
    const RunContext& mContext;
    Occupied mOccupied;
    std::vector<char> mCovered;
    std::size_t mCount = 0;
    std::vector<std::uint32_t> mChart, mRefused, mDepth;
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
