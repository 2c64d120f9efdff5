#include "libvdbsynth/patch/layout/patch_cut.h"

#include "libvdbsynth/math/min_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace vdbsynth {
namespace {

constexpr float kClamp = 1.5f;     // [steps]
constexpr float kUnits = 64;       // of whole costs in a step
constexpr float kSurface = 0.05f;  // [steps] for a cut through any surface, however well it fits
constexpr float kLength = 0.005f;  // [steps] for a cut anywhere
constexpr std::int64_t kForced = std::int64_t(1) << 40;
constexpr std::uint32_t kOutside = 0xffffffffu;

// The part of a patch that lies over others.
class Overlap {
public:
    Overlap(const PatchField& exemplar, std::int32_t patch, int core, PatchArrangement& arrangement)
        : mExemplar(exemplar),
          mPatch(arrangement.patches[std::size_t(patch)]),
          mNumber(patch),
          mNx(mPatch.nx),
          mNy(mPatch.ny),
          mCore(core),
          mNz(arrangement.lattice.nz),
          mArrangement(arrangement),
          mFirstNode(std::size_t(mNx) * std::size_t(mNy), kOutside) {}

    bool cut() {
        measure();
        if (mMismatch.empty()) return give({});
        CutProblem problem;
        problem.yes.assign(mMismatch.size(), 0);
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j)
                if (firstNode(i, j) != kOutside) addColumn(i, j, problem);
        return give(leastCostAnswers(problem));
    }

private:
    std::uint32_t firstNode(int i, int j) const {
        return mFirstNode[std::size_t(i) * std::size_t(mNy) + std::size_t(j)];
    }
    bool inPatch(int i, int j) const { return i >= 0 && j >= 0 && i < mNx && j < mNy; }
    // Twice the distances, so that the middle of an even side has one.
    bool inCore(int i, int j) const {
        return mCore >= 0 && std::abs(2 * i + 1 - mNx) <= 2 * mCore + 1 &&
               std::abs(2 * j + 1 - mNy) <= 2 * mCore + 1;
    }
    std::ptrdiff_t sheetColumn(int i, int j) const {
        return mArrangement.columnAt(mPatch.at.i + i, mPatch.at.j + j);
    }

    void measure() {
        std::vector<float> old(mExemplar.columnLength()), moved(old);
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j) {
                const std::ptrdiff_t column = sheetColumn(i, j);
                if (column < 0 || !mArrangement.known(column) || inCore(i, j)) continue;
                mFirstNode[std::size_t(i) * std::size_t(mNy) + std::size_t(j)] =
                    std::uint32_t(mMismatch.size());
                readColumn(mExemplar, mArrangement, mPatch.at.i + i, mPatch.at.j + j, old.data());
                moveColumn(mExemplar.column(mPatch.from.i + i, mPatch.from.j + j), mNz, mPatch.fine,
                           moved.data());
                for (int k = 0; k < mNz; ++k)
                    mMismatch.push_back(
                        mismatch(old[std::size_t(k * kFieldValues)], moved[std::size_t(k * kFieldValues)]));
            }
    }

    static std::int32_t mismatch(float a, float b) {
        const float apart = std::abs(std::clamp(a, -kClamp, kClamp) - std::clamp(b, -kClamp, kClamp));
        const float surface = std::abs(a) < 1 || std::abs(b) < 1 ? kSurface : 0.f;
        return std::max(1, std::int32_t(std::lround(kUnits * (apart + surface + kLength))));
    }

    // yes: the node goes to the new patch.
    void addColumn(int i, int j, CutProblem& problem) const {
        const std::uint32_t first = firstNode(i, j);
        bool besideNew = false, besideOld = false;
        for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
            const std::ptrdiff_t column = sheetColumn(i + di, j + dj);
            if (column < 0) continue;
            const bool known = mArrangement.known(column), inside = inPatch(i + di, j + dj);
            besideOld = besideOld || (known && !inside);
            besideNew = besideNew || (inside && (!known || inCore(i + di, j + dj)));
            if (known && inside && !inCore(i + di, j + dj) && (di > 0 || dj > 0))
                for (int k = 0; k < mNz; ++k)
                    join(first + std::uint32_t(k), firstNode(i + di, j + dj) + std::uint32_t(k), problem);
        }
        for (int k = 0; k < mNz; ++k) {
            if (k + 1 < mNz) join(first + std::uint32_t(k), first + std::uint32_t(k) + 1, problem);
            if (besideOld)
                problem.yes[first + std::uint32_t(k)] = kForced;
            else if (besideNew)
                problem.yes[first + std::uint32_t(k)] = -kForced;
        }
    }

    void join(std::uint32_t a, std::uint32_t b, CutProblem& problem) const {
        const std::int32_t cost = mMismatch[a] + mMismatch[b];
        problem.edges.push_back({a, b, cost});
        problem.edges.push_back({b, a, cost});
    }

    bool give(const std::vector<std::uint8_t>& answers) {
        bool any = false;
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j) {
                const std::ptrdiff_t column = sheetColumn(i, j);
                if (column < 0) continue;
                const std::uint32_t first = firstNode(i, j);
                for (int k = 0; k < mNz; ++k) {
                    if (first != kOutside && (answers.empty() || answers[first + std::uint32_t(k)] == 0))
                        continue;
                    mArrangement.label[std::size_t(column) * std::size_t(mNz) + std::size_t(k)] = mNumber;
                    any = true;
                }
            }
        return any;
    }

    const PatchField& mExemplar;
    const LaidPatch mPatch;
    const std::int32_t mNumber;
    const int mNx, mNy, mCore, mNz;
    PatchArrangement& mArrangement;
    std::vector<std::uint32_t> mFirstNode;  // [columns of the patch]
    std::vector<std::int32_t> mMismatch;    // [nodes of the overlap]
};

}  // namespace

bool cutIntoSheet(const PatchField& exemplar, std::int32_t patch, int core, PatchArrangement& arrangement) {
    return Overlap(exemplar, patch, core, arrangement).cut();
}

}  // namespace vdbsynth
