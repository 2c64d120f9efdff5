#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace vdbsynth {

/// The nearest row of a feature.
struct FeatureMatch {
    std::int32_t row = -1;  ///< negative: none
    float squared = 0;      ///< squared Euclidean distance
};

/// Nearest-neighbour search over feature vectors: a single kd-tree (FLANN's KDTreeSingleIndex, its only index
/// with repeatable results).
class FeatureIndex {
public:
    /// @param rows  [count x dimension], count at least 1
    /// @par Cost    time O(count log count), memory twice the rows
    FeatureIndex(std::vector<float> rows, std::size_t dimension);
    FeatureIndex(FeatureIndex&&) noexcept;
    FeatureIndex& operator=(FeatureIndex&&) noexcept;
    ~FeatureIndex();

    /// A row nearer than `bound` (squared): the nearest one, or with epsilon another whose squared distance
    /// is at most (1 + epsilon) times that. May be called from many threads at once.
    /// @return row -1 if none is nearer than the bound
    /// @par Repeats yes
    FeatureMatch nearest(const float* feature, float bound, float epsilon = 0) const;

    /// The `count` nearest rows among those that `accepted` lets in, nearest first, equally near ones by
    /// number; with epsilon each squared distance is at most (1 + epsilon) times the exact one's. May be
    /// called from many threads at once.
    /// @param accepted  a pure function; called once for each row that is near enough
    /// @return fewer only if no more are accepted
    /// @par Repeats yes
    std::vector<FeatureMatch> nearestSome(const float* feature, std::size_t count,
                                          const std::function<bool(std::int32_t)>& accepted,
                                          float epsilon = 0) const;

    /// Squared distance to a row.
    float squaredTo(const float* feature, std::int32_t row) const;
    const float* row(std::int32_t number) const;
    std::size_t size() const;
    std::size_t dimension() const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

/// The oracle: the nearest row, the first of equally near ones, by a linear scan.
FeatureMatch nearestLinearly(const std::vector<float>& rows, std::size_t dimension, const float* feature);

}  // namespace vdbsynth
