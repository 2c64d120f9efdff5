#include "libvdbsynth/patch/onto/onto_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace vdbsynth;

namespace {

int codeOf(void (*change)(OntoOptions&)) {
    OntoOptions options;
    change(options);
    return test::thrownBy([&] { validate(options); }).code;
}

}  // namespace

TEST_CASE("OntoOptions: what is out of range") {
    validate(OntoOptions{});
    const int refused = int(ErrorCode::InvalidOption);
    CHECK(codeOf([](OntoOptions& o) { o.patch = -1; }) == refused);
    CHECK(codeOf([](OntoOptions& o) { o.overlap = 0.9; }) == refused);
    CHECK(codeOf([](OntoOptions& o) { o.tolerance = 11; }) == refused);
    CHECK(codeOf([](OntoOptions& o) { o.step = 0.1; }) == refused);
    CHECK(codeOf([](OntoOptions& o) { o.repairs = -1; }) == refused);
    CHECK(codeOf([](OntoOptions& o) { o.scale = 0; }) == refused);
    CHECK(codeOf([](OntoOptions& o) { o.heightOffset = std::numeric_limits<double>::infinity(); }) ==
          refused);
    CHECK(codeOf([](OntoOptions& o) { o.heightOffset = std::numeric_limits<double>::quiet_NaN(); }) ==
          refused);
}

TEST_CASE("scaledExemplar: lengths are multiplied, directions stay") {
    const PatchExemplar exemplar = test::eggCrateExemplar({}, 48);
    const PatchExemplar half = scaledExemplar(exemplar, 0.5);
    CHECK(half.spacing == 0.5 * exemplar.spacing);
    CHECK(half.size.x == 24);
    CHECK(length(half.points[7] - exemplar.points[7] * 0.5f) == 0);
    CHECK(length(half.normals[7] - exemplar.normals[7]) == 0);
    CHECK(siteSpacing(half, {}) == Approx(0.5 * siteSpacing(exemplar, {})));
    OntoOptions options;
    options.step = 3;
    CHECK(siteSpacing(exemplar, options) == Approx(2.7));
}

TEST_CASE("synthesizeOnto: the middle height lies on the surface, and an offset moves it outward") {
    const test::PointShape ball = test::spiralSphere(3000, 30);
    const OntoSurface surface = ontoSurface(ball.point, ball.normal, {}, 1.8);
    const PatchExemplar crate = test::eggCrateExemplar({}, 48);
    OntoOptions options;
    for (const double offset : {0.0, 3.0}) {
        options.heightOffset = offset;
        const OntoResult result = synthesizeOnto(crate, surface, options);
        double low = 1e9, high = 0;
        for (const Vec3f& p : result.sheet.points) {
            low = std::min(low, double(length(p)));
            high = std::max(high, double(length(p)));
        }
        CHECK(low == Approx(28 + offset).margin(0.5));
        CHECK(high == Approx(32 + offset).margin(0.5));
        CHECK(result.patches == result.arrangement.patches.size());
        CHECK(result.patch > 10);
        CHECK(result.step == Approx(2).epsilon(0.1));
    }
}

TEST_CASE("synthesizeOnto: an exemplar too small, a patch too large, threads, cancelling") {
    const test::PointShape ball = test::spiralSphere(1500, 20);
    const OntoSurface surface = ontoSurface(ball.point, ball.normal, {}, 1.8);
    const PatchExemplar crate = test::eggCrateExemplar({}, 48);
    OntoOptions options;
    options.patch = 100;
    CHECK(test::thrownBy([&] { synthesizeOnto(crate, surface, options); }).code == int(ErrorCode::Unusable));
    CHECK(test::thrownBy([&] { synthesizeOnto(test::eggCrateExemplar({}, 6), surface, {}); }).code ==
          int(ErrorCode::Unusable));
    const auto run = [&](const RunContext& ctx) { return synthesizeOnto(crate, surface, {}, ctx); };
    const OntoResult one = run(test::onThreads(1)), three = run(test::onThreads(3));
    CHECK(one.arrangement.label == three.arrangement.label);
    REQUIRE(one.sheet.size() == three.sheet.size());
    for (std::size_t p = 0; p < one.sheet.size(); ++p)
        REQUIRE(length(one.sheet.points[p] - three.sheet.points[p]) == 0);
    CHECK(test::thrownWhenCancelled(run).code == int(ErrorCode::Cancelled));
}
