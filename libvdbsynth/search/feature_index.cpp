#include "libvdbsynth/search/feature_index.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kLeaf = 12;

// The nearest within an initial bound; of equally near ones the first row.
class NearestWithin : public flann::ResultSet<float> {
public:
    explicit NearestWithin(float bound) { mMatch.squared = bound; }
    bool full() const override { return true; }
    void addPoint(float squared, std::size_t row) override {
        const bool nearer = squared < mMatch.squared ||
                            (squared == mMatch.squared && mMatch.row >= 0 && std::int32_t(row) < mMatch.row);
        if (nearer) mMatch = {std::int32_t(row), squared};
    }
    float worstDist() const override { return mMatch.squared; }
    const FeatureMatch& match() const { return mMatch; }

private:
    FeatureMatch mMatch;
};

// The nearest that are accepted, kept in order.
class NearestSome : public flann::ResultSet<float> {
public:
    NearestSome(std::size_t count, const std::function<bool(std::int32_t)>& accepted)
        : mCount(count), mAccepted(accepted) {}
    bool full() const override { return mMatches.size() == mCount; }
    void addPoint(float squared, std::size_t row) override {
        const FeatureMatch match{std::int32_t(row), squared};
        if (full() && !before(match, mMatches.back())) return;
        if (!mAccepted(match.row)) return;
        if (full()) mMatches.pop_back();
        mMatches.insert(std::upper_bound(mMatches.begin(), mMatches.end(), match, before), match);
    }
    float worstDist() const override {
        return full() ? mMatches.back().squared : std::numeric_limits<float>::max();
    }
    std::vector<FeatureMatch> take() { return std::move(mMatches); }

private:
    static bool before(const FeatureMatch& a, const FeatureMatch& b) {
        return a.squared != b.squared ? a.squared < b.squared : a.row < b.row;
    }

    std::size_t mCount;
    const std::function<bool(std::int32_t)>& mAccepted;
    std::vector<FeatureMatch> mMatches;
};

float squaredBetween(const float* a, const float* b, std::size_t dimension) {
    float sum = 0;
    for (std::size_t k = 0; k < dimension; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

}  // namespace

struct FeatureIndex::Impl {
    std::vector<float> rows;
    std::size_t dimension = 0;
    std::unique_ptr<flann::KDTreeSingleIndex<flann::L2<float>>> tree;
};

FeatureIndex::FeatureIndex(std::vector<float> rows, std::size_t dimension) : mImpl(std::make_unique<Impl>()) {
    mImpl->rows = std::move(rows);
    mImpl->dimension = dimension;
    mImpl->tree = std::make_unique<flann::KDTreeSingleIndex<flann::L2<float>>>(
        flann::Matrix<float>(mImpl->rows.data(), size(), dimension), flann::KDTreeSingleIndexParams(kLeaf));
    mImpl->tree->buildIndex();
}
FeatureIndex::FeatureIndex(FeatureIndex&&) noexcept = default;
FeatureIndex& FeatureIndex::operator=(FeatureIndex&&) noexcept = default;
FeatureIndex::~FeatureIndex() = default;

FeatureMatch FeatureIndex::nearest(const float* feature, float bound, float epsilon) const {
    NearestWithin result(bound);
    flann::SearchParams params(flann::FLANN_CHECKS_UNLIMITED, epsilon, false);
    mImpl->tree->findNeighbors(result, feature, params);
    return result.match();
}

std::vector<FeatureMatch> FeatureIndex::nearestSome(const float* feature, std::size_t count,
                                                    const std::function<bool(std::int32_t)>& accepted,
                                                    float epsilon) const {
    if (count == 0) return {};
    NearestSome result(count, accepted);
    flann::SearchParams params(flann::FLANN_CHECKS_UNLIMITED, epsilon, false);
    mImpl->tree->findNeighbors(result, feature, params);
    return result.take();
}

float FeatureIndex::squaredTo(const float* feature, std::int32_t number) const {
    return squaredBetween(feature, row(number), mImpl->dimension);
}
const float* FeatureIndex::row(std::int32_t number) const {
    return mImpl->rows.data() + std::size_t(number) * mImpl->dimension;
}
std::size_t FeatureIndex::size() const {
    return mImpl->rows.size() / mImpl->dimension;
}
std::size_t FeatureIndex::dimension() const {
    return mImpl->dimension;
}

FeatureMatch nearestLinearly(const std::vector<float>& rows, std::size_t dimension, const float* feature) {
    FeatureMatch best{-1, std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i * dimension < rows.size(); ++i) {
        const float squared = squaredBetween(feature, rows.data() + i * dimension, dimension);
        if (squared < best.squared) best = {std::int32_t(i), squared};
    }
    return best;
}

}  // namespace vdbsynth
