#include "libvdbsynth/patch/patch_field.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

PatchField fieldOf(const test::PointShape& shape, const PatchLattice& lattice, const Vec3d& origin,
                   const RunContext& ctx = {}) {
    const PointSetSurface surface(shape.point, shape.normal, {}, ctx);
    return patchField(surface, shape.point, lattice, origin, kFieldReach, ctx);
}

Vec3d gradientAt(const PatchField& field, int i, int j, int k) {
    const float* node = field.column(i, j) + k * kFieldValues;
    return {double(node[1]), double(node[2]), double(node[3])};
}

}  // namespace

TEST_CASE("latticeOf: by hand, and what is refused") {
    const PatchLattice lattice = latticeOf({10, 4.1, 0}, 2);
    CHECK(lattice.nx == 5);
    CHECK(lattice.ny == 3);
    CHECK(lattice.nz == 1);
    CHECK(lattice.columns() == 15);
    CHECK(lattice.nodes() == 15);
    CHECK(lattice.column(2, 1) == 7);
    CHECK(lattice.place(1, 0, 2).x == 3);
    CHECK(lattice.place(1, 0, 2).z == 5);
    CHECK(test::thrownBy([] { latticeOf({1, 1, 1}, 0); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] { latticeOf({1, 1, 1}, std::nan("")); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] { latticeOf({1e6, 1e6, 1e6}, 1); }).code == int(ErrorCode::Memory));
    CHECK(test::thrownBy([] { latticeOf({1e300, 1, 1}, 1); }).code == int(ErrorCode::Memory));
}

TEST_CASE("patchField: over a plane, by hand") {
    // The plane is in the middle of node 5 of 12; a step is two spacings.
    test::PointShape plane = test::latticePlane(40);
    for (Vec3f& p : plane.point) p.z = 11;
    const PatchField field = fieldOf(plane, {2, 12, 12, 12}, {8, 8, 0});
    for (int k = 0; k < 12; ++k) {
        CAPTURE(k);
        CHECK(double(field.distance(5, 6, k)) == Approx(std::clamp(k - 5, -3, 3)).margin(1e-5));
        // Beyond the reach there is no gradient.
        const double up = k < 2 || k > 8 ? 0 : 1;
        CHECK(length(gradientAt(field, 5, 6, k) - Vec3d{0, 0, up}) < 1e-5);
    }
}

TEST_CASE("patchField: distances to a sphere and their gradients are those of the formula") {
    test::PointShape sphere = test::spiralSphere(std::size_t(4 * kPi * 12 * 12), 12);
    const Vec3d middle{20, 20, 20};
    for (Vec3f& p : sphere.point) p = p + cast<float>(middle);
    const PatchLattice lattice{2, 20, 20, 20};
    const PatchField field = fieldOf(sphere, lattice, {});
    double worst = 0, turned = 0;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            for (int k = 0; k < 20; ++k) {
                const Vec3d from = lattice.place(i, j, k) - middle;
                const double exact = (length(from) - 12) / 2, found = double(field.distance(i, j, k));
                worst = std::max(worst, std::abs(found - std::clamp(exact, -3.0, 3.0)));
                if (std::abs(exact) < 2.9)
                    turned = std::max(turned, length(gradientAt(field, i, j, k) - normalized(from)));
            }
    CHECK(worst < 0.05);
    CHECK(turned < 0.05);
}

TEST_CASE("patchField: between two sheets it is inside, above, below and beside them outside") {
    test::PointShape top = test::latticePlane(40), under = top;
    for (std::size_t p = 0; p < top.point.size(); ++p) {
        top.point[p].z = 30;
        under.point[p].z = 10;
        under.normal[p].z = -1;
    }
    const PatchField field = fieldOf(test::joined(top, under), {1, 60, 40, 40}, {0, 0, 0});
    for (const int k : {14, 20, 25}) CHECK(field.distance(20, 20, k) == -3);
    for (const int k : {0, 5, 35, 39}) CHECK(field.distance(20, 20, k) == 3);
    for (int k = 0; k < 40; ++k) CHECK(field.distance(55, 20, k) == 3);
    // Without a floor all below the top is inside, without a top nothing is.
    const PatchField filled = fieldOf(top, {1, 40, 40, 40}, {}), open = fieldOf(under, {1, 40, 40, 40}, {});
    CHECK(filled.distance(20, 20, 0) == -3);
    CHECK(filled.distance(20, 20, 39) == 3);
    CHECK(open.distance(20, 20, 0) == 3);
    CHECK(open.distance(20, 20, 39) == 3);
}

TEST_CASE("patchField: another origin shows another part, bit for bit") {
    const test::EggCrate crate;
    const test::PointShape points = test::eggCratePoints(crate, 32, 8);
    const PatchField whole = fieldOf(points, {2, 16, 16, 4}, {0, 0, -4});
    const PatchField part = fieldOf(points, {2, 5, 7, 4}, {8, 6, -4});
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 7; ++j)
            REQUIRE(std::equal(part.column(i, j), part.column(i, j) + part.columnLength(),
                               whole.column(i + 4, j + 3)));
}

TEST_CASE("patchField: a lattice far from all points, and a single point, are empty") {
    const test::PointShape plane = test::latticePlane(10);
    const auto empty = [](const PatchField& field) {
        for (std::size_t n = 0; n < field.lattice.nodes(); ++n)
            if (field.values[n * kFieldValues] != kFieldReach) return false;
        return true;
    };
    CHECK(empty(fieldOf(plane, {1, 4, 4, 4}, {100, 0, 0})));
    CHECK(empty(fieldOf(plane, {1, 4, 4, 4}, {0, 0, 50})));
    test::PointShape one;
    one.point = {{2, 2, 2}};
    one.normal = {{0, 0, 1}};
    CHECK(empty(fieldOf(one, {1, 4, 4, 4}, {})));
}

TEST_CASE("patchField: same bits for any number of threads, and cancelled", "[patch][tsan]") {
    const test::PointShape rings = test::ringSheet(2);
    const PatchLattice lattice{2, 16, 16, 6};
    const PatchField one = fieldOf(rings, lattice, {0, 0, -6}, test::onThreads(1)),
                     three = fieldOf(rings, lattice, {0, 0, -6}, test::onThreads(3));
    CHECK(one.values == three.values);
    const PointSetSurface surface(rings.point, rings.normal);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              patchField(surface, rings.point, lattice, {}, kFieldReach, ctx);
          }).code == int(ErrorCode::Cancelled));
}
