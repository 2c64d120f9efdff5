#include "libvdbsynth/synth/seam_cells.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vdbsynth {
namespace {

constexpr int kMostMargin = 2;               // [voxels]
constexpr int kOccupancy = 2;                // side of the regions that are marked as taken
constexpr std::size_t kGroupsLookedAt = 64;  // as many as a word has bits

std::int8_t nearValue(float distance) {
    const int value = int(std::lround(double(distance) * 64));
    return std::int8_t(std::clamp(value, -NearField::kFar, NearField::kFar));
}

// The parts of kOccupancy^3 places that a box and what touches it lie in.
std::vector<std::size_t> partsAround(const IndexBox& box, const Index3& parts) {
    IndexBox around = box.expanded(1);
    for (int axis = 0; axis < 3; ++axis) {
        around.min[axis] = std::max(0, around.min[axis]) / kOccupancy;
        around.max[axis] = std::min(around.max[axis] / kOccupancy, parts[axis] - 1);
    }
    std::vector<std::size_t> all;
    forEachVoxel(around, [&](const Index3& p) { all.push_back(latticeIndex(p, parts)); });
    return all;
}

}  // namespace

NearField::NearField(const BrickField& field, const RunContext& ctx)
    : mSize(field.box().size()), mSamples(latticeCount(field.box().size())) {
    const std::size_t samples = std::size_t(mSize.y) * std::size_t(mSize.z);
    parallelFor(ctx, std::size_t(mSize.x), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<float> plane(samples);
        for (std::size_t x = begin; x < end; ++x) {
            field.readBox({int(x), 0, 0}, {1, mSize.y, mSize.z}, plane.data());
            std::transform(plane.begin(), plane.end(), mSamples.begin() + std::ptrdiff_t(x * samples),
                           nearValue);
        }
    });
}

NearField::NearField(const DenseField& field) : mSize(field.size), mSamples(field.samples.size()) {
    std::transform(field.samples.begin(), field.samples.end(), mSamples.begin(), nearValue);
}

bool NearField::hasSurface(const Index3& corner) const {
    for (int x = 0; x < kSeamCell; ++x)
        for (int y = 0; y < kSeamCell; ++y)
            for (int z = 0; z < kSeamCell; ++z)
                if (std::abs(*at(corner + Index3{x, y, z})) < kFar) return true;
    return false;
}

std::size_t NearField::surfaceCells() const {
    std::size_t count = 0;
    const IndexBox corners{{0, 0, 0}, mSize - Index3{kSeamCell, kSeamCell, kSeamCell}};
    forEachVoxel(
        corners, [&](const Index3& corner) { count += hasSurface(corner); }, kSeamCell);
    return count;
}

int cellDifference(const NearField& a, const Index3& p, const NearField& b, const Index3& q) {
    int sum = 0;
    for (int x = 0; x < kSeamCell; ++x)
        for (int y = 0; y < kSeamCell; ++y) {
            const std::int8_t *left = a.at(p + Index3{x, y, 0}), *right = b.at(q + Index3{x, y, 0});
            for (int z = 0; z < kSeamCell; ++z) sum += std::abs(left[z] - right[z]);
        }
    return sum;
}

SeamCells::SeamCells(const PatchMap& map) {
    // Patches begin a stride apart, so a range of at most this length lies inside one.
    const int longest = map.block - map.stride + 1;
    const int margin = std::clamp((longest - kSeamCell) / 2, 0, kMostMargin);
    mBlocks.target = map.target;
    mBlocks.stride = kSeamCell;
    mBlocks.block = kSeamCell + 2 * margin;
    mCount = mBlocks.lattice();
    mPatches = map.lattice();
    for (int i = 0; i < map.block; ++i) mWeights.push_back(voteWeight(map.block, i));
    for (int axis = 0; axis < 3; ++axis) {
        for (int c = 0; c < mCount[axis]; ++c) mCorners[axis].push_back(mBlocks.origin(axis, c) + margin);
        mPatchesOver[axis].assign(std::size_t(mCount[axis]), {mPatches[axis], -1});
        for (int a = 0; a < mPatches[axis]; ++a) {
            const int begin = map.origin(axis, a), end = begin + map.block;
            mOrigins[axis].push_back(begin);
            Span cells{0, -1};
            for (int c = begin / kSeamCell; c < mCount[axis]; ++c) {
                const int at = mCorners[axis][std::size_t(c)] - margin;
                if (at < begin || at + mBlocks.block > end) continue;
                cells = {cells.last < 0 ? c : cells.first, c};
                Span& over = mPatchesOver[axis][std::size_t(c)];
                over = {std::min(over.first, a), a};
            }
            mCellsInside[axis].push_back(cells);
        }
    }
}

IndexBox SeamCells::inside(const Index3& patch) const {
    IndexBox cells;
    for (int axis = 0; axis < 3; ++axis) {
        const Span& span = mCellsInside[axis][std::size_t(patch[axis])];
        cells.min[axis] = span.first;
        cells.max[axis] = span.last;
    }
    return cells;
}

std::size_t SeamCells::strongestPatch(const PatchMap& map, const Index3& cell) const {
    const Index3 middle = cornerOf(cell) + Index3{kSeamCell / 2, kSeamCell / 2, kSeamCell / 2};
    const Span x = mPatchesOver[0][std::size_t(cell.x)], y = mPatchesOver[1][std::size_t(cell.y)],
               z = mPatchesOver[2][std::size_t(cell.z)];
    const auto weight = [&](int axis, int patch) {
        return mWeights[std::size_t(middle[axis] - mOrigins[axis][std::size_t(patch)])];
    };
    std::size_t best = 0;
    float most = -1;
    forEachVoxel({{x.first, y.first, z.first}, {x.last, y.last, z.last}}, [&](const Index3& patch) {
        const std::size_t i = latticeIndex(patch, mPatches);
        const float say = weight(0, patch.x) * weight(1, patch.y) * weight(2, patch.z) *
                          (map.weight.empty() ? 1.f : map.weight[i]);
        if (say <= most) return;
        most = say;
        best = i;
    });
    return best;
}

std::vector<std::vector<std::int32_t>> groupsApart(const std::vector<IndexBox>& boxes, const Index3& count) {
    Index3 parts;
    for (int axis = 0; axis < 3; ++axis) parts[axis] = count[axis] / kOccupancy + 1;
    std::vector<std::vector<std::int32_t>> groups;
    // [part] a bit for each of the last groups that has a box there: group g has bit g % kGroupsLookedAt
    std::vector<std::uint64_t> taken(latticeCount(parts), 0);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].empty()) continue;
        const std::vector<std::size_t> wanted = partsAround(boxes[i], parts);
        std::uint64_t without = 0;
        for (std::size_t part : wanted) without |= taken[part];
        std::size_t g = groups.size() - std::min(groups.size(), kGroupsLookedAt);
        while (g < groups.size() && (without >> g % kGroupsLookedAt & 1)) ++g;
        const std::uint64_t bit = std::uint64_t(1) << g % kGroupsLookedAt;
        if (g == groups.size()) {
            groups.emplace_back();
            if (g >= kGroupsLookedAt)
                for (std::uint64_t& part : taken) part &= ~bit;
        }
        groups[g].push_back(std::int32_t(i));
        for (std::size_t part : wanted) taken[part] |= bit;
    }
    return groups;
}

}  // namespace vdbsynth
