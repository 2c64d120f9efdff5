#include "libvdbsynth/grid/voxel_table.h"

#include "libvdbsynth/base/parallel.h"

#include <array>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

}  // namespace

VoxelTable VoxelTable::where(const BrickField& field, const std::function<bool(float)>& wanted,
                             const RunContext& ctx) {
    VoxelTable table;
    table.mBox = field.box();
    const Index3 size = field.box().size();
    table.mBricks = {(size.x + kSide - 1) / kSide, (size.y + kSide - 1) / kSide,
                     (size.z + kSide - 1) / kSide};
    const std::size_t plane = std::size_t(table.mBricks.y) * std::size_t(table.mBricks.z);
    // Columns of bricks find their voxels side by side and are numbered one after the other.
    std::vector<std::vector<Index3>> found(std::size_t(table.mBricks.x) * plane);
    parallelFor(ctx, found.size(), 32, [&](std::size_t begin, std::size_t end) {
        std::array<float, BrickField::kSamples> samples;
        for (std::size_t b = begin; b < end; ++b) {
            const int bx = int(b / plane), by = int(b % plane) / table.mBricks.z,
                      bz = int(b) % table.mBricks.z;
            const Index3 corner = field.box().min + Index3{bx, by, bz} * kSide;
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
    table.mSlots.assign(found.size(), -1);
    for (std::size_t b = 0; b < found.size(); ++b) {
        if (found[b].empty()) continue;
        table.mSlots[b] = std::int32_t(table.mNumbers.size() / BrickField::kSamples);
        const std::size_t first = table.mNumbers.size();
        table.mNumbers.resize(first + BrickField::kSamples, -1);
        for (const Index3& p : found[b]) {
            const Index3 in = p - field.box().min;
            table.mNumbers[first + std::size_t((((in.x & 7) << 3) | (in.y & 7)) << 3 | (in.z & 7))] =
                std::int32_t(table.mVoxels.size());
            table.mVoxels.push_back(p);
        }
    }
    return table;
}

}  // namespace vdbsynth
