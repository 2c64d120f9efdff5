#include "libvdbsynth/analogy/analogy_level.h"
#include "libvdbsynth/analogy/volume_analogy.h"

#include <algorithm>
#include <array>
#include <string>

namespace vdbsynth {
namespace {

// Volume, in voxels of the finest level, that is solid at one level but not at the finest.
double changedBy(const AnalogyPyramid& model, int level) {
    const BrickField &fine = model.distance.front(), &coarse = model.distance[std::size_t(level)];
    const Index3 size = fine.box().size();
    std::vector<float> row(std::size_t(size.z)), above(std::size_t(coarse.box().size().z));
    double sum = 0;
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y) {
            fine.readBox({x, y, 0}, {1, 1, size.z}, row.data());
            coarse.readBox({x >> level, y >> level, 0}, {1, 1, int(above.size())}, above.data());
            for (std::size_t z = 0; z < row.size(); ++z) sum += (row[z] < 0) != (above[z >> level] < 0);
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
            lost[std::size_t(l)] += std::max(0.0, changedBy(textured, l) - changedBy(plain, l));
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
