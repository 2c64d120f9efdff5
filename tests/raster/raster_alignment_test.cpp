#include "libvdbsynth/raster/raster_alignment.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/base/random.h"
#include "tests/support/raster_fields.h"

using namespace vdbsynth;
using test::rasterOf;

namespace {

using Axes = std::array<Vec3d, 3>;

Affine mapOf(const Axes& axes, const Vec3d& spacing, const Vec3d& origin) {
    Affine m = kIdentity;
    for (std::size_t i = 0; i < 3; ++i)
        for (int r = 0; r < 3; ++r) m[4 * i + std::size_t(r)] = axes[i][r] * spacing[int(i)];
    for (int r = 0; r < 3; ++r) m[12 + std::size_t(r)] = origin[r];
    return m;
}

Axes axesOf(const Affine& m) {
    return {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
}

Raster numbered(const Index3& size) {
    return rasterOf(size, [&](int x, int y, int z) { return float(x + size.x * (y + size.y * z)); });
}

// Each value is where the map says that its sample is.
void checkPlaces(const Raster& placed, const Index3& stored, const Affine& map) {
    for (int z = 0; z < placed.size.z; ++z)
        for (int y = 0; y < placed.size.y; ++y)
            for (int x = 0; x < placed.size.x; ++x) {
                const int value = int(placed.at(x, y, z));
                const Vec3d expected =
                    transformed(map, {double(value % stored.x), double(value / stored.x % stored.y),
                                      double(value / stored.x / stored.y)});
                const Vec3d at = placed.origin + placed.axes[0] * (placed.spacing.x * x) +
                                 placed.axes[1] * (placed.spacing.y * y) +
                                 placed.axes[2] * (placed.spacing.z * z);
                REQUIRE(length(at - expected) < 1e-9);
            }
}

}  // namespace

TEST_CASE("alignedToWorld: mirrored axes are reversed in the samples, by hand", "[raster][oracle]") {
    const Affine map = mapOf({{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}, {1, 2, 3}, {100, 200, 0});
    const Raster placed = alignedToWorld("a", numbered({3, 2, 1}), map);
    CHECK(placed.size == Index3{3, 2, 1});
    CHECK(placed.values == std::vector<float>{5, 4, 3, 2, 1, 0});
    CHECK(placed.origin.x == 98);
    CHECK(placed.origin.y == 198);
    CHECK(placed.spacing.y == 2);
    CHECK(placed.knownSpacing);
    CHECK(runAlongWorld(placed.axes));
}

TEST_CASE("alignedToWorld: every exchange and reversal of axes puts each sample where the map says",
          "[raster][property]") {
    const Index3 size{3, 4, 2};
    Axes axes = kWorldAxes;
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            for (std::size_t i = 0; i < 3; ++i)
                axes[i] = kWorldAxes[order[i]] * (signs >> i & 1 ? -1.0 : 1.0);
            const Affine map = mapOf(axes, {0.5, 2, 1.25}, {7, -3, 11});
            const Raster placed = alignedToWorld("a", numbered(size), map);
            CHECK(runAlongWorld(placed.axes));
            checkPlaces(placed, size, map);
        }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("alignedToWorld: any rotation is kept, in axes near those of the world", "[raster][property]") {
    Random random(3, 1);
    const Index3 size{4, 2, 3};
    for (int round = 0; round < 200; ++round) {
        double q[4], norm = 0;
        for (double& part : q) {
            part = random.uniform(-1, 1);
            norm += part * part;
        }
        if (norm < 0.01) continue;
        norm = std::sqrt(norm);
        Axes axes = axesOf(rotation(q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm));
        if (round % 2 == 0) axes[1] = -axes[1];
        const Affine map = mapOf(axes, {1, 0.5, 3}, {-40, 12, 5e5});
        const Raster placed = alignedToWorld("a", numbered(size), map);
        checkPlaces(placed, size, map);
        const AxesTurn turn = turnOf(placed.axes);
        CHECK(turn.degrees < 63);  // at most 62.8 between a frame and the nearest one along the axes
        CHECK(turn.shear < 1e-12);
    }
}

TEST_CASE("alignedToWorld: what rounding left of the world's axes is removed, a small turn is kept",
          "[raster][oracle]") {
    const auto turned = [](double angle) {
        return alignedToWorld("a", numbered({2, 2, 2}),
                              mapOf({{{1, angle, 0}, {-angle, 1, 0}, {0, 0, 1}}}, {2, 2, 2}, {0, 0, 0}));
    };
    CHECK(runAlongWorld(turned(3e-6).axes));
    CHECK_FALSE(runAlongWorld(turned(1e-3).axes));
    CHECK(turnOf(turned(1e-3).axes).degrees == Approx(0.0573).epsilon(1e-3));
    // Directions of five digits are made exact, sheared ones are not.
    const Raster rounded = alignedToWorld(
        "a", numbered({2, 2, 2}), mapOf({{{0.86603, 0.5, 0}, {-0.5, 0.86602, 0}, {0, 0, 1}}}, {1, 1, 1}, {}));
    CHECK(turnOf(rounded.axes).shear < 1e-14);
    CHECK(turnOf(rounded.axes).degrees == Approx(30).margin(0.01));
    const Raster sheared = alignedToWorld("a", numbered({2, 2, 2}),
                                          mapOf({{{1, 0, 0}, {0, 1, 0}, {0, 0.6, 0.8}}}, {1, 1, 1}, {}));
    CHECK(turnOf(sheared.axes).shear == Approx(0.6));
}

TEST_CASE("alignedToWorld: maps that flatten the volume or are no numbers are refused, memory is asked for",
          "[raster][error]") {
    const auto thrown = [](const Affine& map, std::uint64_t memory = 0) {
        RunContext ctx;
        ctx.maxMemory = memory;
        return test::thrownBy([&] { alignedToWorld("a.nii", numbered({2, 2, 2}), map, ctx); });
    };
    for (const Axes& flat :
         {Axes{}, Axes{{{1, 0, 0}, {1, 0, 0}, {0, 0, 1}}}, Axes{{{1, 0, 0}, {0, 1, 0}, {1, 1, 1e-9}}},
          Axes{{{std::nan(""), 0, 0}, {0, 1, 0}, {0, 0, 1}}},
          Axes{{{INFINITY, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}) {
        CHECK(thrown(mapOf(flat, {1, 1, 1}, {})).code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown(mapOf(flat, {1, 1, 1}, {})).message, "a.nii: "));
    }
    CHECK(thrown(mapOf(kWorldAxes, {1, 1, 1}, {0, std::nan(""), 0})).code == int(ErrorCode::BadData));
    CHECK(thrown(mapOf(kWorldAxes, {1, 1, 1}, {0, INFINITY, 0})).code == int(ErrorCode::BadData));
    CHECK(thrown(mapOf(kWorldAxes, {-1, 1, 1}, {}), 1).code == int(ErrorCode::Memory));
    CHECK(thrown(mapOf(kWorldAxes, {1, 1, 1}, {}), 1).code == -1);  // nothing is copied
}
