#include "libvdbsynth/grid/voxel_table.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <array>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

// Index within its brick, for a position relative to the box's corner.
std::size_t sampleIndex(const Index3& in) {
    return std::size_t((((in.x & 7) << 3) | (in.y & 7)) << 3 | (in.z & 7));
}

}  // namespace

VoxelTable::VoxelTable(const IndexBox& box) : mBox(box) {
    const Index3 size = box.size();
    mBricks = {(size.x + kSide - 1) / kSide, (size.y + kSide - 1) / kSide, (size.z + kSide - 1) / kSide};
    mSlots.assign(latticeCount(mBricks), -1);
}

VoxelTable VoxelTable::of(const IndexBox& box, std::vector<Index3> voxels) {
    VoxelTable table(box);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        const Index3 in = voxels[i] - box.min;
        std::int32_t& slot = table.mSlots[table.brickIndex(in.x >> 3, in.y >> 3, in.z >> 3)];
        if (slot < 0) {
            slot = std::int32_t(table.mNumbers.size() / BrickField::kSamples);
            table.mNumbers.resize(table.mNumbers.size() + BrickField::kSamples, -1);
        }
        table.mNumbers[std::size_t(slot) * BrickField::kSamples + sampleIndex(in)] = std::int32_t(i);
    }
    table.mVoxels = std::move(voxels);
    return table;
}

VoxelTable VoxelTable::where(const BrickField& field, const std::function<bool(float)>& wanted,
                             const RunContext& ctx) {
    const Index3 size = field.box().size(), bricks{(size.x + kSide - 1) / kSide, (size.y + kSide - 1) / kSide,
                                                   (size.z + kSide - 1) / kSide};
    // Columns of bricks find their voxels in parallel and are numbered in order.
    std::vector<std::vector<Index3>> found(latticeCount(bricks));
    parallelFor(ctx, found.size(), 32, [&](std::size_t begin, std::size_t end) {
        std::array<float, BrickField::kSamples> samples;
        for (std::size_t b = begin; b < end; ++b) {
            const Index3 corner = field.box().min + latticeVoxel(b, bricks) * kSide;
            const IndexBox brick = IndexBox::cube(corner, kSide).intersection(field.box());
            float value = 0;
            if (field.constantIn(brick, value) && !wanted(value)) continue;
            field.readBox(corner, {kSide, kSide, kSide}, samples.data());
            for (int i = 0; i < BrickField::kSamples; ++i) {
                const Index3 p = corner + Index3{i >> 6, (i >> 3) & 7, i & 7};
                if (brick.contains(p) && wanted(samples[std::size_t(i)])) found[b].push_back(p);
            }
        }
    });
    std::vector<Index3> voxels;
    for (const std::vector<Index3>& column : found) voxels.insert(voxels.end(), column.begin(), column.end());
    return of(field.box(), std::move(voxels));
}

}  // namespace vdbsynth
