#include "libvdbsynth/surface/sweep_distance.h"

#include "libvdbsynth/base/parallel.h"

#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kJump = 2;       // [voxels] residual up to which a pair is used
constexpr int kRounds = 60;       // of conjugate gradients, each time
constexpr double kEnough = 1e-4;  // of the residual at the start

class Sweep {
public:
    Sweep(const SurfaceShell& shell, const std::vector<Vec3f>& tangent, const RunContext& ctx)
        : mShell(shell), mContext(ctx), mStep(shell.neighbours.size()), mCounts(shell.neighbours.size(), 1) {
        each([&](std::size_t i) {
            for (std::uint32_t k = shell.begin[i]; k < shell.begin[i + 1]; ++k) {
                const std::size_t j = shell.neighbours[k];
                mStep[k] = dot(tangent[i] + tangent[j], shell.point[j] - shell.point[i]) / 2;
            }
        });
    }

    SweepDistance run() {
        grow();
        for (int time = 0; time < 2; ++time) {
            leaveOutJumps();
            relax();
        }
        SweepDistance result;
        result.cut = leaveOutJumps();
        result.distance.assign(mValue.begin(), mValue.end());
        return result;
    }

private:
    template <typename Work>
    void each(Work&& work) {
        parallelFor(mContext, mShell.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) work(i);
        });
    }

    // From the first voxel of each component outwards, each new one by the mean of
    // its neighbours' predictions.
    void grow() {
        mValue.assign(mShell.size(), 0);
        std::vector<char> seen(mShell.size(), 0), done(mShell.size(), 0);
        std::vector<std::uint32_t> queue;
        for (std::uint32_t first = 0; first < mShell.size(); ++first) {
            if (seen[first]) continue;
            queue.assign(1, first);
            seen[first] = 1;
            for (std::size_t next = 0; next < queue.size(); ++next) {
                const std::uint32_t i = queue[next];
                double sum = 0;
                int count = 0;
                for (std::uint32_t k = mShell.begin[i]; k < mShell.begin[i + 1]; ++k) {
                    const std::uint32_t j = mShell.neighbours[k];
                    if (done[j]) {
                        sum += mValue[j] - double(mStep[k]);
                        ++count;
                    } else if (!seen[j]) {
                        seen[j] = 1;
                        queue.push_back(j);
                    }
                }
                mValue[i] = count > 0 ? sum / count : 0;
                done[i] = 1;
            }
        }
    }

    // Share of the excluded pairs.
    double leaveOutJumps() {
        each([&](std::size_t i) {
            for (std::uint32_t k = mShell.begin[i]; k < mShell.begin[i + 1]; ++k)
                mCounts[k] = std::abs(mValue[mShell.neighbours[k]] - mValue[i] - double(mStep[k])) <= kJump;
        });
        std::size_t counted = 0;
        for (char counts : mCounts) counted += std::size_t(counts);
        return mCounts.empty() ? 0 : 1 - double(counted) / double(mCounts.size());
    }

    // L x of the graph's Laplacian.
    void apply(const std::vector<double>& x, std::vector<double>& out) {
        each([&](std::size_t i) {
            double sum = 0;
            for (std::uint32_t k = mShell.begin[i]; k < mShell.begin[i + 1]; ++k)
                if (mCounts[k]) sum += x[i] - x[mShell.neighbours[k]];
            out[i] = sum;
        });
    }
    static double product(const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    }

    void relax() {
        const std::size_t n = mShell.size();
        std::vector<double> residual(n), direction(n), image(n);
        each([&](std::size_t i) {
            double sum = 0;
            for (std::uint32_t k = mShell.begin[i]; k < mShell.begin[i + 1]; ++k)
                if (mCounts[k]) sum += mValue[mShell.neighbours[k]] - mValue[i] - double(mStep[k]);
            residual[i] = sum;
        });
        direction = residual;
        double norm = product(residual, residual);
        const double enough = norm * kEnough * kEnough;
        for (int round = 0; round < kRounds && norm > enough; ++round) {
            apply(direction, image);
            const double curvature = product(direction, image);
            if (!(curvature > 0)) return;
            const double step = norm / curvature;
            for (std::size_t i = 0; i < n; ++i) {
                mValue[i] += step * direction[i];
                residual[i] -= step * image[i];
            }
            const double next = product(residual, residual);
            for (std::size_t i = 0; i < n; ++i) direction[i] = residual[i] + direction[i] * (next / norm);
            norm = next;
        }
    }

    const SurfaceShell& mShell;
    const RunContext& mContext;
    std::vector<float> mStep;   // growth of s from i to its neighbour
    std::vector<char> mCounts;  // whether the pair is used
    std::vector<double> mValue;
};

}  // namespace

SweepDistance sweepDistance(const SurfaceShell& shell, const std::vector<Vec3f>& tangent,
                            const RunContext& ctx) {
    return Sweep(shell, tangent, ctx).run();
}

}  // namespace vdbsynth
