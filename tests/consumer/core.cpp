// Finds a block of a field in the field again, by libvdbsynth alone: no OpenVDB.
#include <cstdio>
#include <memory>
#include <vector>

#include "libvdbsynth/search/block_index.h"

namespace {

using namespace vdbsynth;

constexpr int kSide = 24, kBlock = 8;

std::shared_ptr<const BrickField> plainField() {
    // Bricks are 8^3 samples, x slowest, z fastest, and made on all threads.
    const auto fill = [](const IndexBox& brick, float* samples) {
        for (int x = brick.min.x; x <= brick.max.x; ++x)
            for (int y = brick.min.y; y <= brick.max.y; ++y)
                for (int z = brick.min.z; z <= brick.max.z; ++z)
                    *samples++ = float((x * x * 31 + y * 7 * z + z) % 13);
    };
    return std::make_shared<const BrickField>(
        BrickField::generate(IndexBox::fromSize({kSide, kSide, kSide}), {}, fill));
}

}  // namespace

int main() {
    const std::shared_ptr<const BrickField> field = plainField();
    BlockIndexOptions options;
    options.block = kBlock;
    const BlockIndex index = BlockIndex::build(field, options);

    const Index3 corner{5, 6, 7};
    std::vector<float> samples(kBlock * kBlock * kBlock);
    field->readBox(corner, {kBlock, kBlock, kBlock}, samples.data());
    BlockQuery query;
    query.samples = samples.data();
    const std::vector<BlockMatch> best = index.match(query, 3);
    for (const BlockMatch& match : best)
        std::printf("%d %d %d at a cost of %g\n", match.position.x, match.position.y, match.position.z,
                    match.cost);
    return best.front().position == corner && best.front().cost == 0 ? 0 : 1;
}
