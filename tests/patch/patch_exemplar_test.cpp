#include "libvdbsynth/patch/patch_exemplar.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

bool same(const Vec3d& a, const Vec3d& b) {
    return length(a - b) < 1e-6;
}

}  // namespace

TEST_CASE("toPlane: a cyclic change of axes, by hand, and its inverse") {
    const Vec3d place{1, 2, 3};
    CHECK(same(toPlane(PatchPlane::XY, place), {1, 2, 3}));
    CHECK(same(toPlane(PatchPlane::YZ, place), {2, 3, 1}));
    CHECK(same(toPlane(PatchPlane::ZX, place), {3, 1, 2}));
    for (const PatchPlane plane : {PatchPlane::XY, PatchPlane::YZ, PatchPlane::ZX}) {
        CHECK(same(fromPlane(plane, toPlane(plane, place)), place));
        // Nothing is mirrored.
        const Vec3d x = toPlane(plane, {1, 0, 0}), y = toPlane(plane, {0, 1, 0}),
                    z = toPlane(plane, {0, 0, 1});
        CHECK(dot(cross(x, y), z) == 1);
    }
}

TEST_CASE("patchExemplar: by hand, in every plane") {
    for (const PatchPlane plane : {PatchPlane::XY, PatchPlane::YZ, PatchPlane::ZX}) {
        // Two points in the box, which is 10 x 20 wide and 30 high, and one in the margin.
        const std::vector<Vec3d> places{{101, 202, 305}, {109, 219, 307}, {99, 202, 600}};
        std::vector<Vec3f> points, normals;
        for (const Vec3d& place : places) {
            points.push_back(cast<float>(fromPlane(plane, place)));
            normals.push_back(cast<float>(fromPlane(plane, {0, 0, 5})));
        }
        const PatchExemplar exemplar =
            patchExemplar(points, normals,
                          {fromPlane(plane, {100, 200, 300}), fromPlane(plane, {110, 220, 330})}, plane, 0.5);
        CHECK(same(exemplar.size, {10, 20, 30}));
        CHECK(same(exemplar.corner, fromPlane(plane, {100, 200, 300})));
        CHECK(exemplar.number == std::vector<std::uint32_t>{0, 1, 2});
        CHECK(exemplar.spacing == 0.5);
        CHECK(same(cast<double>(exemplar.points[1]), {9, 19, 7}));
        CHECK(same(cast<double>(exemplar.normals[1]), {0, 0, 1}));
        for (std::size_t p = 0; p < 3; ++p)
            CHECK(same(exemplar.toWorld(cast<double>(exemplar.points[p])), cast<double>(points[p])));
    }
}

TEST_CASE("patchExemplar: a box too low for its points grows by two spacings beyond them") {
    const std::vector<Vec3f> points{{1, 1, -3}, {2, 2, 4}, {50, 50, 90}}, normals(3, {0, 0, 1});
    const PatchExemplar low = patchExemplar(points, normals, {{0, 0, 0}, {5, 5, 1}}, PatchPlane::XY, 0.5);
    CHECK(low.corner.z == -4);
    CHECK(low.size.z == 9);
    // A flat box too; of a high one nothing is cut.
    CHECK(patchExemplar(points, normals, {{0, 0, 0}, {5, 5, 0}}, PatchPlane::XY, 0.5).size.z == 9);
    CHECK(patchExemplar(points, normals, {{0, 0, -9}, {5, 5, 20}}, PatchPlane::XY, 0.5).size.z == 29);
    // Unless the height is to stay as it is.
    const PatchExemplar kept =
        patchExemplar(points, normals, {{0, 0, 0}, {5, 5, 1}}, PatchPlane::XY, 0.5, false);
    CHECK(kept.corner.z == 0);
    CHECK(kept.size.z == 1);
}

TEST_CASE("patchExemplar: what is refused") {
    const std::vector<Vec3f> points{{1, 1, 1}}, normals{{0, 0, 1}};
    const PatchBox box{{0, 0, 0}, {5, 5, 5}};
    const auto code = [&](const std::vector<Vec3f>& n, const PatchBox& b, double spacing) {
        return test::thrownBy([&] { patchExemplar(points, n, b, PatchPlane::XY, spacing); }).code;
    };
    CHECK(code({}, box, 1) == int(ErrorCode::ShapeMismatch));
    CHECK(code(normals, box, 0) == int(ErrorCode::InvalidOption));
    CHECK(code(normals, box, std::nan("")) == int(ErrorCode::InvalidOption));
    CHECK(code(normals, {{0, 0, 0}, {5, 0, 5}}, 1) == int(ErrorCode::InvalidOption));
    CHECK(code(normals, {{0, 0, 0}, {std::nan(""), 5, 5}}, 1) == int(ErrorCode::InvalidOption));
    CHECK(code(normals, {{2, 0, 0}, {5, 5, 5}}, 1) == int(ErrorCode::EmptyInput));
    CHECK(code(normals, box, 1) == -1);
}

TEST_CASE("fittingKernel: narrow where sheets face each other closely, wide elsewhere") {
    test::PointShape plane = test::latticePlane(30), under = plane;
    for (Vec3f& n : under.normal) n.z = -1;
    const auto sheets = [&](float apart) {
        for (Vec3f& p : under.point) p.z = -apart;
        return test::joined(plane, under);
    };
    CHECK(fittingKernel(plane.point, plane.normal, 1) == 2);
    const test::PointShape close = sheets(2), far = sheets(7);
    CHECK(fittingKernel(close.point, close.normal, 1) == 1);
    CHECK(fittingKernel(far.point, far.normal, 1) == 2);
    // The scale does not matter, and a few thin parts do not.
    CHECK(fittingKernel(close.point, close.normal, 0.25) == 2);
    test::PointShape few = plane;
    for (std::size_t p = 0; p < 4; ++p) {
        few.point.push_back(plane.point[p] + Vec3f{0, 0, -1});
        few.normal.push_back({0, 0, -1});
    }
    CHECK(fittingKernel(few.point, few.normal, 1) == 2);
    CHECK(fittingKernel({}, {}, 1) == 2);
}

TEST_CASE("fittingKernel: same for any number of threads, and cancelled", "[patch][tsan]") {
    const test::PointShape rings = test::ringSheet(3);
    for (const int threads : {1, 3})
        CHECK(fittingKernel(rings.point, rings.normal, 1, test::onThreads(threads)) == 1);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              fittingKernel(rings.point, rings.normal, 1, ctx);
          }).code == int(ErrorCode::Cancelled));
}
