#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/math/line_transform.h"
#include "libvdbsynth/search/block_index.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace vdbsynth {

/// The costs of a query at all positions at once, for any mask: blockCost expanded,
///     n dist(p) = sum m E(p + i)^2 - 2 sum m E(p + i) Q(i) + sum m Q(i)^2,
/// whose first two sums are correlations, products of Fourier transforms. Two queries share one transform, as
/// its real and imaginary parts. The costs have rounding errors within a returned bound, so they only sift
/// positions; blockCost decides.
class BlockCorrelation {
public:
    /// Working memory of a call; the caller keeps it for the next one.
    struct Workspace {
        std::vector<ComplexLanes> query, mask, planes, plane, line, other, sum;
        std::vector<float> samples, costs;
    };
    /// Costs of one row of positions along z, from z = 0.
    /// @param slot  which of the two queries
    /// @param off   bound of each cost's error
    using Visit = std::function<void(int slot, int x, int y, const float* costs, int count, float off)>;

    /// Transforms of the exemplar and of its square.
    /// @param exemplar  box begins at 0   @param block  N, fits into it
    /// @throw Error Cancelled
    /// @par Cost    20 bytes a voxel, sides rounded up to products of 2, 3 and 5; O(voxels log(voxels))
    BlockCorrelation(const BrickField& exemplar, int block, const RunContext& ctx = {});

    /// Calls visit for every row of positions of the one or two queries, each with at least one known sample.
    /// @param second  may be null
    /// @par Cost    O(voxels log(voxels)) for both; 9 bytes per voxel of workspace
    /// @par Repeats yes; safe from many threads, each with a workspace of its own
    void costs(const BlockQuery& first, const BlockQuery* second, Workspace& workspace,
               const Visit& visit) const;

    /// Additions and multiplications of `costs` for one of two queries.
    double work() const { return work(mExemplar); }
    static double work(const Index3& exemplar);
    std::size_t memoryBytes() const;
    /// Memory of one, with a workspace, without making it [bytes].
    static double memoryNeeded(const Index3& exemplar, int block);

private:
    struct Slot {
        const BlockQuery* query = nullptr;
        double known = 0;
        float constant = 0;  // of the costs: the query's own mean square
        bool masked = false;
    };
    // One value of the complex field to transform: two rows of samples along z at (x, y).
    using Fill = std::function<void(int x, int y, float* real, float* imaginary)>;

    std::vector<ComplexLanes> conjugateSpectrum(const BrickField& exemplar, bool squared, double& norm,
                                                const RunContext& ctx) const;
    void transformPlane(int x, int rows, int samples, const Fill& fill, Workspace& workspace) const;
    void transformQuery(const std::array<Slot, 2>& slots, bool masks, std::vector<ComplexLanes>& lines,
                        Workspace& workspace) const;
    void multiply(bool masked, Workspace& workspace) const;
    void finishPlane(int x, const std::array<Slot, 2>& slots, float off, Workspace& workspace,
                     const Visit& visit) const;
    float mostOff(const std::array<Slot, 2>& slots) const;
    std::size_t lines() const { return std::size_t(mSize.y) * std::size_t(mSize.z / Lanes::kCount); }

    Index3 mExemplar, mSize, mPositions;  // extents of the exemplar, the transforms, the positions
    int mBlock;
    float mLargest = 0;  // |sample|
    LineTransform mAlongX, mAlongY, mAlongZ;
    // Lines along x, four neighbours along z interleaved, by z and y.
    std::vector<ComplexLanes> mConjugate, mConjugateSquares;
    double mNorm = 0, mSquaresNorm = 0, mMeanSquare = 0;
    DenseField mEnergies;  // mean square of each block, for queries without a mask
};

}  // namespace vdbsynth
