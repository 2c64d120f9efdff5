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
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <string>
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

// The points kept so far, in cells as wide as the spacing: a flat hash table, for most of the time goes into
// looking cells up.
class Occupied {
public:
    explicit Occupied(double spacing) : mSpacing(spacing), mCells(1 << 10) {}
    bool tryAdd(const Vec3f& p) {
        const Index3 cell = cellOf(p);
        if (hasNear(cell, p)) return false;
        for (const Index3& step : kAllNeighbours)
            if (hasNear(cell + step, p)) return false;
        add(key(cell), p);
        return true;
    }

private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    struct Cell {
        std::uint64_t key = 0;
        std::uint32_t newest = kNone;  // of its points; kNone: the slot is free
    };
    struct Kept {
        Vec3f point;
        std::uint32_t older;  // in the same cell
    };

    bool hasNear(const Index3& cell, const Vec3f& p) const {
        for (std::uint32_t i = mCells[slotOf(key(cell))].newest; i != kNone; i = mKept[i].older)
            if (double(length(mKept[i].point - p)) < mSpacing) return true;
        return false;
    }
    void add(std::uint64_t key, const Vec3f& p) {
        if (2 * mUsed >= mCells.size()) grow();
        Cell& cell = mCells[slotOf(key)];
        mUsed += cell.newest == kNone;
        mKept.push_back({p, cell.newest});
        cell = {key, std::uint32_t(mKept.size() - 1)};
    }
    void grow() {
        std::vector<Cell> old(2 * mCells.size());
        old.swap(mCells);
        for (const Cell& cell : old)
            if (cell.newest != kNone) mCells[slotOf(cell.key)] = cell;
    }
    // The slot of a key, or the free one where it belongs.
    std::size_t slotOf(std::uint64_t key) const {
        const std::size_t mask = mCells.size() - 1;
        std::size_t slot = std::size_t((key * 0x9E3779B97F4A7C15u) >> 32) & mask;
        while (mCells[slot].newest != kNone && mCells[slot].key != key) slot = (slot + 1) & mask;
        return slot;
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
    std::vector<Cell> mCells;  // a power of two, at most half used
    std::size_t mUsed = 0;
    std::vector<Kept> mKept;
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
