#include "libvdbsynth/analogy/analogy_level.h"
#include "libvdbsynth/analogy/volume_analogy.h"
#include "libvdbsynth/grid/pyramid.h"

#include <algorithm>
#include <array>
#include <string>

namespace vdbsynth {
namespace {

// Volume, in voxels of the finest level, that is solid at the finest level but not where a level is read
// between its voxels, or the other way round. A relief of a fraction of a voxel is still there.
double changedBy(const AnalogyPyramid& model, int level, const RunContext& ctx) {
    const BrickField& fine = model.distance.front();
    const Index3 size = fine.box().size();
    BrickField read = model.distance[std::size_t(level)];
    for (int l = level - 1; l >= 0; --l)
        read = doubled(read, model.distance[std::size_t(l)].box().size(), ctx);
    std::vector<float> row(std::size_t(size.y) * std::size_t(size.z)), above(row.size());
    double sum = 0;
    for (int x = 0; x < size.x; ++x) {
        fine.readBox({x, 0, 0}, {1, size.y, size.z}, row.data());
        read.readBox({x, 0, 0}, {1, size.y, size.z}, above.data());
        for (std::size_t i = 0; i < row.size(); ++i) sum += (row[i] < 0) != (above[i] < 0);
    }
    return sum;
}

// Volume in which a pair's models differ.
double textureOf(const BrickField& plain, const BrickField& textured) {
    const Index3 size = plain.box().size();
    std::vector<float> a(std::size_t(size.y) * std::size_t(size.z)), b(a.size());
    double sum = 0;
    for (int x = 0; x < size.x; ++x) {
        plain.readBox({x, 0, 0}, {1, size.y, size.z}, a.data());
        textured.readBox({x, 0, 0}, {1, size.y, size.z}, b.data());
        for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] < 0) != (b[i] < 0);
    }
    return sum;
}

}  // namespace

int usefulLevels(const std::vector<AnalogyPair>& pairs, const RunContext& ctx) {
    constexpr int kMost = 3;
    double texture = 0;
    std::array<double, kMost> lost{};
    for (const AnalogyPair& pair : pairs) {
        const AnalogyPyramid plain = analogyPyramid(*pair.plain, kMost, ctx),
                             textured = analogyPyramid(*pair.textured, kMost, ctx);
        texture += textureOf(*pair.plain, *pair.textured);
        for (int l = 1; l < kMost; ++l)
            lost[std::size_t(l)] += std::max(0.0, changedBy(textured, l, ctx) - changedBy(plain, l, ctx));
    }
    const auto held = [&](int level) { return 1 - lost[std::size_t(level)] / std::max(texture, 1.0); };
    const auto largeEnough = [&](int level) {
        return std::all_of(pairs.begin(), pairs.end(), [&](const AnalogyPair& pair) {
            const Index3 size = pair.inner.size();
            const int sides[3] = {size.x >> level, size.y >> level, size.z >> level};
            return std::count_if(sides, sides + 3, [](int side) { return side >= kLeastSide; }) >= 2;
        });
    };
    int levels = 1;
    while (levels < kMost && held(levels) >= kHeld && largeEnough(levels)) ++levels;
    message(ctx, MessageLevel::Detail,
            "coarser levels retain " + std::to_string(held(1)) + " and " + std::to_string(held(2)) +
                " of the texture: " + std::to_string(levels) + " levels");
    return levels;
}

}  // namespace vdbsynth
