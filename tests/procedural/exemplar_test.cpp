#include "libvdbsynth/procedural/exemplar.h"

#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <catch2/catch.hpp>

#include <set>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

ExemplarOptions optionsFor(const std::string& kind, int resolution = 48) {
    ExemplarOptions options;
    options.kind = kind;
    options.resolution = resolution;
    return options;
}

// The solid voxels of the domain.
Occupancy solidOf(const ExemplarField& made) {
    Occupancy solid(made.domain.size());
    forEachVoxel(made.domain, [&](const Index3& voxel) {
        if (made.field.at(voxel) < 0) solid.set(voxel.x, voxel.y, voxel.z);
    });
    return solid;
}

}  // namespace

TEST_CASE("makeExemplar: every kind has solid and void, varies with the seed, repeats on any threads",
          "[procedural][determinism]") {
    for (const ExemplarKind& kind : exemplarKinds()) {
        INFO(kind.name);
        const auto run = [&](std::uint64_t seed, int threads) {
            RunContext ctx;
            ctx.seed = seed;
            ctx.threads = threads;
            return test::samplesOf(makeExemplar(optionsFor(kind.name), ctx).field);
        };
        const std::vector<float> one = run(1, 1);
        CHECK(one == run(1, 2));
        CHECK(one != run(2, 2));
        const double solid =
            double(std::count_if(one.begin(), one.end(), [](float v) { return v < 0; })) / double(one.size());
        CHECK(solid > 0.02);
        CHECK(solid < 0.75);
    }
}

TEST_CASE("makeExemplar: exact kinds change by at most a voxel a voxel", "[procedural][property]") {
    for (const ExemplarKind& kind : exemplarKinds()) {
        const ExemplarField made = makeExemplar(optionsFor(kind.name));
        if (!made.exact) continue;
        INFO(kind.name);
        float steepest = 0;
        for (int x = 0; x < made.domain.max.x; ++x)
            for (int y = 0; y < made.domain.max.y; ++y)
                for (int z = 0; z < made.domain.max.z; ++z) {
                    const float v = made.field.at({x, y, z});
                    steepest = std::max({steepest, std::abs(made.field.at({x + 1, y, z}) - v),
                                         std::abs(made.field.at({x, y + 1, z}) - v),
                                         std::abs(made.field.at({x, y, z + 1}) - v)});
                }
        CHECK(steepest <= 1.0001f);
    }
}

TEST_CASE("makeExemplar: no two rings of a chainmail fuse at the default feature", "[procedural][property]") {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        INFO("seed " << seed);
        RunContext ctx;
        ctx.seed = seed;
        const ExemplarField made = makeExemplar(optionsFor("chainmail", 128), ctx);
        const Components parts = findComponents(solidOf(made), Neighbours::All);
        // Rings of 0.40 and 0.31 features, tubes of 0.05, a feature of 24 voxels.
        const double tube = 2 * kPi * kPi * 1.2 * 1.2, flat = tube * 9.6, upright = tube * 7.44;
        std::size_t whole[2] = {0, 0};
        for (const std::uint64_t size : parts.interior) {
            const bool large = double(size) > (flat + upright) / 2;
            CHECK(double(size) == Approx(large ? flat : upright).epsilon(0.15));
            ++whole[large];
        }
        // About 5.8 cells a side, of which whole rings are 4.7 to 5.8.
        CHECK(whole[1] >= 16);
        CHECK(whole[0] >= 36);
    }
}

TEST_CASE("makeExemplar: no two flowers touch", "[procedural][property]") {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        INFO("seed " << seed);
        RunContext ctx;
        ctx.seed = seed;
        const Components parts =
            findComponents(solidOf(makeExemplar(optionsFor("flowers", 128), ctx)), Neighbours::All);
        // Sizes vary with the cube of 0.85 to 1.
        CHECK(parts.interior.size() > 15);
        CHECK(double(parts.interior.front()) < 2 * double(parts.interior.back()));
    }
}

TEST_CASE("makeExemplar: bumps rise from a plane and leave slopes that a height field has",
          "[procedural][property]") {
    const ExemplarField made = makeExemplar(optionsFor("bumps", 64));
    double least = 1e9, most = -1e9, steepest = 0;
    const auto heightAt = [&](int x, int y) {
        int z = 0;
        while (made.field.at({x, y, z}) <= 0) ++z;
        return z - double(made.field.at({x, y, z}));
    };
    for (int x = 0; x < 63; ++x)
        for (int y = 0; y < 64; ++y) {
            const double height = heightAt(x, y);
            least = std::min(least, height);
            most = std::max(most, height);
            steepest = std::max(steepest, std::abs(heightAt(x + 1, y) - height));
        }
    CHECK(least == Approx(0.35 * 16).margin(0.3));  // the plane, between the bumps
    CHECK(most > 0.35 * 16 + 0.2 * 16);
    CHECK(most < 16);
    CHECK(steepest < 2);
}

TEST_CASE("makeExemplar: lattice kinds of a larger domain begin with the smaller one's",
          "[procedural][property]") {
    for (const char* kind : {"grid", "fibres"}) {
        const BrickField small = makeExemplar(optionsFor(kind, 32)).field,
                         large = makeExemplar(optionsFor(kind, 48)).field;
        for (int x = 0; x < 32; x += 3)
            for (int y = 0; y < 32; y += 3)
                for (int z = 0; z < 32; ++z)
                    REQUIRE(small.at({x, y, z}) == Approx(large.at({x, y, z})).margin(1e-5));
    }
}

TEST_CASE("makeExemplar: the surface between samples is that of the samples", "[procedural][property]") {
    for (const ExemplarKind& kind : exemplarKinds()) {
        INFO(kind.name);
        const ExemplarField made = makeExemplar(optionsFor(kind.name, 32));
        CHECK(bool(made.surface) == (kind.name != "foam"));
        if (!made.surface) continue;
        forEachVoxel(made.domain, [&](const Index3& voxel) {
            const Vec3d p{double(voxel.x), double(voxel.y), double(voxel.z)};
            const double limit = double(kExemplarLimit);
            REQUIRE(std::clamp(made.surface(p), -limit, limit) ==
                    Approx(double(made.field.at(voxel))).margin(1e-5));
        });
    }
}

TEST_CASE("makeExemplar: finer samples and more around are the same geometry", "[procedural][property]") {
    for (const char* kind :
         {"grid", "chainmail", "fibres", "weave", "flowers", "bumps", "terrain", "sponge"}) {
        INFO(kind);
        const ExemplarField plain = makeExemplar(optionsFor(kind, 32));
        ExemplarSampling sampling;
        sampling.margin = {16, 9, 6};
        sampling.fine = 3;
        const ExemplarField finer = makeExemplar(optionsFor(kind, 32), sampling, {});
        const bool shapes = finer.fine == 3;
        CHECK(shapes == (plain.exact));
        CHECK(finer.domain == plain.domain);
        CHECK(finer.field.box().min == Index3{-16, -9, -6} * finer.fine);
        const float limit = kExemplarLimit / float(finer.fine);
        // Yarns are chords of a tenth of a feature, which begin elsewhere.
        forEachVoxel(plain.domain, [&](const Index3& voxel) {
            const float expected = std::clamp(plain.field.at(voxel), -limit, limit);
            REQUIRE(finer.field.at(voxel * finer.fine) / float(finer.fine) == Approx(expected).margin(0.1));
        });
    }
}

TEST_CASE("makeExemplar: each error of the sampling", "[procedural][error]") {
    const auto fails = [](ExemplarSampling sampling, const char* says) {
        const test::Thrown thrown =
            test::thrownBy([&] { makeExemplar(optionsFor("grid", 32), sampling, {}); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, says));
    };
    fails({{6, 6, 5}, 1}, "`margin` 5");
    fails({{6, 5000, 6}, 1}, "`margin` 5000");
    fails({{6, 6, 6}, 0}, "`fine` 0");
    fails({{6, 6, 6}, 9}, "`fine` 9");
}

TEST_CASE("makeExemplar: sizes, features and errors", "[procedural][error]") {
    ExemplarOptions options = optionsFor("weave");
    CHECK(makeExemplar(options).domain.size() == Index3{48, 48, 20});
    options.size = {40, 32, 24};
    CHECK(makeExemplar(options).domain.size() == Index3{40, 32, 24});
    options.size = {40, 32, 4};
    CHECK(test::contains(test::thrownBy([&] { makeExemplar(options); }).message, "`size` 40,32,4"));
    CHECK(test::contains(test::thrownBy([] { makeExemplar(optionsFor("cubes")); }).message,
                         "unknown kind; one of balls, grid"));
    CHECK(test::contains(test::thrownBy([] { makeExemplar(optionsFor("grid", 8)); }).message,
                         "`resolution` 8"));
    options = optionsFor("grid");
    options.feature = 2;
    CHECK(test::contains(test::thrownBy([&] { makeExemplar(options); }).message, "`feature` 2"));
    RunContext ctx;
    ctx.maxMemory = 1000000;
    CHECK(test::thrownBy([&] { makeExemplar(optionsFor("grid", 512), ctx); }).code == int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    ctx.maxMemory = 0;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { makeExemplar(optionsFor("balls"), ctx); }).code == int(ErrorCode::Cancelled));
}
