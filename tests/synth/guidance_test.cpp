#include "libvdbsynth/synth/guidance.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/synth/texture_optimization.h"
#include "tests/support/makers.h"

#include <limits>

using namespace vdbsynth;

namespace {

// Balls on the left, noise-free slabs on the right, so that where a source lies can be told from it.
BrickField twoKinds(const Index3& size) {
    const BrickField balls = test::ballsField(size, 4, 6.f, 30);
    return test::fieldFrom(size, [&](const Index3& p) {
        if (p.x < size.x / 2) return balls.at(p);
        return float(std::abs((p.z + 4) % 12 - 6) - 3);
    });
}

}  // namespace

TEST_CASE("Guidance: the mean over octants of squared differences", "[synth][oracle]") {
    const BrickField target = test::noiseField({20, 20, 20}, 1), exemplar = test::noiseField({24, 24, 24}, 2);
    const Guidance guidance(target, {exemplar}, 3.f, 8, {});
    const Index3 origin{5, 2, 9}, place{11, 16, 3};
    double expected = 0;
    for (int octant = 0; octant < 8; ++octant) {
        const Index3 step{octant & 1 ? 4 : 0, octant & 2 ? 4 : 0, octant & 4 ? 4 : 0};
        double difference = 0;
        for (int i = 0; i < 64; ++i) {
            const Index3 at = step + Index3{i / 16, i / 4 % 4, i % 4};
            difference += double(target.at(origin + at) - exemplar.at(place + at)) / 64;
        }
        expected += 3 * difference * difference / 8;
    }
    CHECK(double(guidance.cost(origin, 0, place)) == Approx(expected).epsilon(1e-4));
    CHECK(Guidance().empty());
}

TEST_CASE("optimizeTexture: a guide says which part of the exemplar goes where", "[synth][property]") {
    const auto exemplar = std::make_shared<const BrickField>(twoKinds({64, 40, 32}));
    const BrickField label =
        test::fieldFrom({64, 40, 32}, [](const Index3& p) { return p.x < 32 ? 5.f : 9.f; });
    const BrickField wanted =
        test::fieldFrom({96, 64, 32}, [](const Index3& p) { return p.y < 32 ? 5.f : 9.f; });
    BlockSynthesisOptions options;
    options.size = {96, 64, 32};
    options.block = 8;
    options.levels = 2;
    options.guide = &wanted;
    options.exemplarGuides = {&label};
    const PatchMap map = optimizeTexture({exemplar}, options).map;
    std::size_t right = 0, all = 0;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        const int y = map.originOf(map.place(i)).y;
        if (y + 8 > 28 && y < 36) continue;  // the seam between the two
        ++all;
        right += (map.source[i].x + 4 < 32) == (y < 32) ? 1 : 0;
    }
    CHECK(double(right) > 0.95 * double(all));
    const BrickField flat(IndexBox::fromSize({64, 40, 32}), 2.f);
    options.exemplarGuides = {&flat};
    CHECK(test::thrownBy([&] { optimizeTexture({exemplar}, options); }).code == int(ErrorCode::Unusable));
    const BrickField broken = test::fieldFrom({64, 40, 32}, [](const Index3& p) {
        return p == Index3{3, 3, 3} ? std::numeric_limits<float>::quiet_NaN() : float(p.x);
    });
    options.exemplarGuides = {&broken};
    CHECK(test::thrownBy([&] { optimizeTexture({exemplar}, options); }).code == int(ErrorCode::BadData));
}
