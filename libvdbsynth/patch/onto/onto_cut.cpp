#include "libvdbsynth/patch/onto/onto_cut.h"

#include "libvdbsynth/math/min_cut.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kClamp = 1.5f;     // [steps]
constexpr float kUnits = 64;       // of whole costs in a step
constexpr float kSurface = 0.05f;  // [steps] for a cut through any surface, however well it fits
constexpr float kLength = 0.005f;  // [steps] for a cut anywhere
constexpr std::int64_t kForced = std::int64_t(1) << 40;
constexpr std::size_t kFine = 6000;  // nodes up to which each is a cell of its own

enum class Kind : std::uint8_t { Outside, Free, Core, Overlap };

class Overlap {
public:
    Overlap(const OntoSurface& surface, const PatchField& exemplar, std::int32_t number, double core,
            OntoArrangement& arrangement)
        : mSites(surface.sites),
          mExemplar(exemplar),
          mPatch(arrangement.patches[std::size_t(number)]),
          mNumber(number),
          mNz(std::size_t(arrangement.nz)),
          mArrangement(arrangement) {
        for (std::size_t m = 0; m < mPatch.disk.size(); ++m) {
            const double away = double(length(mPatch.disk.at[m]));
            const bool inside = away <= mPatch.radius;
            mKind.push_back(!inside                                   ? Kind::Outside
                            : !arrangement.known(mPatch.disk.site[m]) ? Kind::Free
                            : away < core                             ? Kind::Core
                                                                      : Kind::Overlap);
        }
    }

    std::size_t cut() {
        measure();
        if (mMismatch.empty()) return give({});
        mPair = mMismatch.size() > kFine ? 2 : 1;
        mCells = (mNz + mPair - 1) / mPair;
        mProblem.yes.assign(mMismatch.size() / mNz * mCells, 0);
        for (std::size_t m = 0; m < mKind.size(); ++m)
            if (mKind[m] == Kind::Overlap) addColumn(m);
        return give(leastCostAnswers(mProblem));
    }

private:
    void measure() {
        std::vector<float> old(mNz * kFieldValues), now(mNz);
        mFirst.assign(mKind.size(), 0);
        for (std::size_t m = 0; m < mKind.size(); ++m) {
            if (mKind[m] != Kind::Overlap) continue;
            mFirst[m] = std::uint32_t(mMismatch.size() / mNz);
            readOnto(mExemplar, mArrangement, mPatch.disk, std::ptrdiff_t(m), mPatch.disk.at[m], old.data());
            readDistances(mExemplar, mPatch.inExemplar(mPatch.disk.at[m]), now.data());
            for (std::size_t k = 0; k < mNz; ++k)
                mMismatch.push_back(mismatch(old[k * kFieldValues], now[k]));
        }
    }

    static std::int32_t mismatch(float a, float b) {
        const float apart = std::abs(std::clamp(a, -kClamp, kClamp) - std::clamp(b, -kClamp, kClamp));
        const float surface = std::abs(a) < 1 || std::abs(b) < 1 ? kSurface : 0.f;
        return std::max(1, std::int32_t(std::lround(kUnits * (apart + surface + kLength))));
    }

    std::uint32_t cell(std::size_t m, std::size_t k) const {
        return std::uint32_t(mFirst[m] * mCells + k / mPair);
    }

    // yes: the cell goes to the new patch.
    void addColumn(std::size_t m) {
        bool besideNew = false, besideOld = false;
        const std::uint32_t site = mPatch.disk.site[m];
        for (std::size_t n = mSites.begin[site]; n < mSites.begin[site + 1]; ++n) {
            const std::uint32_t beside = mSites.neighbours[n];
            const std::ptrdiff_t other = mPatch.disk.find(beside);
            const Kind kind = other < 0 ? Kind::Outside : mKind[std::size_t(other)];
            besideOld = besideOld || (kind == Kind::Outside && mArrangement.known(beside));
            besideNew = besideNew || kind == Kind::Free || kind == Kind::Core;
            if (kind == Kind::Overlap && beside > site) join(m, std::size_t(other));
        }
        for (std::size_t k = 0; k < mNz; k += mPair) {
            if (k + mPair < mNz)
                addEdge(cell(m, k), cell(m, k + mPair), cost(m, k + mPair - 1) + cost(m, k + mPair));
            mProblem.yes[cell(m, k)] = besideOld ? kForced : besideNew ? -kForced : 0;
        }
    }

    std::int32_t cost(std::size_t m, std::size_t k) const { return mMismatch[mFirst[m] * mNz + k]; }

    void join(std::size_t a, std::size_t b) {
        for (std::size_t k = 0; k < mNz; k += mPair) {
            std::int32_t sum = 0;
            for (std::size_t at = k; at < std::min(mNz, k + mPair); ++at) sum += cost(a, at) + cost(b, at);
            addEdge(cell(a, k), cell(b, k), sum);
        }
    }

    void addEdge(std::uint32_t a, std::uint32_t b, std::int32_t cost) {
        mProblem.edges.push_back({a, b, cost});
        mProblem.edges.push_back({b, a, cost});
    }

    std::size_t give(const std::vector<std::uint8_t>& answers) {
        std::size_t given = 0;
        for (std::size_t m = 0; m < mKind.size(); ++m) {
            if (mKind[m] == Kind::Outside) continue;
            std::int32_t* labels = mArrangement.label.data() + std::size_t(mPatch.disk.site[m]) * mNz;
            for (std::size_t k = 0; k < mNz; ++k) {
                if (mKind[m] == Kind::Overlap && (answers.empty() || answers[cell(m, k)] == 0)) continue;
                labels[k] = mNumber;
                ++given;
            }
        }
        return given;
    }

    const SurfaceSites& mSites;
    const PatchField& mExemplar;
    const OntoPatch& mPatch;
    const std::int32_t mNumber;
    const std::size_t mNz;
    OntoArrangement& mArrangement;
    std::vector<Kind> mKind;              // [members]
    std::vector<std::uint32_t> mFirst;    // [members] number among the overlap's columns
    std::vector<std::int32_t> mMismatch;  // [columns of the overlap x nz]
    std::size_t mPair = 1, mCells = 0;    // nodes of a cell, cells of a column
    CutProblem mProblem;
};

}  // namespace

std::size_t cutOntoSurface(const OntoSurface& surface, const PatchField& exemplar, std::int32_t patch,
                           double core, OntoArrangement& arrangement) {
    return Overlap(surface, exemplar, patch, core, arrangement).cut();
}

}  // namespace vdbsynth
