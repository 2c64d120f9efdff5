#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vdbsynth {
namespace {

constexpr double kSameWay = 0.5;     // cosine between normals of both sides
constexpr double kNearBorder = 1.2;  // [steps] from a border's node to a centre

class BorderReader {
public:
    BorderReader(const SheetSource& source, std::int32_t number)
        : mSource(source),
          mArrangement(source.arrangement),
          mNumber(number),
          mPatch(mArrangement.patches[std::size_t(number)]) {}

    BorderMoves read() {
        readNodes();
        return spreadMoves(mFound, mArrangement.lattice.step);
    }
    std::vector<BorderPair> readPairs() {
        mSparse = true;
        readNodes();
        return std::move(mPairs);
    }

private:
    void readNodes() {
        for (int i = 0; i < mPatch.nx; ++i)
            for (int j = 0; j < mPatch.ny; ++j) readColumn(i, j);
    }

    const std::int32_t* labelsAt(int i, int j) const {
        const std::ptrdiff_t column = mArrangement.columnAt(mPatch.at.i + i, mPatch.at.j + j);
        return column < 0 ? nullptr : mArrangement.label.data() + column * mArrangement.lattice.nz;
    }

    void readColumn(int i, int j) {
        const std::int32_t* here = labelsAt(i, j);
        if (!here) return;
        const std::int32_t* beside[4] = {labelsAt(i - 1, j), labelsAt(i + 1, j), labelsAt(i, j - 1),
                                         labelsAt(i, j + 1)};
        const int nz = mArrangement.lattice.nz;
        for (int k = 0; k < nz; ++k) {
            if (here[k] != mNumber || (i + j + k) % 2 != 0) continue;
            std::int32_t seen[6];
            int count = 0;
            const auto note = [&](std::int32_t other) {
                if (other != mNumber && other != PatchArrangement::kNone &&
                    std::find(seen, seen + count, other) == seen + count)
                    seen[count++] = other;
            };
            for (const std::int32_t* labels : beside)
                if (labels) note(labels[k]);
            if (k > 0) note(here[k - 1]);
            if (k + 1 < nz) note(here[k + 1]);
            for (int n = 0; n < count; ++n) addPair(i, j, k, seen[n]);
        }
    }

    // From the foot of a border's node on this side to the other side's surface.
    void addPair(int i, int j, int k, std::int32_t other) {
        const double step = mArrangement.lattice.step;
        const int si = mPatch.from.i + i, sj = mPatch.from.j + j;
        if (std::abs(mSource.field.distance(si, sj, k)) > 1.5f) return;
        const Vec3d node = mSource.field.lattice.place(si, sj, k) - mPatch.fine * step;
        const auto here = mSource.surface.project(node);
        if (!here || length(here->point - node) > kNearBorder * step) return;
        const LaidPatch& laid = mArrangement.patches[std::size_t(other)];
        const PatchPlace there = sourceColumn(mArrangement, laid, mPatch.at.i + i, mPatch.at.j + j);
        const Vec3d across = Vec3d{there.i - si + mPatch.fine.x - laid.fine.x,
                                   there.j - sj + mPatch.fine.y - laid.fine.y, mPatch.fine.z - laid.fine.z} *
                             step;
        // Where both sides are the same part of the exemplar, nothing moves, not even by a projection's
        // error.
        const bool same = length(across) == 0;
        const auto foot = same ? here : mSource.surface.project(here->point + across, here->normal);
        if (!foot || dot(foot->normal, here->normal) < kSameWay) return;
        const Vec3d move = foot->point - across - here->point;
        if (length(move) > mSource.options.limit * step) return;
        if (mSparse) {
            mPairs.push_back({here->normal, move, other});
            return;
        }
        mFound.centres.push_back(here->point);
        mFound.moves.push_back(move * 0.5);
    }

    const SheetSource& mSource;
    const PatchArrangement& mArrangement;
    const std::int32_t mNumber;
    const LaidPatch& mPatch;
    BorderMoves mFound;
    bool mSparse = false;  // every second node
    std::vector<BorderPair> mPairs;
};

}  // namespace

BorderMoves borderMoves(const SheetSource& source, std::int32_t patch) {
    return BorderReader(source, patch).read();
}

std::vector<BorderPair> borderPairs(const SheetSource& source, std::int32_t patch) {
    return BorderReader(source, patch).readPairs();
}

std::vector<std::uint8_t> borderDistance(const PatchArrangement& arrangement, int most,
                                         const RunContext& ctx) {
    const PatchLattice& l = arrangement.lattice;
    const std::size_t nz = std::size_t(l.nz);
    std::vector<std::uint8_t> distance(l.nodes(), std::uint8_t(most));
    const auto eachColumn = [&](const auto& body) {
        parallelFor(ctx, std::size_t(l.nx), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (int j = 0; j < l.ny; ++j) body(int(i), j);
        });
    };
    // Over the three by three columns around one and the three nodes around one.
    const auto around = [&](int i, int j, int k, const auto& holds) {
        for (int di = -1; di <= 1; ++di)
            for (int dj = -1; dj <= 1; ++dj) {
                const std::ptrdiff_t column = arrangement.columnAt(i + di, j + dj);
                if (column < 0) continue;
                for (int at = std::max(0, k - 1); at <= std::min(l.nz - 1, k + 1); ++at)
                    if (holds(std::size_t(column) * nz + std::size_t(at))) return true;
            }
        return false;
    };
    eachColumn([&](int i, int j) {
        for (int k = 0; k < l.nz; ++k) {
            const std::size_t node = l.column(i, j) * nz + std::size_t(k);
            if (around(i, j, k, [&](std::size_t other) {
                    return arrangement.label[other] != arrangement.label[node];
                }))
                distance[node] = 0;
        }
    });
    for (int ring = 1; ring < most; ++ring) {
        const std::vector<std::uint8_t> before = distance;
        eachColumn([&](int i, int j) {
            for (int k = 0; k < l.nz; ++k) {
                const std::size_t node = l.column(i, j) * nz + std::size_t(k);
                if (before[node] == most &&
                    around(i, j, k, [&](std::size_t other) { return before[other] == ring - 1; }))
                    distance[node] = std::uint8_t(ring);
            }
        });
    }
    return distance;
}

}  // namespace vdbsynth
