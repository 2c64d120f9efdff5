#include "tools/vdb_synth/world_box.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

namespace {

IndexBox voxels(const std::string& text, double side, const Vec3d& at = {0, 0, 0}) {
    BoxValue box;
    REQUIRE(readBox(text, box));
    Affine transform = kIdentity;
    for (int axis = 0; axis < 3; ++axis) {
        transform[std::size_t(5 * axis)] = side;
        transform[std::size_t(12 + axis)] = at[axis];
    }
    return voxelsOf(box, transform, "--box " + text);
}

}  // namespace

TEST_CASE("voxelsOf: voxels as they are, lengths by the centres that they hold", "[tools][oracle]") {
    CHECK(voxels("0,1,2,3,4,5", 0.25) == IndexBox{{0, 1, 2}, {3, 4, 5}});
    CHECK(voxels("0w,0w,0w,8w,4w,1w", 1) == IndexBox{{0, 0, 0}, {7, 3, 0}});
    CHECK(voxels("0w,0w,0w,8w,4w,1w", 0.5) == IndexBox{{0, 0, 0}, {15, 7, 1}});
    CHECK(voxels("-1.5w,2,0w,1w,2,1w", 1) == IndexBox{{-1, 2, 0}, {0, 2, 0}});
    // 0.3 / 0.1 is below 3 in floating point.
    CHECK(voxels("0.3w,0w,0w,0.7w,1w,1w", 0.1).min.x == 3);
    CHECK(voxels("0.3w,0w,0w,0.7w,1w,1w", 0.1).max.x == 6);
    // Moved by half a voxel, faces lie on whole numbers.
    CHECK(voxels("10w,0w,0w,14w,4w,4w", 2, {11, 1, 1}) == IndexBox{{0, 0, 0}, {1, 1, 1}});
}

TEST_CASE("voxelsOf: boxes that touch share no voxel and miss none", "[tools][property]") {
    for (const double side : {0.1, 0.37, 1.0, 2.3}) {
        int next = voxels("-7.3w,0,0,-4.1w,1,1", side).max.x + 1;
        for (const char* text : {"-4.1w,0,0,0.2w,1,1", "0.2w,0,0,5w,1,1", "5w,0,0,11.4w,1,1"}) {
            const IndexBox box = voxels(text, side);
            CHECK(box.min.x == next);
            next = box.max.x + 1;
        }
    }
}

TEST_CASE("voxelsOf: no voxel, too far, rotated", "[tools][error]") {
    const auto message = [](auto&& call) {
        const test::Thrown thrown = test::thrownBy(call);
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        return thrown.message;
    };
    CHECK(
        test::contains(message([] { voxels("0.1w,0,0,0.4w,1,1", 1); }), "holds no voxel; voxels are 1 wide"));
    CHECK(test::contains(message([] { voxels("0w,0,0,1e20w,1,1", 1); }), "within 268 million voxels"));
    CHECK(test::contains(message([] { voxels("5w,0,0,3,1,1", 1); }), "holds no voxel"));
    BoxValue box;
    REQUIRE(readBox("0w,0,0,1w,1,1", box));
    const Affine turned = rotation(0, 0, 0.6, 0.8);
    CHECK(test::contains(message([&] { voxelsOf(box, turned, "--box"); }), "rotated in the world"));
    REQUIRE(readBox("0,0,0,1,1,1", box));
    CHECK_NOTHROW(voxelsOf(box, turned, "--box"));
}
