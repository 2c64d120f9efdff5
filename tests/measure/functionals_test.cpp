#include "libvdbsynth/measure/functionals.h"

#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/measure/components.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

Occupancy solidFrom(const Index3& size, const std::function<bool(const Index3&)>& inside) {
    return Occupancy::fromField(
        test::fieldFrom(size, [&](const Index3& p) { return inside(p) ? -1.f : 1.f; }));
}

bool inBall(const Index3& p, double x, double y, double z, double radius) {
    return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y) + (p.z - z) * (p.z - z) < radius * radius;
}

}  // namespace

TEST_CASE("Occupancy: bits are the field's signs, windows and counts agree", "[measure][oracle]") {
    const BrickField field = test::noiseField({21, 9, 130}, 3);
    const Occupancy solid = Occupancy::fromField(field);
    std::uint64_t expected = 0;
    for (int x = 0; x < 21; ++x)
        for (int y = 0; y < 9; ++y)
            for (int z = 0; z < 130; ++z) {
                REQUIRE(solid.at(x, y, z) == (field.at({x, y, z}) < 0));
                expected += field.at({x, y, z}) < 0;
            }
    CHECK(solid.count() == expected);
    CHECK(solid.complement().count() == 21 * 9 * 130 - expected);
    const Occupancy window = solid.window({{2, 3, 61}, {20, 8, 127}});
    CHECK(window.size() == Index3{19, 6, 67});
    std::uint64_t inWindow = 0;
    for (int x = 0; x < 19; ++x)
        for (int y = 0; y < 6; ++y)
            for (int z = 0; z < 67; ++z) {
                REQUIRE(window.at(x, y, z) == solid.at(x + 2, y + 3, z + 61));
                inWindow += window.at(x, y, z);
            }
    CHECK(window.count() == inWindow);
}

TEST_CASE("countPairs: as counted voxel by voxel, for shifts of every sign", "[measure][oracle]") {
    const Index3 size{7, 6, 140};
    const Occupancy a = Occupancy::fromField(test::noiseField(size, 1));
    const Occupancy b = Occupancy::fromField(test::noiseField(size, 2));
    for (const Index3& shift :
         {Index3{0, 0, 0}, Index3{1, -2, 3}, Index3{-3, 1, 64}, Index3{2, 2, -70}, Index3{0, 0, 139}}) {
        std::uint64_t expected = 0;
        for (int x = 0; x < size.x; ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z) {
                    const Index3 q = Index3{x, y, z} + shift;
                    if (IndexBox::fromSize(size).contains(q) && a.at(x, y, z) && b.at(q.x, q.y, q.z))
                        ++expected;
                }
        CHECK(countPairs(a, b, shift) == expected);
    }
}

TEST_CASE("eulerCharacteristic: ball 1, two balls 2, shell 2, ring 0, none 0", "[measure][oracle]") {
    const Index3 size{40, 40, 80};
    const auto euler = [&](const std::function<bool(const Index3&)>& inside) {
        return eulerCharacteristic(solidFrom(size, inside), Beyond::Void);
    };
    CHECK(euler([](const Index3& p) { return inBall(p, 20, 20, 20, 9.3); }) == 1);
    CHECK(euler([](const Index3& p) { return inBall(p, 20, 20, 20, 9.3) || inBall(p, 20, 20, 60, 9); }) == 2);
    CHECK(euler([](const Index3& p) { return inBall(p, 20, 20, 20, 9) && !inBall(p, 20, 20, 20, 5); }) == 2);
    CHECK(euler([](const Index3& p) {
              const double ring = std::hypot(p.x - 20.0, p.y - 20.0) - 12;
              return ring * ring + (p.z - 40.0) * (p.z - 40.0) < 16;
          }) == 0);
    CHECK(euler([](const Index3&) { return false; }) == 0);
    CHECK(euler([](const Index3&) { return true; }) == 1);
    // Two voxels that touch by a corner only are one part, and one void.
    CHECK(euler([](const Index3& p) { return p == Index3{3, 3, 3} || p == Index3{4, 4, 4}; }) == 1);
}

TEST_CASE("eulerCharacteristic: a lattice of bars has -2 a node, whatever the window", "[measure][oracle]") {
    // Bars along three axes: a node's share is 1 node less 3 bars.
    const Occupancy solid = solidFrom({128, 128, 128}, [](const Index3& p) {
        const bool x = p.x % 16 < 5, y = p.y % 16 < 5, z = p.z % 16 < 5;
        return (x && y) || (y && z) || (x && z);
    });
    const Occupancy cell = solid.window({{0, 0, 0}, {112, 112, 112}});  // 112 corners a side: 7 periods
    CHECK(eulerCharacteristic(cell, Beyond::Unknown) / eulerVolume(cell.size(), Beyond::Unknown) ==
          Approx(-2.0 / (16 * 16 * 16)));
    const Occupancy moved = solid.window({{9, 5, 7}, {121, 117, 119}});
    CHECK(eulerCharacteristic(moved, Beyond::Unknown) == Approx(-2 * 343.0));
    CHECK(eulerVolume({113, 113, 113}, Beyond::Unknown) == 112.0 * 112 * 112);
    CHECK(eulerVolume({10, 10, 10}, Beyond::Void) == 11.0 * 11 * 11);
}

TEST_CASE("surfaceFunctionals: a box has its area and 3 pi a, a notch turns the other way",
          "[measure][oracle]") {
    Mesh box = test::boxMesh({2, 2, 2}, {12, 12, 12});
    REQUIRE(summarize(box).closedManifold());
    REQUIRE(summarize(box).signedVolume > 0);
    const SurfaceElements elements = surfaceElements(box);
    const SurfaceFunctionals all = surfaceFunctionals(elements, {{0, 0, 0}, {20, 20, 20}});
    CHECK(all.area == Approx(600));
    CHECK(all.meanCurvature == Approx(3 * kPi * 10).epsilon(1e-6));
    CHECK(surfaceFunctionals(elements, {{30, 0, 0}, {40, 20, 20}}).area == 0);
    // Turned inside out everything is concave.
    for (Quad& quad : box.quads) std::reverse(quad.begin(), quad.end());
    CHECK(surfaceFunctionals(surfaceElements(box), {{0, 0, 0}, {20, 20, 20}}).meanCurvature ==
          Approx(-3 * kPi * 10).epsilon(1e-6));
    CHECK(surfaceElements(Mesh{}).areas.elements.empty());
    CHECK(surfaceFunctionals(surfaceElements(Mesh{}), {{0, 0, 0}, {20, 20, 20}}).area == 0);
}

TEST_CASE("surfaceFunctionals: the boxes of any partition sum to the whole", "[measure][property]") {
    Mesh ball = test::sphereMesh(25.3, 4);
    for (Vec3f& p : ball.points) p = p + Vec3f{-3, 20, 9};
    const SurfaceElements elements = surfaceElements(ball);
    const IndexBox around{{-40, -20, -30}, {37, 57, 49}};
    const SurfaceFunctionals all = surfaceFunctionals(elements, around);
    CHECK(all.area == Approx(4 * kPi * 25.3 * 25.3).epsilon(0.01));
    for (int side : {5, 16, 23}) {
        SurfaceFunctionals sum;
        for (int x = around.min.x; x <= around.max.x; x += side)
            for (int y = around.min.y; y <= around.max.y; y += side)
                for (int z = around.min.z; z <= around.max.z; z += side) {
                    const SurfaceFunctionals part =
                        surfaceFunctionals(elements, IndexBox::cube({x, y, z}, side).intersection(around));
                    sum.area += part.area;
                    sum.meanCurvature += part.meanCurvature;
                }
        CHECK(sum.area == Approx(all.area));
        CHECK(sum.meanCurvature == Approx(all.meanCurvature));
    }
}

TEST_CASE("findComponents: parts, their sizes, and which touch the box", "[measure][oracle]") {
    const Occupancy solid = solidFrom({20, 20, 140}, [](const Index3& p) {
        return inBall(p, 8, 8, 10, 3.2) || inBall(p, 8, 8, 70, 4.1) || (p.x == 19 && p.z < 130) ||
               p == Index3{3, 3, 100} || p == Index3{4, 4, 101};
    });
    const Components all = findComponents(solid, Neighbours::All);
    REQUIRE(all.sizes.size() == 4);
    CHECK(all.sizes[0] == 20 * 130);
    CHECK(all.sizes[3] == 2);
    CHECK(all.interior.size() == 3);
    CHECK(findComponents(solid, Neighbours::Faces).sizes.size() == 5);
    CHECK(findComponents(solid.complement(), Neighbours::Faces).sizes.size() == 1);
    CHECK(findComponents(Occupancy({4, 4, 4}), Neighbours::All).sizes.empty());
}

TEST_CASE("smallParts: the voxels of parts under their limits, whole ones and cut ones",
          "[measure][oracle]") {
    const Occupancy solid = solidFrom({20, 20, 40}, [](const Index3& p) {
        return inBall(p, 8, 8, 10, 3.2) || p == Index3{3, 3, 30} || p == Index3{4, 4, 31} ||
               (p.x == 19 && p.y > 17 && p.z < 3) || p == Index3{12, 0, 20};
    });
    const std::vector<Index3> whole = smallParts(solid, Neighbours::All, 3, 0);
    CHECK(whole == std::vector<Index3>{{3, 3, 30}, {4, 4, 31}});
    CHECK(smallParts(solid, Neighbours::All, 2, 0).empty());
    CHECK(smallParts(solid, Neighbours::Faces, 2, 0).size() == 2);
    CHECK(smallParts(solid, Neighbours::All, 0, 2) == std::vector<Index3>{{12, 0, 20}});
    CHECK(smallParts(solid, Neighbours::All, 0, 7).size() == 7);
    CHECK(smallParts(solid, Neighbours::All, 1000000, 1000000).size() == solid.count());
}

TEST_CASE("findComponents: as a flood fill finds them in noise", "[measure][oracle]") {
    const Index3 size{9, 11, 70};
    for (int reach : {6, 26}) {
        const Occupancy solid = Occupancy::fromField(test::fieldFrom(size, [&](const Index3& p) {
            return float(Random(5, std::uint64_t((p.x * 100 + p.y) * 100 + p.z)).uniform()) -
                   (reach == 6 ? 0.3f : 0.1f);
        }));
        std::vector<char> seen(std::size_t(size.x * size.y * size.z), 0);
        std::vector<std::uint64_t> sizes;
        const auto number = [&](const Index3& p) { return std::size_t((p.x * size.y + p.y) * size.z + p.z); };
        for (int i = 0; i < size.x * size.y * size.z; ++i) {
            std::vector<Index3> stack{{i / size.z / size.y, i / size.z % size.y, i % size.z}};
            if (!solid.at(stack[0].x, stack[0].y, stack[0].z) || seen[std::size_t(i)]) continue;
            seen[std::size_t(i)] = 1;
            std::uint64_t count = 0;
            while (!stack.empty()) {
                const Index3 p = stack.back();
                stack.pop_back();
                ++count;
                for (int n = 0; n < 27; ++n) {
                    const Index3 d{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}, q = p + d;
                    if (reach == 6 && std::abs(d.x) + std::abs(d.y) + std::abs(d.z) != 1) continue;
                    if (!IndexBox::fromSize(size).contains(q) || !solid.at(q.x, q.y, q.z) || seen[number(q)])
                        continue;
                    seen[number(q)] = 1;
                    stack.push_back(q);
                }
            }
            sizes.push_back(count);
        }
        std::sort(sizes.begin(), sizes.end(), std::greater<>());
        CHECK(findComponents(solid, reach == 6 ? Neighbours::Faces : Neighbours::All).sizes == sizes);
    }
}
