#include "libvdbsynth/vdb/convert/zero_level.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

using namespace vdbsynth;

namespace {

void requireSame(const Mesh& bricks, const Mesh& grid) {
    REQUIRE(bricks.quads.size() == grid.quads.size());
    REQUIRE(grid.triangles.empty());
    std::size_t different = 0;
    for (std::size_t q = 0; q < grid.quads.size(); ++q)
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Vec3f &a = bricks.points[bricks.quads[q][corner]], &b = grid.points[grid.quads[q][corner]];
            different += a.x == b.x && a.y == b.y && a.z == b.z ? 0 : 1;
        }
    CHECK(different == 0);
}

Mesh flipped(Mesh mesh) {
    for (Quad& quad : mesh.quads) std::reverse(quad.begin(), quad.end());
    return mesh;
}

// Both meshers on one field, at a place far from and around the origin.
void compareMeshers(const BrickField& field, const Index3& corner) {
    const FloatGridPtr grid = scatterBricks(field, corner, 1.f, 3.f);
    BrickField moved = field;
    moved.translate(corner);
    const Mesh mesh = zeroLevelInIndexSpace(*grid, 0, {});
    requireSame(zeroLevel(moved, moved.box(), Facing::Outward), mesh);
    requireSame(zeroLevel(moved, moved.box(), Facing::Inward), flipped(mesh));
}

}  // namespace

TEST_CASE("zeroLevel on bricks: the faces and vertices of OpenVDB's mesher, bit for bit", "[vdb][oracle]") {
    openvdb::initialize();
    const Index3 size{45, 38, 51};
    // Noise at every voxel has all cases of a cell, and all pairs of cells that share a doubtful face.
    const auto noise = [&](float closeness) {
        return BrickField::generate(IndexBox::fromSize(size), {}, [&](const IndexBox& brick, float* samples) {
            for (int i = 0; i < BrickField::kSamples; ++i) {
                const Index3 p = brick.min + Index3{i >> 6, i >> 3 & 7, i & 7};
                const bool border =
                    std::min({p.x, p.y, p.z}) < 4 || p.x > size.x - 5 || p.y > size.y - 5 || p.z > size.z - 5;
                Random random(11, std::uint64_t((p.x * 64 + p.y) * 64 + p.z));
                samples[i] = border ? 2.f : closeness * (float(random.uniform()) - 0.5f);
            }
        });
    };
    for (const Index3& corner : {Index3{0, 0, 0}, Index3{-21, -17, -30}, Index3{4080, -4100, 120}}) {
        compareMeshers(noise(1.f), corner);
        compareMeshers(noise(5.f), corner);
    }
}
