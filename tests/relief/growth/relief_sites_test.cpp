#include "libvdbsynth/relief/growth/relief_sites.h"

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

SurfaceSites sitesOf(const test::PointShape& shape) {
    return sitesOfPoints(shape.point, shape.normal, 8);
}

std::vector<std::uint32_t> membersOf(const ReliefNeighbourhoods& all, std::size_t site) {
    return {all.member.begin() + std::ptrdiff_t(all.begin[site]),
            all.member.begin() + std::ptrdiff_t(all.begin[site + 1])};
}

}  // namespace

TEST_CASE("reliefFrame: by hand, and what has no tangent") {
    const ReliefFrame frame = reliefFrame({1, 2, 3}, {0, 0, 1}, {0, 2, 5});
    CHECK(frame.tangent.y == 1);
    CHECK(frame.binormal.x == -1);
    const Vec3f local = frame.toLocal({7, 8, 9});
    CHECK(local.x == 8);
    CHECK(local.y == -7);
    CHECK(local.z == 9);
    const Vec3f back = frame.toWorld(local);
    CHECK(back.x == 7);
    CHECK(back.y == 8);
    for (const Vec3f& tangent : {Vec3f{0, 0, 0}, Vec3f{0, 0, 3}}) {
        const ReliefFrame any = reliefFrame({}, {0, 0, 1}, tangent);
        CHECK(length(any.tangent) == Approx(1));
        CHECK(dot(any.tangent, any.normal) == Approx(0).margin(1e-6));
    }
}

TEST_CASE("mapped: keeps lengths and angles between random frames") {
    for (std::uint64_t i = 0; i < 50; ++i) {
        Random random(3, i);
        const auto draw = [&] {
            return Vec3f{float(random.normal()), float(random.normal()), float(random.normal())};
        };
        const ReliefFrame a = reliefFrame({}, normalized(draw()), draw());
        const ReliefFrame b = reliefFrame({}, normalized(draw()), draw());
        const Vec3f u = draw(), v = draw();
        CHECK(dot(mapped(u, a, b), mapped(v, a, b)) == Approx(dot(u, v)).margin(1e-4));
        CHECK(length(mapped(mapped(u, a, b), b, a) - u) < 1e-5f);
        CHECK(dot(mapped(a.normal, a, b), b.normal) == Approx(1));
    }
}

TEST_CASE("reliefNeighbourhoods: the same as a linear scan on a ball, with Gaussian weights") {
    const SurfaceSites sites = sitesOf(test::spiralSphere(800, 8));
    const ReliefNeighbourhoods all = reliefNeighbourhoods(sites, 3, 0.5);
    CHECK(all.cut == 0);
    for (std::uint32_t i = 0; i < sites.size(); i += 7) {
        std::vector<std::pair<float, std::uint32_t>> near;
        for (std::uint32_t j = 0; j < sites.size(); ++j) {
            const Vec3f d = sites.point[j] - sites.point[i];
            if (j != i && dot(d, d) <= 9) near.push_back({dot(d, d), j});
        }
        std::sort(near.begin(), near.end());
        REQUIRE(all.size(i) == near.size());
        for (std::size_t k = 0; k < near.size(); ++k) {
            REQUIRE(all.member[all.begin[i] + k] == near[k].second);
            REQUIRE(all.weight[all.begin[i] + k] ==
                    Approx(exponential(-double(near[k].first) / (2 * 1.5 * 1.5))));
        }
    }
}

TEST_CASE("meanSpacing: a lattice by hand, random sites and pairs by their density") {
    // Of nine points the middle one's eighth neighbour is at sqrt(2), a corner's at sqrt(8), an edge's at
    // sqrt(5).
    const double unit = std::sqrt(kPi / 8.5);
    CHECK(meanSpacing(sitesOf(test::latticePlane(3))) ==
          Approx(unit * (std::sqrt(2.0) + 4 * std::sqrt(8.0) + 4 * std::sqrt(5.0)) / 9));
    test::PointShape shape = test::randomPlane(2500, 50);
    CHECK(meanSpacing(sitesOf(shape)) == Approx(1).epsilon(0.1));
    for (std::size_t i = 0; i < 2500; ++i) {  // another one beside each
        shape.point.push_back(shape.point[i] + Vec3f{1e-3f, 0, 0});
        shape.normal.push_back({0, 0, 1});
    }
    CHECK(meanSpacing(sitesOf(shape)) == Approx(std::sqrt(0.5)).epsilon(0.2));
    CHECK(meanSpacing(sitesOfPoints({{0, 0, 0}}, {{0, 0, 1}}, 8)) == 0);
}

TEST_CASE("reliefNeighbourhoods: the far side of a thin wall is out, crowds are cut") {
    test::PointShape wall = test::latticePlane(12);
    const std::size_t half = wall.point.size();
    for (std::size_t i = 0; i < half; ++i) {
        wall.point.push_back(wall.point[i] + Vec3f{0, 0, -0.3f});
        wall.normal.push_back({0, 0, -1});
    }
    const ReliefNeighbourhoods sides = reliefNeighbourhoods(sitesOf(wall), 2, 0.5);
    for (std::size_t i = 0; i < half; ++i)
        for (std::uint32_t v : membersOf(sides, i)) REQUIRE(v < half);

    const ReliefNeighbourhoods crowd = reliefNeighbourhoods(sitesOf(test::randomPlane(700, 1)), 5, 0.5);
    CHECK(crowd.cut == 700);
    CHECK(crowd.size(0) == kMostNeighbours);
}

TEST_CASE("reliefNeighbourhoods: one site, threads, memory, cancel") {
    CHECK(reliefNeighbourhoods(sitesOfPoints({{0, 0, 0}}, {{0, 0, 1}}, 8), 1, 0.5).member.empty());
    const SurfaceSites sites = sitesOf(test::randomPlane(5000, 30));
    const ReliefNeighbourhoods one = reliefNeighbourhoods(sites, 2, 0.5, test::onThreads(1));
    const ReliefNeighbourhoods four = reliefNeighbourhoods(sites, 2, 0.5, test::onThreads(4));
    CHECK(one.member == four.member);
    CHECK(one.weight == four.weight);
    RunContext little;
    little.maxMemory = 10000;
    CHECK(test::thrownBy([&] { reliefNeighbourhoods(sites, 2, 0.5, little); }).code ==
          int(ErrorCode::Memory));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              reliefNeighbourhoods(sites, 2, 0.5, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("requireReliefSites: every error") {
    const SurfaceSites sites = sitesOf(test::latticePlane(3));
    const ReliefSites good{sites, std::vector<Vec3f>(9, {1, 0, 0}), std::vector<Vec3f>(9)};
    requireReliefSites(good, "the sample");
    const auto codeOf = [](const ReliefSites& relief) {
        return test::thrownBy([&] { requireReliefSites(relief, "the sample"); }).code;
    };
    CHECK(codeOf({}) == int(ErrorCode::EmptyInput));
    ReliefSites bad = good;
    bad.tangent.pop_back();
    CHECK(codeOf(bad) == int(ErrorCode::ShapeMismatch));
    bad = good;
    bad.displacement.pop_back();
    CHECK(codeOf(bad) == int(ErrorCode::ShapeMismatch));
    bad = good;
    bad.sites.neighbours[0] = 9;
    CHECK(codeOf(bad) == int(ErrorCode::ShapeMismatch));
    bad = good;
    bad.displacement[4].y = std::nanf("");
    CHECK(codeOf(bad) == int(ErrorCode::Unusable));
    bad = good;
    bad.sites.normal[4].y = std::nanf("");
    CHECK(codeOf(bad) == int(ErrorCode::Unusable));
}
