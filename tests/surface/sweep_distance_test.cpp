#include "libvdbsynth/surface/sweep_distance.h"

#include <catch2/catch.hpp>

#include "tests/support/shapes.h"

#include <atomic>

using namespace vdbsynth;

namespace {

std::vector<Vec3f> tangents(const SurfaceShell& shell, const std::function<Vec3f(const Vec3f&)>& direction) {
    std::vector<Vec3f> all;
    for (const Vec3f& p : shell.point) all.push_back(direction(p));
    return all;
}

// For every voxel and neighbour: visit(i, j, s_j - s_i - (T_i + T_j)/2 . (x_j - x_i)).
template <typename Visit>
void forPairs(const SurfaceShell& shell, const std::vector<Vec3f>& tangent, const std::vector<float>& s,
              const Visit& visit) {
    for (std::uint32_t i = 0; i < shell.size(); ++i)
        for (std::uint32_t k = shell.begin[i]; k < shell.begin[i + 1]; ++k) {
            const std::uint32_t j = shell.neighbours[k];
            visit(i, j,
                  double(s[j]) - double(s[i]) -
                      double(dot(tangent[i] + tangent[j], shell.point[j] - shell.point[i])) / 2);
        }
}

// Length of the sums' gradient: zero where they are least.
double slopeOf(const SurfaceShell& shell, const std::vector<Vec3f>& tangent, const std::vector<float>& s) {
    std::vector<double> sums(shell.size(), 0);
    forPairs(shell, tangent, s,
             [&](std::uint32_t i, std::uint32_t, double residual) { sums[i] += residual; });
    double squares = 0;
    for (double sum : sums) squares += sum * sum;
    return std::sqrt(squares);
}

Vec3f around(const Vec3f& p) {
    return normalized(Vec3f{-(p.y - 19.5f), p.x - 19.5f, 0});
}

}  // namespace

TEST_CASE("sweepDistance: along an axis of a plane it is that coordinate", "[surface][oracle]") {
    const SurfaceShell shell = surfaceShell(*test::planeField(40, 20.5));
    const SweepDistance sweep = sweepDistance(shell, tangents(shell, [](const Vec3f&) {
                                                  return Vec3f{1, 0, 0};
                                              }));
    const float first = sweep.distance.front() - shell.point.front().x;
    for (std::size_t i = 0; i < shell.size(); ++i)
        CHECK(sweep.distance[i] - shell.point[i].x == Approx(first).margin(1e-3));
    CHECK(sweep.cut == 0);
}

TEST_CASE("sweepDistance: the gradient of a quadratic gives that function back", "[surface][oracle]") {
    const auto value = [](const Vec3f& p) { return 0.01f * p.x * p.x - 0.02f * p.x * p.y + 0.5f * p.y; };
    const SurfaceShell shell = surfaceShell(*test::planeField(32, 15.5));
    const SweepDistance sweep = sweepDistance(shell, tangents(shell, [](const Vec3f& p) {
                                                  return Vec3f{0.02f * (p.x - p.y), 0.5f - 0.02f * p.x, 0};
                                              }));
    const float first = sweep.distance.front() - value(shell.point.front());
    for (std::size_t i = 0; i < shell.size(); ++i)
        CHECK(sweep.distance[i] - value(shell.point[i]) == Approx(first).margin(1e-3));
}

TEST_CASE("sweepDistance: least squares where no order fits all pairs", "[surface][property]") {
    // Unit vectors round a point beside the plane: they are no gradient, but nothing jumps.
    const SurfaceShell shell = surfaceShell(*test::planeField(24, 11.5));
    const std::vector<Vec3f> tangent = tangents(shell, [](const Vec3f& p) {
        return normalized(Vec3f{-(p.y - 12), p.x + 20, 0});
    });
    const SweepDistance sweep = sweepDistance(shell, tangent);
    CHECK(sweep.cut == 0);
    double most = 0;
    forPairs(shell, tangent, sweep.distance, [&](std::uint32_t, std::uint32_t, double residual) {
        most = std::max(most, std::abs(residual));
    });
    CHECK(most > 0.01);
    CHECK(slopeOf(shell, tangent, sweep.distance) <
          1e-3 * slopeOf(shell, tangent, std::vector<float>(shell.size(), 0)));
}

TEST_CASE("sweepDistance: neighbours behind come earlier, but for the cut a rotating field must have",
          "[surface][property]") {
    const SurfaceShell shell = surfaceShell(*test::cylinderField(40, 13));
    const std::vector<Vec3f> tangent = tangents(shell, around);
    const SweepDistance sweep = sweepDistance(shell, tangent);
    std::size_t behind = 0, earlier = 0, pairs = 0, jumps = 0;
    forPairs(shell, tangent, sweep.distance, [&](std::uint32_t i, std::uint32_t j, double residual) {
        ++pairs;
        jumps += std::abs(residual) > 2;
        if (dot(tangent[i], shell.point[j] - shell.point[i]) > -0.5f) return;
        ++behind;
        earlier += sweep.distance[j] < sweep.distance[i];
    });
    REQUIRE(behind > 1000);
    CHECK(double(earlier) / double(behind) > 0.96);
    CHECK(sweep.cut > 0.001);
    CHECK(sweep.cut < 0.06);
    CHECK(sweep.cut == Approx(double(jumps) / double(pairs)).margin(1e-4));
    // Once round, less the step over the cut.
    const auto [low, high] = std::minmax_element(sweep.distance.begin(), sweep.distance.end());
    CHECK(*high - *low == Approx(2 * 3.14159 * 13).epsilon(0.1));
}

TEST_CASE("sweepDistance: separate parts each have their order, no directions give none",
          "[surface][degenerate]") {
    const auto planes =
        test::shapeField({20, 20, 40}, [](const Vec3d& p) { return std::abs(p.z - 19.5) - 10; });
    const SurfaceShell shell = surfaceShell(*planes);
    const SweepDistance sweep = sweepDistance(shell, tangents(shell, [](const Vec3f& p) {
                                                  return p.z > 19.5f ? Vec3f{1, 0, 0} : Vec3f{0, -1, 0};
                                              }));
    CHECK(sweep.cut == 0);
    float low = 1e9f, high = 1e9f;  // of each part, from its coordinate to the distance
    for (std::size_t i = 0; i < shell.size(); ++i) {
        const Vec3f& p = shell.point[i];
        float& shift = p.z > 19.5f ? high : low;
        const float s = sweep.distance[i] - (p.z > 19.5f ? p.x : -p.y);
        if (shift > 1e8f) shift = s;
        CHECK(s == Approx(shift).margin(1e-3));
    }
    const SweepDistance none = sweepDistance(shell, std::vector<Vec3f>(shell.size()));
    CHECK(none.distance == std::vector<float>(shell.size(), 0));
    CHECK(none.cut == 0);
}

TEST_CASE("sweepDistance: the same bits for any threads, stops when asked to",
          "[surface][determinism][cancel]") {
    const SurfaceShell shell = surfaceShell(*test::cylinderField(40, 12));
    const std::vector<Vec3f> tangent = tangents(shell, around);
    RunContext one, four, stopped;
    one.threads = 1;
    four.threads = 4;
    const SweepDistance a = sweepDistance(shell, tangent, one), b = sweepDistance(shell, tangent, four);
    CHECK(a.distance == b.distance);
    CHECK(a.cut == b.cut);
    std::atomic<bool> stop{true};
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { sweepDistance(shell, tangent, stopped); }).code == int(ErrorCode::Cancelled));
}
