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
constexpr std::size_t kFine = 6000;  // nodes up to which each is a cell of its own
constexpr std::uint32_t kOutside = 0xffffffffu;

// From a cell to the next one along an axis.
struct Link {
    std::uint32_t to = 0;
    std::int32_t cost = 0;
};

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
        numberCells();
        CutProblem problem;
        problem.yes.assign(mCells, 0);
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j)
                if (firstNode(i, j) != kOutside) addColumn(i, j, problem);
        addEdges(problem);
        return give(leastCostAnswers(problem));
    }

private:
    std::uint32_t firstNode(int i, int j) const {
        return mFirstNode[std::size_t(i) * std::size_t(mNy) + std::size_t(j)];
    }
    bool inPatch(int i, int j) const { return i >= 0 && j >= 0 && i < mNx && j < mNy; }
    // Twice the distances, so that the middle of an even side has one.
    bool inCore(int i, int j) const {
        return mCore >= 0 && !mArrangement.isFixed(sheetColumn(i, j)) &&
               std::abs(2 * i + 1 - mNx) <= 2 * mCore + 1 && std::abs(2 * j + 1 - mNy) <= 2 * mCore + 1;
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

    // Cells of nodes that go to one side together: two along every axis where the overlap is large.
    void numberCells() {
        mSide = mMismatch.size() > kFine ? 2 : 1;
        const int ny = (mNy + mSide - 1) / mSide, nz = (mNz + mSide - 1) / mSide;
        std::vector<std::uint32_t> table(
            std::size_t((mNx + mSide - 1) / mSide) * std::size_t(ny) * std::size_t(nz), kOutside);
        mCell.resize(mMismatch.size());
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j) {
                const std::uint32_t first = firstNode(i, j);
                if (first == kOutside) continue;
                for (int k = 0; k < mNz; ++k) {
                    std::uint32_t& cell =
                        table[(std::size_t(i / mSide) * std::size_t(ny) + std::size_t(j / mSide)) *
                                  std::size_t(nz) +
                              std::size_t(k / mSide)];
                    if (cell == kOutside) cell = mCells++;
                    mCell[first + std::uint32_t(k)] = cell;
                }
            }
        for (auto& links : mLinks) links.assign(mCells, Link{});
    }

    // yes: the cell goes to the new patch. Of a cell with columns of both kinds the old ones decide.
    void addColumn(int i, int j, CutProblem& problem) {
        const std::uint32_t first = firstNode(i, j);
        bool besideNew = false, besideOld = mArrangement.isFixed(sheetColumn(i, j));
        for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
            const std::ptrdiff_t column = sheetColumn(i + di, j + dj);
            if (column < 0) continue;
            const bool known = mArrangement.known(column), inside = inPatch(i + di, j + dj);
            besideOld = besideOld || (known && !inside);
            besideNew = besideNew || (inside && (!known || inCore(i + di, j + dj)));
            if (known && inside && !inCore(i + di, j + dj) && (di > 0 || dj > 0))
                for (int k = 0; k < mNz; ++k)
                    join(first + std::uint32_t(k), firstNode(i + di, j + dj) + std::uint32_t(k),
                         di > 0 ? 0 : 1);
        }
        for (int k = 0; k < mNz; ++k) {
            if (k + 1 < mNz) join(first + std::uint32_t(k), first + std::uint32_t(k) + 1, 2);
            std::int64_t& yes = problem.yes[mCell[first + std::uint32_t(k)]];
            if (besideOld)
                yes = kForced;
            else if (besideNew && yes == 0)
                yes = -kForced;
        }
    }

    void join(std::uint32_t a, std::uint32_t b, std::size_t axis) {
        if (mCell[a] == mCell[b]) return;
        Link& link = mLinks[axis][mCell[a]];
        link.to = mCell[b];
        link.cost += mMismatch[a] + mMismatch[b];
    }

    void addEdges(CutProblem& problem) const {
        problem.edges.reserve(std::size_t(6) * mCells);
        for (std::uint32_t cell = 0; cell < mCells; ++cell)
            for (const auto& links : mLinks)
                if (links[cell].cost > 0) {
                    problem.edges.push_back({cell, links[cell].to, links[cell].cost});
                    problem.edges.push_back({links[cell].to, cell, links[cell].cost});
                }
    }

    bool give(const std::vector<std::uint8_t>& answers) {
        bool any = false;
        for (int i = 0; i < mNx; ++i)
            for (int j = 0; j < mNy; ++j) {
                const std::ptrdiff_t column = sheetColumn(i, j);
                if (column < 0) continue;
                const std::uint32_t first = firstNode(i, j);
                for (int k = 0; k < mNz; ++k) {
                    if (first != kOutside &&
                        (answers.empty() || answers[mCell[first + std::uint32_t(k)]] == 0))
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
    int mSide = 1;                          // of a cell
    std::uint32_t mCells = 0;
    std::vector<std::uint32_t> mCell;  // [nodes of the overlap]
    std::vector<Link> mLinks[3];       // [axis][cell] to the next cell along it
};

}  // namespace

bool cutIntoSheet(const PatchField& exemplar, std::int32_t patch, int core, PatchArrangement& arrangement) {
    return Overlap(exemplar, patch, core, arrangement).cut();
}

}  // namespace vdbsynth
