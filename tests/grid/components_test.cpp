#include "libvdbsynth/grid/components.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>
#include <numeric>

#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/math/lattice.h"
#include "tests/support/makers.h"
#include "tests/support/solids.h"

using namespace vdbsynth;
using test::inBall;
using test::solidFrom;

namespace {

Occupancy noise(const Index3& size, double share) {
    return solidFrom(size, [=](const Index3& p) {
        return Random(5, std::uint64_t((p.x * 100 + p.y) * 100 + p.z)).uniform() < share;
    });
}

std::uint64_t sumOf(const std::vector<std::uint64_t>& sizes) {
    return std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0));
}

// The voxels of a part of solid that was not seen yet, as a flood fill finds them from one of its voxels.
std::uint64_t flood(const Occupancy& solid, const Index3& from, Neighbours neighbours,
                    std::vector<char>& seen) {
    std::vector<Index3> stack{from};
    seen[latticeIndex(from, solid.size())] = 1;
    std::uint64_t count = 0;
    while (!stack.empty()) {
        const Index3 p = stack.back();
        stack.pop_back();
        ++count;
        for (const Index3& step : kAllNeighbours) {
            const Index3 q = p + step;
            if (neighbours == Neighbours::Faces &&
                std::abs(step.x) + std::abs(step.y) + std::abs(step.z) != 1)
                continue;
            if (!IndexBox::fromSize(solid.size()).contains(q) || !solid.at(q.x, q.y, q.z)) continue;
            char& known = seen[latticeIndex(q, solid.size())];
            if (known) continue;
            known = 1;
            stack.push_back(q);
        }
    }
    return count;
}

}  // namespace

TEST_CASE("findComponents: parts, their sizes, and which touch the box", "[grid][oracle]") {
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

TEST_CASE("findComponents: as a flood fill finds them in noise", "[grid][oracle]") {
    const Index3 size{9, 11, 70};
    for (const Neighbours neighbours : {Neighbours::Faces, Neighbours::All}) {
        const Occupancy solid = noise(size, neighbours == Neighbours::Faces ? 0.3 : 0.1);
        std::vector<char> seen(latticeCount(size), 0);
        std::vector<std::uint64_t> sizes;
        forEachVoxel(IndexBox::fromSize(size), [&](const Index3& p) {
            if (solid.at(p.x, p.y, p.z) && !seen[latticeIndex(p, size)])
                sizes.push_back(flood(solid, p, neighbours, seen));
        });
        std::sort(sizes.begin(), sizes.end(), std::greater<>());
        CHECK(findComponents(solid, neighbours).sizes == sizes);
        CHECK(sumOf(sizes) == solid.count());
    }
}

TEST_CASE("findComponents: those inside are among all, and corners join only what faces may not",
          "[grid][property]") {
    const Occupancy solid = noise({20, 21, 22}, 0.25);
    const Components faces = findComponents(solid, Neighbours::Faces),
                     all = findComponents(solid, Neighbours::All);
    CHECK(all.sizes.size() < faces.sizes.size());
    CHECK(sumOf(all.sizes) == solid.count());
    CHECK(sumOf(faces.sizes) == solid.count());
    for (const Components& found : {faces, all}) {
        CHECK(std::is_sorted(found.sizes.begin(), found.sizes.end(), std::greater<>()));
        CHECK(std::includes(found.sizes.begin(), found.sizes.end(), found.interior.begin(),
                            found.interior.end(), std::greater<>()));
    }
}

TEST_CASE("findComponents: runs across words, a single voxel, and a box of solid", "[grid][degenerate]") {
    const Occupancy line = solidFrom({3, 3, 200}, [](const Index3& p) {
        return p.x == 1 && p.y == 1 && p.z > 60 && p.z < 195 && p.z != 128;
    });
    CHECK(findComponents(line, Neighbours::All).interior == std::vector<std::uint64_t>{67, 66});
    Occupancy one({1, 1, 1});
    one.set(0, 0, 0);
    CHECK(findComponents(one, Neighbours::Faces).sizes == std::vector<std::uint64_t>{1});
    CHECK(findComponents(one, Neighbours::Faces).interior.empty());
    const Occupancy full = Occupancy({5, 6, 64}).complement();
    CHECK(findComponents(full, Neighbours::Faces).sizes == std::vector<std::uint64_t>{5 * 6 * 64});
}

TEST_CASE("smallParts: the voxels of parts under their limits, whole ones and cut ones", "[grid][oracle]") {
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
    const std::vector<Index3> all = smallParts(solid, Neighbours::All, 1000000, 1000000);
    CHECK(all.size() == solid.count());
    CHECK(std::is_sorted(all.begin(), all.end()));
}
