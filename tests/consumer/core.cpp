// Searches a small field for one of its own blocks, without OpenVDB.
#include <cstdio>
#include <memory>
#include <vector>

#include "libvdbsynth/search/block_index.h"

int main() {
    using namespace vdbsynth;
    const auto field = std::make_shared<const BrickField>(
        BrickField::generate(IndexBox::fromSize({24, 24, 24}), {}, [](const IndexBox& brick, float* samples) {
            for (int i = 0; i < BrickField::kSamples; ++i)
                samples[i] = float((brick.min.x * 31 + brick.min.y * 7 + brick.min.z + i * i) % 13);
        }));
    BlockIndexOptions options;
    options.block = 8;
    const BlockIndex index = BlockIndex::build(field, options);
    std::vector<float> samples(512);
    field->readBox({5, 6, 7}, {8, 8, 8}, samples.data());
    BlockQuery query;
    query.samples = samples.data();
    const BlockMatch match = index.match(query).front();
    std::printf("found at %d %d %d\n", match.position.x, match.position.y, match.position.z);
    return match.cost == 0 ? 0 : 1;
}
