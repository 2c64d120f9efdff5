#include "libvdbsynth/synth/seam_cut.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/min_cut.h"
#include "libvdbsynth/synth/seam_cells.h"

#include <algorithm>
#include <array>
#include <map>

namespace vdbsynth {
namespace {

constexpr int kAbove = 16;  // seams that cross an axis kept at 1x cost this many times as much
// [64ths of a voxel] cost of each cell beyond a piece's limit. Chosen, not tuned: 23 voxels are several times
// what the seams of a cell cost where two patches agree within a voxel, so that such a cell goes to any patch
// that fits.
constexpr int kTooLong = 1500;
// [64ths of a voxel] of a cell beyond an exemplar's end
constexpr int kBeyond = 2 * NearField::kFar * kSeamCell * kSeamCell * kSeamCell;

// A shift: the offset from which a whole piece is copied.
struct Shift {
    std::int32_t exemplar = 0;
    Index3 by;
    std::vector<std::size_t> patches;  // that offer it
    IndexBox cells;                    // around the cells inside them
};

void include(IndexBox& box, const IndexBox& more) {
    if (box.empty()) box = more;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::min(box.min[axis], more.min[axis]);
        box.max[axis] = std::max(box.max[axis], more.max[axis]);
    }
}

// The shifts of a map, in the order of their first patches.
struct Shifts {
    std::vector<Shift> all;
    std::vector<std::int32_t> ofPatch;
};

// 1 for patches without a surface that were matched where none is: they fit anywhere.
std::vector<std::uint8_t> patchesWithout(const PatchLevel& level, const PatchMap& map,
                                         const BrickField& field, const RunContext& ctx) {
    std::vector<std::uint8_t> without(map.source.size());
    parallelFor(ctx, without.size(), 1024, [&](std::size_t begin, std::size_t end) {
        float own, source;
        for (std::size_t i = begin; i < end; ++i)
            without[i] = field.constantIn(IndexBox::cube(map.originOf(map.place(i)), map.block), own) &&
                         level.pass->exemplars[std::size_t(map.exemplar[i])]->constantIn(
                             IndexBox::cube(map.source[i], map.block), source);
    });
    return without;
}

Shifts shiftsOf(const PatchLevel& level, const PatchMap& map, const SeamCells& cells, const BrickField& field,
                const RunContext& ctx) {
    const std::vector<std::uint8_t> without = patchesWithout(level, map, field, ctx);
    Shifts shifts;
    std::map<std::array<int, 4>, std::int32_t> numbers;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        const Index3 place = map.place(i), by = map.source[i] - map.originOf(place);
        const auto [at, fresh] =
            numbers.try_emplace({map.exemplar[i], by.x, by.y, by.z}, std::int32_t(shifts.all.size()));
        if (fresh) shifts.all.push_back({map.exemplar[i], by, {}, {}});
        shifts.ofPatch.push_back(at->second);
        const IndexBox inside = cells.inside(place);
        if (without[i] || inside.empty()) continue;
        Shift& shift = shifts.all[std::size_t(at->second)];
        shift.patches.push_back(i);
        include(shift.cells, inside);
    }
    return shifts;
}

// The shift of each cell; one shift after another takes the cells that it improves.
//
// Between two groups of shifts:
// - mTaken gives every cell a shift whose source of the cell exists or costs kBeyond; it begins with that of
// the
//   strongest patch, so the state is a complete assignment at any time;
// - a shift's expansion changes only cells inside its own patches to that shift, and only where the energy of
//   cutSeams (seam_cut.h), with kTooLong added for marked cells, does not rise;
// - mTooLong marks cells that exceeded their piece's limit in the first assignment and no other shift has
// taken
//   since; nothing is ever marked later, since an expansion stops at the limit;
// - shifts of a group have no cells in common or beside each other, so their order does not matter.
class SeamCut {
public:
    SeamCut(const PatchLevel& level, const PatchMap& map, const BrickField& field, const RunContext& ctx)
        : mMap(map),
          mContext(ctx),
          mCells(map),
          mField(field, ctx),
          mShifts(shiftsOf(level, map, mCells, field, ctx)) {
        for (const DenseField& exemplar : level.exemplars) {
            mExemplars.emplace_back(exemplar);
            const double most = double(mExemplars.back().surfaceCells()) * level.options->longestRun;
            mMost.push_back(std::size_t(std::max(1.0, most)));
        }
        for (int axis = 0; axis < 3; ++axis)
            if (!grows(*level.options, axis, level.exemplars.front().size[axis]))
                mAcross[std::size_t(axis)] = kAbove;
        takeStrongest();
        markTooLong();
    }

    PatchMap run() {
        std::vector<IndexBox> boxes;
        for (const Shift& shift : mShifts.all) boxes.push_back(shift.cells);
        Stage stage(mContext, "cutting seams", std::max<std::size_t>(1, boxes.size()));
        // The shifts of a group take cells independently.
        for (const std::vector<std::int32_t>& group : groupsApart(boxes, mCells.count())) {
            parallelFor(mContext, group.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end; ++k) expand(group[k]);
            });
            stage.advance(group.size());
        }
        PatchMap result = mCells.blocks();
        result.allocate();
        forEachCell([&](const Index3& cell) {
            const std::size_t i = mCells.number(cell);
            const Shift& shift = mShifts.all[std::size_t(mTaken[i])];
            result.exemplar[i] = shift.exemplar;
            result.source[i] = result.originOf(cell) + shift.by;
        });
        return result;
    }

private:
    // At first every cell uses the patch with the largest weight in its middle.
    void takeStrongest() {
        mTaken.resize(mCells.total());
        forEachCell([&](const Index3& cell) {
            mTaken[mCells.number(cell)] = mShifts.ofPatch[mCells.strongestPatch(mMap, cell)];
        });
    }

    // Calls body(cell) for all cells, on all threads.
    template <typename Body>
    void forEachCell(const Body& body) const {
        const Index3 count = mCells.count();
        parallelFor(mContext, std::size_t(count.x), 1, [&](std::size_t begin, std::size_t end) {
            forEachVoxel({{int(begin), 0, 0}, {int(end) - 1, count.y - 1, count.z - 1}}, body);
        });
    }

    // Cells of pieces that are too long from the beginning are penalised.
    void markTooLong() {
        mTooLong.assign(mTaken.size(), 0);
        std::vector<std::size_t> count(mShifts.all.size(), 0);
        for (std::int32_t s : mTaken) ++count[std::size_t(s)];
        std::vector<std::vector<Index3>> cells(mShifts.all.size());
        forEachVoxel(IndexBox::fromSize(mCells.count()), [&](const Index3& cell) {
            const std::size_t s = std::size_t(mTaken[mCells.number(cell)]);
            // A shift with fewer cells than the limit is never too long.
            if (count[s] > mMost[std::size_t(mShifts.all[s].exemplar)]) cells[s].push_back(cell);
        });
        parallelFor(mContext, cells.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s)
                for (std::size_t k = nearest(mShifts.all[s], 0, cells[s]); k < cells[s].size(); ++k)
                    mTooLong[mCells.number(cells[s][k])] = 1;
        });
    }

    // Number of cells, those nearest to its middle first, that a shift may take in addition to its `had`
    // cells with a surface. Sorts them in that order if it may not take all.
    std::size_t nearest(const Shift& shift, std::size_t had, std::vector<Index3>& cells) const {
        const std::size_t most = mMost[std::size_t(shift.exemplar)];
        std::size_t all = had;
        for (const Index3& cell : cells) all += hasSurface(shift, cell);
        if (all <= most) return cells.size();
        const Index3 middle = shift.cells.min + shift.cells.max;
        const auto away = [&](const Index3& cell) {
            const Index3 apart = cell * 2 - middle;
            return std::int64_t(apart.x) * apart.x + std::int64_t(apart.y) * apart.y +
                   std::int64_t(apart.z) * apart.z;
        };
        std::stable_sort(cells.begin(), cells.end(),
                         [&](const Index3& a, const Index3& b) { return away(a) < away(b); });
        std::size_t kept = 0;
        while (kept < cells.size() && had + hasSurface(shift, cells[kept]) <= most)
            had += hasSurface(shift, cells[kept++]);
        return kept;
    }

    // The cells that one shift may take, as the nodes of a cut.
    struct Nodes {
        IndexBox box;
        std::vector<std::int32_t> numbers;  // [box] under 0: no node
        std::vector<Index3> cells;

        std::int32_t& at(const Index3& cell) { return numbers[latticeIndex(cell - box.min, box.size())]; }
        std::int32_t find(const Index3& cell) const {
            return box.contains(cell) ? numbers[latticeIndex(cell - box.min, box.size())] : -1;
        }
    };

    Nodes nodesFor(std::int32_t s) const {
        const Shift& shift = mShifts.all[std::size_t(s)];
        Nodes nodes;
        nodes.box = shift.cells;
        nodes.numbers.assign(std::size_t(nodes.box.volume()), -1);
        for (std::size_t i : shift.patches)
            forEachVoxel(mCells.inside(mMap.place(i)), [&](const Index3& cell) { nodes.at(cell) = 0; });
        std::size_t had = 0;
        forEachVoxel(nodes.box, [&](const Index3& cell) {
            if (mTaken[mCells.number(cell)] == s)
                had += hasSurface(shift, cell);
            else if (nodes.at(cell) == 0)
                nodes.cells.push_back(cell);
            nodes.at(cell) = -1;
        });
        nodes.cells.resize(nearest(shift, had, nodes.cells));
        for (std::size_t k = 0; k < nodes.cells.size(); ++k) nodes.at(nodes.cells[k]) = std::int32_t(k);
        return nodes;
    }

    void expand(std::int32_t s) {
        const Nodes nodes = nodesFor(s);
        CutProblem problem;
        problem.yes.assign(nodes.cells.size(), 0);
        for (std::size_t k = 0; k < nodes.cells.size(); ++k) {
            const std::size_t cell = mCells.number(nodes.cells[k]);
            problem.yes[k] += fromField(nodes.cells[k], s) - fromField(nodes.cells[k], mTaken[cell]);
            if (mTooLong[cell]) problem.yes[k] -= kTooLong;
            addSeams(s, nodes, k, problem);
        }
        const std::vector<std::uint8_t> answers = leastCostAnswers(problem);
        for (std::size_t k = 0; k < answers.size(); ++k) {
            if (!answers[k]) continue;
            mTaken[mCells.number(nodes.cells[k])] = s;
            mTooLong[mCells.number(nodes.cells[k])] = 0;
        }
    }

    // The seams between node k and its neighbours. For two nodes p and q that use a and b now, with V
    // the cost of a seam and s the expanding shift: V(a, b) if both are no, V(a, s) or V(s, b) if one is
    // yes, 0 if both are, which is V(a, b) + (V(s, b) - V(a, b)) p - V(s, b) q + (V(a, s) + V(s, b) -
    // V(a, b)) (1 - p) q. The last coefficient is never negative, since V is a distance, unless a cell
    // is beyond an exemplar's end.
    void addSeams(std::int32_t s, const Nodes& nodes, std::size_t k, CutProblem& problem) const {
        const Index3 cell = nodes.cells[k];
        const std::int32_t a = mTaken[mCells.number(cell)];
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
                Index3 other = cell;
                other[axis] += side;
                if (other[axis] < 0 || other[axis] >= mCells.count()[axis]) continue;
                const std::int32_t b = mTaken[mCells.number(other)], node = nodes.find(other);
                if (node >= 0 && side < 0) continue;  // the other node adds it
                const int ab = seam(axis, cell, other, a, b), sb = seam(axis, cell, other, s, b);
                problem.yes[k] += sb - ab;
                if (node < 0) continue;
                problem.yes[std::size_t(node)] -= sb;
                const int rest = seam(axis, cell, other, a, s) + sb - ab;
                if (rest > 0) problem.edges.push_back({std::uint32_t(k), std::uint32_t(node), rest});
            }
    }

    // Cost of cell p using one shift and its neighbour q another.
    int seam(int axis, const Index3& p, const Index3& q, std::int32_t a, std::int32_t b) const {
        return a == b ? 0 : mAcross[std::size_t(axis)] * (apart(p, a, b) + apart(q, a, b));
    }

    int apart(const Index3& cell, std::int32_t a, std::int32_t b) const {
        const Shift &left = mShifts.all[std::size_t(a)], &right = mShifts.all[std::size_t(b)];
        const NearField &x = mExemplars[std::size_t(left.exemplar)],
                        &y = mExemplars[std::size_t(right.exemplar)];
        const Index3 p = mCells.cornerOf(cell) + left.by, q = mCells.cornerOf(cell) + right.by;
        return x.holds(p) && y.holds(q) ? cellDifference(x, p, y, q) : kBeyond;
    }

    int fromField(const Index3& cell, std::int32_t s) const {
        const Shift& shift = mShifts.all[std::size_t(s)];
        const Index3 corner = mCells.cornerOf(cell);
        return cellDifference(mField, corner, mExemplars[std::size_t(shift.exemplar)], corner + shift.by);
    }

    bool hasSurface(const Shift& shift, const Index3& cell) const {
        return mExemplars[std::size_t(shift.exemplar)].hasSurface(mCells.cornerOf(cell) + shift.by);
    }

    const PatchMap& mMap;
    const RunContext& mContext;
    const SeamCells mCells;
    const NearField mField;
    const Shifts mShifts;
    std::vector<NearField> mExemplars;
    std::vector<std::size_t> mMost;       // [exemplar] cells with a surface in one piece
    std::array<int, 3> mAcross{1, 1, 1};  // [axis] cost factor of a seam across it
    std::vector<std::int32_t> mTaken;     // [cell] its shift
    std::vector<std::uint8_t> mTooLong;   // [cell] 1 until another shift takes it: its piece is too long
};

}  // namespace

PatchMap cutSeams(const PatchLevel& level, const PatchMap& map, const BrickField& field,
                  const RunContext& ctx) {
    return SeamCut(level, map, field, ctx).run();
}

}  // namespace vdbsynth
