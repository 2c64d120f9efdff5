#include "libvdbsynth/relief/growth/orientation_iteration.h"

#include "tests/support/contexts.h"
#include "tests/support/relief_shapes.h"
#include "tests/support/said.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

constexpr int kSide = 36;

struct Case {
    test::SineRelief sine;
    ReliefSites sample = test::sineSample(sine, kSide);
    ReliefDistance distance = test::sineDistance(sine, kSide);
};

OrientationOptions options() {
    OrientationOptions o;
    o.neighbourhood = 6;
    return o;
}

// Share of tangents within 10 degrees of a direction, or of its opposite.
double shareAlong(const std::vector<Vec3f>& tangent, const Vec3f& direction) {
    std::size_t good = 0;
    for (const Vec3f& t : tangent)
        if (std::abs(dot(t, direction)) > 0.98481f) ++good;
    return double(good) / double(tangent.size());
}

// A tangent of its own for every site.
std::vector<Vec3f> randomTangents(std::size_t count) {
    std::vector<Vec3f> tangents;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = Random(9, i).uniform(0, 2 * kPi);
        tangents.push_back({float(cosine(angle)), float(sine(angle)), 0});
    }
    return tangents;
}

}  // namespace

TEST_CASE("iterateOrientation: the stripes of a sine, from arbitrary tangents") {
    Case c;
    c.sample.tangent = randomTangents(c.sample.sites.size());
    // The reference keeps its own, whichever site it is: every tangent is at one angle to the stripes.
    const ReliefOrientation found = iterateOrientation(c.sample, c.distance, options());
    CHECK(found.converged);
    Vec3f mean;
    for (const Vec3f& t : found.tangent) mean = mean + t * (dot(t, found.tangent[0]) < 0 ? -1.f : 1.f);
    INFO("rounds " << found.rounds << " change " << found.change);
    CHECK(shareAlong(found.tangent, normalized(mean)) > 0.9);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.tangent.size(); ++i)
        kept += std::abs(dot(c.sample.tangent[i], normalized(mean))) > 0.98f ? 1 : 0;
    CHECK(kept > 0);
}

TEST_CASE("iterateOrientation: rings, of which the direction turns with the place") {
    const test::SineRelief sine;
    constexpr double kCentre = -25;
    ReliefSites rings = test::sineSample(sine, kSide);
    for (std::size_t i = 0; i < rings.sites.size(); ++i) {
        const Vec3f away = rings.sites.point[i] - Vec3f{float(kCentre), float(kCentre), 0};
        rings.displacement[i].z = float(sine.height(double(length(away))));
        rings.tangent[i] = away;
    }
    const ReliefDistance distance(test::ringsBand(sine, kCentre, kSide, 6, 6), {0, 0, -6}, 1, 6);
    const ReliefOrientation found = iterateOrientation(rings, distance, options());
    std::size_t good = 0;
    for (std::size_t i = 0; i < rings.sites.size(); ++i) {
        REQUIRE(length(found.tangent[i]) == Approx(1));
        REQUIRE(found.tangent[i].z == Approx(0).margin(1e-6));
        good += std::abs(dot(found.tangent[i], normalized(rings.tangent[i]))) > 0.98481f ? 1 : 0;
    }
    INFO("rounds " << found.rounds << " change " << found.change);
    CHECK(double(good) > 0.9 * double(rings.sites.size()));
}

TEST_CASE("growAndOrient: a target without directions") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(600, 24));
    GrownReliefOptions grow;
    grow.neighbourhood = 6;
    test::Said said;
    const OrientedRelief found = growAndOrient(c.sample, c.distance, target, grow, {}, said.ctx);
    CHECK(said.noted("the orientation of the target is found by iteration"));
    CHECK(said.notes.size() == 1);
    CHECK(said.warnings.empty());
    const Vec3f first = found.orientation.tangent[0];
    CHECK(shareAlong(found.orientation.tangent, first) > 0.9);
    INFO(found.orientation.rounds << " growths, change " << found.orientation.change << " first " << first.x
                                  << " " << first.y);
    CHECK(found.relief.displacement.size() == 600);
    CHECK(std::sqrt(found.relief.grownMean) < 0.15);
}

TEST_CASE("iterateOrientation: degenerate surfaces") {
    const Case c;
    const SurfaceSites single = sitesOfPoints({{3, 3, 0}}, {{0, 0, 1}}, 8);
    CHECK(iterateOrientation({single, {}, {{0, 0, 0}}}, c.distance).tangent.size() == 1);
    // Without relief the reference's direction is carried everywhere.
    ReliefSites flat = c.sample;
    for (Vec3f& d : flat.displacement) d = {};
    flat.tangent.assign(flat.sites.size(), {0, 1, 0});
    const ReliefDistance plane = test::sineDistance({0, 12}, kSide);
    CHECK(shareAlong(iterateOrientation(flat, plane, options()).tangent, {0, 1, 0}) == 1);
}

TEST_CASE("iterateOrientation: errors, what is said, threads, cancel") {
    Case c;
    c.sample.tangent = randomTangents(c.sample.sites.size());
    const auto codeOf = [&](auto change) {
        OrientationOptions o = options();
        change(o);
        return test::thrownBy([&] { iterateOrientation(c.sample, c.distance, o); }).code;
    };
    const int invalid = int(ErrorCode::InvalidOption);
    CHECK(codeOf([](auto& o) { o.angles = 7; }) == invalid);
    CHECK(codeOf([](auto& o) { o.smoothness = -1; }) == invalid);
    CHECK(codeOf([](auto& o) { o.limit = 0; }) == invalid);
    CHECK(codeOf([](auto& o) { o.rounds = 0; }) == invalid);
    CHECK(codeOf([](auto& o) { o.neighbourhood = -1; }) == invalid);
    CHECK(codeOf([](auto& o) { o.weightFalloff = 0; }) == invalid);
    CHECK(test::thrownBy([&] { iterateOrientation({}, c.distance); }).code == int(ErrorCode::EmptyInput));
    test::Said said;
    OrientationOptions once = options();
    once.rounds = 1;
    once.limit = 0.01;
    iterateOrientation(c.sample, c.distance, once, said.ctx);
    CHECK(said.warned("still changes by"));
    const auto on = [&](int threads) {
        const auto found =
            iterateOrientation(c.sample, c.distance, options(), test::onThreads(threads)).tangent;
        std::vector<float> all;
        for (const Vec3f& t : found) all.insert(all.end(), {t.x, t.y, t.z});
        return all;
    };
    CHECK(on(1) == on(4));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              iterateOrientation(c.sample, c.distance, options(), ctx);
          }).code == int(ErrorCode::Cancelled));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              growAndOrient(c.sample, c.distance, c.sample.sites, {}, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}
