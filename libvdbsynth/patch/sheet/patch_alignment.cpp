#include "libvdbsynth/patch/sheet/patch_alignment.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kRounds = 2;
constexpr double kStay = 1e-3;  // of the weight of a place, that a patch stays where it is
constexpr double kMost = 1.5;   // [steps]

// The normal equations over two unknowns a patch.
class Adjustment {
public:
    explicit Adjustment(std::size_t patches)
        : mSize(Eigen::Index(2 * patches)), mRight(Eigen::VectorXd::Zero(mSize)), mOwn(patches, 1e-6) {}

    void add(std::int32_t patch, const BorderPair& pair) {
        const double n[2] = {pair.normal.x, pair.normal.y}, apart = dot(pair.normal, pair.move);
        const Eigen::Index k = 2 * patch, l = 2 * pair.other;
        for (int r = 0; r < 2; ++r) {
            for (int c = 0; c < 2; ++c) {
                const double product = n[r] * n[c];
                mEntries.emplace_back(k + r, k + c, product);
                mEntries.emplace_back(l + r, l + c, product);
                mEntries.emplace_back(k + r, l + c, -product);
                mEntries.emplace_back(l + r, k + c, -product);
            }
            mRight[k + r] += n[r] * apart;
            mRight[l + r] -= n[r] * apart;
        }
        mOwn[std::size_t(patch)] += kStay;
    }

    Eigen::VectorXd solved() {
        for (std::size_t p = 0; p < mOwn.size(); ++p)
            for (int r = 0; r < 2; ++r)
                mEntries.emplace_back(2 * Eigen::Index(p) + r, 2 * Eigen::Index(p) + r, mOwn[p]);
        Eigen::SparseMatrix<double> matrix(mSize, mSize);
        matrix.setFromTriplets(mEntries.begin(), mEntries.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
        if (factor.info() != Eigen::Success) return Eigen::VectorXd::Zero(mSize);
        return factor.solve(mRight);
    }

private:
    Eigen::Index mSize;
    std::vector<Eigen::Triplet<double>> mEntries;
    Eigen::VectorXd mRight;
    std::vector<double> mOwn;
};

}  // namespace

double alignPatches(const PatchExemplar& exemplar, const PointSetSurface& surface, const PatchField& field,
                    PatchArrangement& arrangement, const RunContext& ctx) {
    const SheetOptions options;
    const std::vector<LaidPatch> laid = arrangement.patches;
    const double step = arrangement.lattice.step;
    Stage stage(ctx, "aligning patches", kRounds);
    for (int round = 0; round < kRounds; ++round) {
        const SheetSource source{exemplar, surface, field, arrangement, options};
        std::vector<std::vector<BorderPair>> pairs(laid.size());
        parallelFor(ctx, laid.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) pairs[p] = borderPairs(source, std::int32_t(p));
        });
        Adjustment adjustment(laid.size());
        for (std::size_t p = 0; p < pairs.size(); ++p)
            for (const BorderPair& pair : pairs[p]) adjustment.add(std::int32_t(p), pair);
        const Eigen::VectorXd moves = adjustment.solved();
        for (std::size_t p = 0; p < laid.size(); ++p) {
            Vec3d& fine = arrangement.patches[p].fine;
            const Eigen::Index at = 2 * Eigen::Index(p);
            fine.x = std::clamp(fine.x + moves[at] / step, laid[p].fine.x - kMost, laid[p].fine.x + kMost);
            fine.y =
                std::clamp(fine.y + moves[at + 1] / step, laid[p].fine.y - kMost, laid[p].fine.y + kMost);
        }
        stage.advance();
    }
    double sum = 0;
    for (std::size_t p = 0; p < laid.size(); ++p) {
        const Vec3d moved = arrangement.patches[p].fine - laid[p].fine;
        sum += dot(moved, moved);
    }
    return laid.empty() ? 0 : std::sqrt(sum / double(laid.size()));
}

}  // namespace vdbsynth
