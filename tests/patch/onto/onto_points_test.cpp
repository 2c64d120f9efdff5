#include "libvdbsynth/patch/onto/onto_points.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/onto/onto_layout.h"
#include "tests/support/contexts.h"
#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

struct Made {
    PatchExemplar exemplar;
    PatchField field;
    PointSetSurface exemplarSurface;
    OntoSurface surface;
    OntoArrangement arrangement;

    Made(const PatchExemplar& given, const OntoSurface& over)
        : exemplar(given),
          field(test::measuredField(given, 2)),
          exemplarSurface(given.points, given.normals),
          surface(over),
          arrangement(layOntoSurface(surface, field, {14, 4, 0.1, 2})) {}
    OntoPointsResult points(const SheetOptions& options, double zero = 4, const RunContext& ctx = {}) const {
        return ontoPoints(exemplar, exemplarSurface, field, surface, arrangement, zero, options, ctx);
    }
};

SheetOptions warped() {
    SheetOptions options;
    options.reach = 4;
    return options;
}

const Made& flatOnBall() {
    const test::PointShape ball = test::spiralSphere(3900, 35);
    static const Made made(test::eggCrateExemplar({16, 0}, 48), ontoSurface(ball.point, ball.normal, {}, 2));
    return made;
}

}  // namespace

TEST_CASE("ontoPoints: an egg-crate on a plane is an egg-crate") {
    const test::EggCrate crate;
    const Made made(test::eggCrateExemplar(crate, 48),
                    test::surfaceAlong(test::squareShape(90, 2), {1, 0, 0}, 2));
    const OntoPointsResult result = made.points(warped());
    const SheetPoints& sheet = result.sheet;
    REQUIRE(sheet.source.size() == sheet.size());
    REQUIRE(sheet.patch.size() == sheet.size());
    // The first patch says the phase.
    const OntoPatch& first = made.arrangement.patches[0];
    const Vec3f at = made.surface.sites.point[first.disk.centre];
    double sum = 0, worst = 0;
    std::size_t inside = 0;
    for (std::size_t p = 0; p < sheet.size(); ++p) {
        const Vec3d place = cast<double>(sheet.points[p]);
        if (place.x < 6 || place.y < 6 || place.x > 84 || place.y > 84) continue;
        ++inside;
        const double x = place.x - double(at.x) + first.from.x, y = place.y - double(at.y) + first.from.y;
        const double off = std::abs(place.z - crate.at(x, y)) * crate.normal(x, y).z;
        sum += off;
        worst = std::max(worst, off);
        REQUIRE(std::abs(length(sheet.normals[p]) - 1) < 1e-4f);
    }
    CHECK(sum / double(inside) < 0.15);
    CHECK(worst < 1);
    // As dense as the exemplar: a point to a unit of the plane.
    CHECK(double(inside) == Approx(78 * 78).epsilon(0.05));
    CHECK(result.bend.folded == 0);
    CHECK(result.borders.apartAfter < result.borders.apartBefore);
}

TEST_CASE("ontoPoints: a flat exemplar over a ball is a larger ball, even and without gaps") {
    const OntoPointsResult result = flatOnBall().points(warped(), -3);
    double worst = 0;
    for (std::size_t p = 0; p < result.sheet.size(); ++p) {
        const Vec3d place = cast<double>(result.sheet.points[p]);
        // The exemplar's points are in plane space at height 2, that is 5 above its zero.
        worst = std::max(worst, std::abs(length(place) - 40));
        REQUIRE(double(dot(result.sheet.normals[p], normalized(result.sheet.points[p]))) > 0.99);
    }
    CHECK(worst < 0.1);
    CHECK(double(result.sheet.size()) > 0.9 * 4 * kPi * 35 * 35);
    // Every place of the ball has a point within 1.5 of its spacings.
    const test::PointShape probes = test::spiralSphere(500, 40);
    for (const Vec3f& probe : probes.point) {
        float nearest = 1e9f;
        for (const Vec3f& point : result.sheet.points) nearest = std::min(nearest, length(point - probe));
        REQUIRE(nearest < 1.7f);
    }
    CHECK(result.bend.folded == 0);
    CHECK(result.bend.most == Approx(0).margin(1e-6));
    CHECK(result.bend.bare == 0);
}

TEST_CASE("ontoPoints: what would be inside out is left out and counted") {
    const test::PointShape tube = test::tubeShape(30, 60, 2);
    const Made made(test::eggCrateExemplar({16, 0}, 48), test::surfaceAlong(tube, {0, 0, 1}, 2));
    // The exemplar's points are in plane space at height 2: 40 below the surface of a tube of radius 30.
    const OntoPointsResult result = made.points({}, 42);
    CHECK(result.sheet.size() == 0);
    CHECK(result.bend.folded == Approx(1).margin(0.02));
    CHECK(result.bend.most == Approx(40.0 / 30).epsilon(0.05));
    CHECK(result.bend.dropped > 5000);
    // Half way down it is half as wide.
    const OntoPointsResult half = made.points({}, 17);
    CHECK(half.bend.most == Approx(0.5).epsilon(0.05));
    CHECK(half.bend.dropped == 0);
    CHECK(half.bend.folded == 0);
}

TEST_CASE("ontoPoints: errors, threads and cancelling") {
    SheetOptions options;
    options.reach = 65;
    CHECK(test::thrownBy([&] { flatOnBall().points(options); }).code == int(ErrorCode::InvalidOption));
    options = {};
    options.limit = 9;
    CHECK(test::thrownBy([&] { flatOnBall().points(options); }).code == int(ErrorCode::InvalidOption));
    const auto run = [&](const RunContext& ctx) { return flatOnBall().points(warped(), 2, ctx); };
    const OntoPointsResult one = run(test::onThreads(1)), four = run(test::onThreads(4));
    REQUIRE(one.sheet.size() == four.sheet.size());
    for (std::size_t p = 0; p < one.sheet.size(); ++p) {
        REQUIRE(length(one.sheet.points[p] - four.sheet.points[p]) == 0);
        REQUIRE(one.sheet.patch[p] == four.sheet.patch[p]);
    }
    CHECK(test::thrownWhenCancelled(run).code == int(ErrorCode::Cancelled));
}
