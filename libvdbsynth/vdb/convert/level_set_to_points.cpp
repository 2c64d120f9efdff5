// Poisson-disk points by dart throwing over candidates on the dual-contoured surface: candidates in a
// random order, each kept if no kept one is nearer than the spacing.
#include "libvdbsynth/vdb/convert/level_set_to_points.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/convert/trilinear.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/coord.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

namespace vdbsynth {
namespace {

// Darts per square of the spacing: with 24 the points reach nine tenths of the densest dart throwing.
constexpr double kDarts = 24;
constexpr std::uint32_t kPointsPurpose = 0x706f696e;

struct Candidate {
    std::uint64_t order;  // random, so the kept points depend on the seed only
    Vec3f point;
};

std::vector<Candidate> throwCandidates(const Mesh& mesh, double spacing, std::uint64_t seed) {
    std::vector<Candidate> candidates;
    const std::vector<Triangle> triangles = triangulated(mesh);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Vec3f a = mesh.points[triangles[i][0]];
        const Vec3f u = mesh.points[triangles[i][1]] - a, v = mesh.points[triangles[i][2]] - a;
        const double area = double(length(cross(u, v))) / 2;
        Random random(seed, i, kPointsPurpose);
        double count = kDarts * area / (spacing * spacing);
        for (; count > 0; count -= 1) {
            if (count < 1 && random.uniform() >= count) break;
            double s = random.uniform(), t = random.uniform();
            if (s + t > 1) {
                s = 1 - s;
                t = 1 - t;
            }
            const std::uint64_t high = random.bits();
            candidates.push_back({high << 32 | random.bits(), a + u * float(s) + v * float(t)});
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.order < b.order; });
    return candidates;
}

class Occupied {
public:
    explicit Occupied(double spacing) : mSpacing(spacing) {}
    bool tryAdd(const Vec3f& p) {
        const Index3 cell = cellOf(p);
        if (hasNear(cell, p)) return false;
        for (const Index3& step : kAllNeighbours)
            if (hasNear(cell + step, p)) return false;
        mCells[key(cell)].push_back(p);
        return true;
    }

private:
    bool hasNear(const Index3& cell, const Vec3f& p) const {
        const auto it = mCells.find(key(cell));
        if (it == mCells.end()) return false;
        for (const Vec3f& other : it->second)
            if (double(length(other - p)) < mSpacing) return true;
        return false;
    }
    Index3 cellOf(const Vec3f& p) const {
        return {int(std::floor(double(p.x) / mSpacing)), int(std::floor(double(p.y) / mSpacing)),
                int(std::floor(double(p.z) / mSpacing))};
    }
    // 21 bits per axis; cells that share a key only cause needless tests.
    static std::uint64_t key(const Index3& c) {
        return (std::uint64_t(c.x & 0x1FFFFF) << 42) | (std::uint64_t(c.y & 0x1FFFFF) << 21) |
               std::uint64_t(c.z & 0x1FFFFF);
    }
    double mSpacing;
    std::unordered_map<std::uint64_t, std::vector<Vec3f>> mCells;
};

}  // namespace

void validate(const PointOptions& options) {
    requireOption(options.spacing >= 0.25 && options.spacing <= 100, "spacing",
                  roundedText(options.spacing, 6), "from 0.25 to 100 voxels");
}

PointCloud levelSetToPoints(const openvdb::FloatGrid& grid, const PointOptions& options,
                            const RunContext& ctx) {
    validate(options);
    Stage stage(ctx, "level set to points", 3);
    const Mesh mesh = zeroLevelInIndexSpace(grid, 0, ctx);
    if (mesh.faceCount() == 0)
        throw Error(ErrorCode::EmptyInput, "the level set has no surface to put points on");
    stage.advance();
    const std::vector<Candidate> candidates = throwCandidates(mesh, options.spacing, ctx.seed);
    stage.advance();
    Occupied occupied(options.spacing);
    PointCloud cloud;
    std::vector<Vec3d> world;
    TrilinearSampler sampler(grid);
    for (const Candidate& candidate : candidates) {
        if (!occupied.tryAdd(candidate.point)) continue;
        Vec3d gradient;
        sampler.sample(cast<double>(candidate.point), gradient);
        world.push_back(fromVec(grid.indexToWorld(toVec(cast<double>(candidate.point)))));
        const openvdb::Vec3d normal = grid.transform().baseMap()->applyIJT(toVec(gradient));
        cloud.normals.push_back(cast<float>(normalized(fromVec(normal))));
    }
    LocalPoints local = localPoints(world);
    cloud.points = std::move(local.points);
    cloud.origin = local.origin;
    stage.advance();
    return cloud;
}

}  // namespace vdbsynth
