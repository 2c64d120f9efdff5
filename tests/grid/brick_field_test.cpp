#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/lattice.h"

#include <catch2/catch.hpp>

#include <array>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("BrickField: reads give what generate was given, clamped to the box outside", "[grid][property]") {
    const auto value = [](const Index3& p) { return float(p.x * 10000 + p.y * 100 + p.z); };
    const BrickField field = test::fieldFrom({19, 9, 23}, value);
    std::vector<float> out(5 * 4 * 30);
    field.readBox({-2, 6, -3}, {5, 4, 30}, out.data());
    std::size_t i = 0;
    for (int x = -2; x < 3; ++x)
        for (int y = 6; y < 10; ++y)
            for (int z = -3; z < 27; ++z) {
                const Index3 clamped{std::clamp(x, 0, 18), std::clamp(y, 0, 8), std::clamp(z, 0, 22)};
                REQUIRE(out[i++] == value(clamped));
                REQUIRE(field.at({x, y, z}) == value(clamped));
            }
    CHECK(field.inside({18, 8, 22}) == value({18, 8, 22}));
}

TEST_CASE("BrickField: cubes of four samples are read as single voxels are, wherever they lie",
          "[grid][property]") {
    BrickField field = test::ballsField({21, 18, 27}, 5, 3.f);  // with bricks of one value
    REQUIRE(field.storedBricks() < field.brickCount());
    field.translate({-7, 40, 3});
    std::array<float, 64> out;
    forEachVoxel(field.box().expanded(4), [&](const Index3& corner) {
        field.readBox(corner, {4, 4, 4}, out.data());
        std::size_t i = 0;
        forEachVoxel({corner, corner + Index3{3, 3, 3}},
                     [&](const Index3& p) { REQUIRE(out[i++] == field.at(p)); });
    });
}

TEST_CASE("BrickField: a box that does not begin at 0 keeps its coordinates", "[grid][fast]") {
    const IndexBox box{{-5, 3, -9}, {6, 12, 2}};
    const BrickField field =
        BrickField::fromVoxels(box, {}, [](const Index3& p) { return float(p.x * 100 + p.y * 10 + p.z); });
    CHECK(field.at({-5, 3, -9}) == -479.f);
    CHECK(field.at({6, 12, 2}) == 722.f);
}

TEST_CASE("BrickField: fromVoxels gives every voxel its value, as generate does brick by brick",
          "[grid][property]") {
    const IndexBox box{{-5, 3, -9}, {6, 12, 2}};
    const auto value = [](const Index3& p) { return float(p.x < 0 ? 1 : p.x * 100 + p.y * 10 + p.z); };
    RunContext ctx;
    ctx.threads = 3;
    const BrickField field = BrickField::fromVoxels(box, ctx, value);
    CHECK(field.box() == box);
    forEachVoxel(box, [&](const Index3& p) { CHECK(field.at(p) == value(p)); });
    const BrickField same = BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        forEachVoxel(brick, [&](const Index3& p) { *samples++ = value(p); });
    });
    CHECK(field.storedBricks() == same.storedBricks());
    CHECK(test::samplesOf(field) == test::samplesOf(same));
}

TEST_CASE("BrickField: constant bricks are not stored, and a write stores only what changes",
          "[grid][property]") {
    BrickField field(IndexBox::fromSize({64, 64, 64}), 3.f);
    CHECK(field.storedBricks() == 0);
    const std::vector<float> same(8 * 8 * 8, 3.f), other(4 * 4 * 4, 1.f);
    field.writeBox({4, 4, 4}, {8, 8, 8}, same.data());
    CHECK(field.storedBricks() == 0);
    field.writeBox({6, 9, 10}, {4, 4, 4}, other.data());
    CHECK(field.storedBricks() == 2);
    CHECK(field.at({6, 9, 10}) == 1.f);
    CHECK(field.at({9, 12, 13}) == 1.f);
    CHECK(field.at({10, 12, 13}) == 3.f);
    float constant = 0;
    CHECK(field.constantIn(IndexBox::cube({16, 0, 0}, 48), constant));
    CHECK(constant == 3.f);
    CHECK_FALSE(field.constantIn(IndexBox::cube({0, 0, 0}, 9), constant));
}

TEST_CASE("BrickField: a masked write changes the masked samples only, and nothing outside", "[grid][fast]") {
    BrickField field(IndexBox::fromSize({8, 8, 8}), 0.f);
    const std::vector<float> values(27, 5.f);
    std::vector<std::uint8_t> mask(27, 0);
    mask[0] = mask[26] = 1;
    field.writeBox({6, 6, 6}, {3, 3, 3}, values.data(), mask.data());
    CHECK(field.at({6, 6, 6}) == 5.f);
    CHECK(field.at({7, 7, 7}) == 0.f);
}

TEST_CASE("BrickField: the same bits for any number of threads", "[grid][determinism]") {
    const auto make = [](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        return test::samplesOf(BrickField::generate(
            IndexBox::fromSize({70, 50, 60}), ctx, [](const IndexBox& brick, float* samples) {
                for (int i = 0; i < BrickField::kSamples; ++i)
                    samples[i] = float(brick.min.x * 7 + brick.min.y + i % 5);
            }));
    };
    const std::vector<float> one = make(1);
    CHECK(one == make(2));
    CHECK(one == make(8));
}

TEST_CASE("BrickField: an empty box is refused, a cancelled build leaves nothing", "[grid][error][cancel]") {
    CHECK(test::thrownBy([] { BrickField(IndexBox(), 0.f); }).code == int(ErrorCode::InvalidOption));
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] {
              BrickField::generate(IndexBox::fromSize({8, 8, 8}), ctx, [](const IndexBox&, float*) {});
          }).code == int(ErrorCode::Cancelled));
}
