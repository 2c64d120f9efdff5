#include "libvdbsynth/measure/correlation.h"

#include "libvdbsynth/math/trigonometry.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/solids.h"

using namespace vdbsynth;
using test::solidFrom;

TEST_CASE("twoPointCorrelation: slabs have a triangle wave across and a constant along",
          "[measure][oracle]") {
    // Slabs 8 thick every 16 voxels, 8 periods.
    const Occupancy solid = solidFrom({128, 40, 40}, [](const Index3& p) { return p.x % 16 < 8; });
    const TwoPointCorrelation s2 = twoPointCorrelation(solid, 32);
    for (int r = 0; r <= 32; ++r) {
        const int phase = r % 16;
        const double expected = double(phase < 8 ? 8 - phase : phase - 8) / 16;
        // Pairs lie within 128 - r voxels, not whole periods: half a slab's worth may be off.
        CHECK(s2.axis[0][std::size_t(r)] == Approx(expected).margin(4.0 / (128 - r)));
        CHECK(s2.axis[1][std::size_t(r)] == Approx(0.5));
        CHECK(s2.axis[2][std::size_t(r)] == Approx(0.5));
    }
    CHECK(s2.radial[0] == Approx(0.5));
}

TEST_CASE("radialShifts: lengths round to r, none twice, in no preferred direction", "[measure][property]") {
    CHECK(radialShifts(0) == std::vector<Index3>{{0, 0, 0}});
    for (int r = 1; r <= 64; ++r) {
        const std::vector<Index3> shifts = radialShifts(r);
        CHECK(shifts.size() <= 48);
        CHECK(shifts.size() >= (r == 1 ? 9u : 20u));
        double squares[3] = {0, 0, 0};
        for (const Index3& p : shifts) {
            const double length = std::sqrt(double(p.x * p.x + p.y * p.y + p.z * p.z));
            CHECK(std::lround(length) == r);
            CHECK(std::count(shifts.begin(), shifts.end(), p) == 1);
            if (r > 0) CHECK(std::count(shifts.begin(), shifts.end(), p * -1) == 0);
            for (int axis = 0; axis < 3; ++axis)
                squares[axis] += double(p[axis] * p[axis]) / (length * length);
        }
        for (double share : squares) CHECK(share / double(shifts.size()) == Approx(1.0 / 3).margin(0.04));
    }
}

TEST_CASE("twoPointCorrelation: overlapping balls follow Torquato's closed form", "[measure][oracle]") {
    // Boolean model: S2(r) = 1 - 2 q + q^(union of two balls / ball), void fraction q = exp(-density * ball).
    const double radius = 6, density = 4e-4, ball = 4.0 / 3 * kPi * radius * radius * radius;
    const double void1 = std::exp(-density * ball);
    const int n = 144, reach = 24;
    std::vector<double> radial(reach + 1, 0);
    const int samples = 4;
    for (std::uint64_t seed = 0; seed < samples; ++seed) {
        BrickField field(IndexBox::fromSize({n, n, n}), 1.f);
        const double side = n + 2 * radius;
        std::vector<std::uint8_t> inside(std::size_t(n) * n * n, 0);
        const int count = int(std::lround(density * side * side * side));
        for (int i = 0; i < count; ++i) {
            Random random(seed, std::uint64_t(i));
            const double x = random.uniform(-radius, n + radius), y = random.uniform(-radius, n + radius),
                         z = random.uniform(-radius, n + radius);
            for (int a = std::max(0, int(x - radius)); a <= std::min(n - 1, int(x + radius) + 1); ++a)
                for (int b = std::max(0, int(y - radius)); b <= std::min(n - 1, int(y + radius) + 1); ++b)
                    for (int c = std::max(0, int(z - radius)); c <= std::min(n - 1, int(z + radius) + 1); ++c)
                        if ((a - x) * (a - x) + (b - y) * (b - y) + (c - z) * (c - z) < radius * radius)
                            inside[std::size_t((a * n + b) * n + c)] = 1;
        }
        const Occupancy solid = solidFrom(
            {n, n, n}, [&](const Index3& p) { return inside[std::size_t((p.x * n + p.y) * n + p.z)] != 0; });
        const TwoPointCorrelation s2 = twoPointCorrelation(solid, reach);
        for (std::size_t r = 0; r < radial.size(); ++r) radial[r] += s2.radial[r] / samples;
    }
    for (int r = 0; r <= reach; ++r) {
        const double u = r / radius;
        const double both = u < 2 ? 2 - (1 - 0.75 * u + u * u * u / 16) : 2;
        const double expected = 1 - 2 * void1 + std::exp(-density * ball * both);
        INFO("r = " << r);
        CHECK(radial[std::size_t(r)] == Approx(expected).margin(0.012));
    }
}

TEST_CASE("twoPointCorrelation: the radial value is the mean over all displacements of that length",
          "[measure][oracle]") {
    const Occupancy solid = Occupancy::fromField(test::ballsField({30, 28, 33}, 4, 3.f, 9));
    const TwoPointCorrelation s2 = twoPointCorrelation(solid, 4);
    for (int r = 1; r <= 4; ++r) {
        double hits = 0, pairs = 0;
        for (int x = -r - 1; x <= r + 1; ++x)
            for (int y = -r - 1; y <= r + 1; ++y)
                for (int z = -r - 1; z <= r + 1; ++z) {
                    if (std::lround(std::sqrt(double(x * x + y * y + z * z))) != r) continue;
                    hits += double(countPairs(solid, solid, {x, y, z}));
                    pairs += double(30 - std::abs(x)) * (28 - std::abs(y)) * (33 - std::abs(z));
                }
        // From r = 3 on a part of the shell stands for all of it.
        CHECK(s2.radial[std::size_t(r)] == Approx(hits / pairs).epsilon(r <= 2 ? 1e-9 : 0.03));
    }
    RunContext one;
    one.threads = 1;
    CHECK(twoPointCorrelation(solid, 20, one).radial == twoPointCorrelation(solid, 20).radial);
}

TEST_CASE("lineStatistics: slabs have chords of their thickness", "[measure][oracle]") {
    const Occupancy solid = solidFrom({20, 20, 131}, [](const Index3& p) { return (p.z + 3) % 12 < 5; });
    const LineStatistics lines = lineStatistics(solid, 2, 10);
    CHECK(lines.chords[5] == Approx(1));
    CHECK(lines.meanChord == Approx(5).epsilon(0.03));  // 131 voxels are not whole periods
    // A segment from a voxel to the r-th after it fits into 5 - r places of every 12.
    for (int r = 0; r <= 10; ++r)
        CHECK(lines.linealPath[std::size_t(r)] == Approx(std::max(0, 5 - r) / 12.0).margin(0.03));
    const LineStatistics along = lineStatistics(solid, 0, 10);
    CHECK(along.meanChord == 0);  // no chord ends
    CHECK(along.chords[10] == 0);
    CHECK(along.linealPath[10] == Approx(along.linealPath[0]));
}

TEST_CASE("lineStatistics: the mean chord of balls is two thirds of the diameter", "[measure][oracle]") {
    const double radius = 12.3;
    const Occupancy solid = solidFrom({120, 120, 120}, [&](const Index3& p) {
        const double x = p.x % 40 - 19.7, y = p.y % 40 - 20.1, z = p.z % 40 - 19.9;
        return x * x + y * y + z * z < radius * radius;
    });
    for (int axis = 0; axis < 3; ++axis)
        CHECK(lineStatistics(solid, axis, 30).meanChord == Approx(4.0 / 3 * radius).epsilon(0.03));
}
