#include "libvdbsynth/patch/onto/onto_surface.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

TEST_CASE("ontoSurface: neighbours know each other, ascending, and tangents are tangents") {
    const test::PointShape ball = test::spiralSphere(900, 10);
    const OntoSurface surface = test::surfaceAlong(ball, {0, 0, 1}, 1.2);
    const SurfaceSites& sites = surface.sites;
    REQUIRE(sites.size() == 900);
    for (std::uint32_t s = 0; s < sites.size(); ++s) {
        REQUIRE(sites.degree(s) >= 8);
        const auto begin = sites.neighbours.begin() + sites.begin[s],
                   end = sites.neighbours.begin() + sites.begin[s + 1];
        REQUIRE(std::is_sorted(begin, end));
        REQUIRE(std::find(begin, end, s) == end);
        for (auto n = begin; n != end; ++n)
            REQUIRE(std::binary_search(sites.neighbours.begin() + sites.begin[*n],
                                       sites.neighbours.begin() + sites.begin[*n + 1], s));
        REQUIRE(std::abs(length(surface.tangent[s]) - 1) < 1e-4f);
        REQUIRE(std::abs(dot(surface.tangent[s], sites.normal[s])) < 1e-4f);
    }
    // A direction field on a ball has no less than one place without a direction.
    CHECK(surface.singularities.size() >= 1);
}

TEST_CASE("ontoSurface: given directions stay, and without any there is a smooth field") {
    const test::PointShape tube = test::tubeShape(8, 20, 1);
    const OntoSurface along = test::surfaceAlong(tube, {0, 0, 1}, 1);
    for (const Vec3f& t : along.tangent) REQUIRE(t.z > 0.999f);
    const OntoSurface smooth = ontoSurface(tube.point, tube.normal, {}, 1);
    CHECK(smooth.tangent.size() == tube.point.size());
    CHECK(smooth.singularities.empty());
}

TEST_CASE("ontoSurface: errors, threads and cancelling") {
    const test::PointShape ball = test::spiralSphere(300, 5);
    CHECK(test::thrownBy([&] { ontoSurface({}, {}, {}, 1); }).code == int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] { ontoSurface(ball.point, ball.normal, {}, 0); }).code ==
          int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([&] {
              ontoSurface(ball.point, {{0, 0, 1}}, {}, 1);
          }).code == int(ErrorCode::ShapeMismatch));
    CHECK(test::thrownBy([&] {
              ontoSurface(ball.point, ball.normal, {{0, 0, 1}}, 1);
          }).code == int(ErrorCode::ShapeMismatch));
    const auto run = [&](const RunContext& ctx) { return ontoSurface(ball.point, ball.normal, {}, 1, ctx); };
    const OntoSurface one = run(test::onThreads(1)), four = run(test::onThreads(4));
    CHECK(one.sites.neighbours == four.sites.neighbours);
    for (std::size_t s = 0; s < one.tangent.size(); ++s)
        REQUIRE(length(one.tangent[s] - four.tangent[s]) == 0);
    CHECK(test::thrownWhenCancelled(run).code == int(ErrorCode::Cancelled));
}

TEST_CASE("ontoSurfaceAlong: the surface again from what was kept of it, and errors") {
    const test::PointShape ball = test::spiralSphere(300, 5);
    const OntoSurface made = ontoSurface(ball.point, ball.normal, {}, 1);
    const OntoSurface again = ontoSurfaceAlong(made.sites.point, made.sites.normal, made.tangent);
    CHECK(again.sites.begin == made.sites.begin);
    CHECK(again.sites.neighbours == made.sites.neighbours);
    for (std::size_t s = 0; s < made.tangent.size(); ++s)
        REQUIRE(length(made.tangent[s] - again.tangent[s]) == 0);
    CHECK(test::thrownBy([&] { ontoSurfaceAlong({}, {}, {}); }).code == int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] {
              ontoSurfaceAlong(ball.point, ball.normal, {{1, 0, 0}});
          }).code == int(ErrorCode::ShapeMismatch));
}
