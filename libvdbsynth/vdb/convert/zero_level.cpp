#include "libvdbsynth/vdb/convert/zero_level.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/convert/trilinear.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>

namespace vdbsynth {
namespace {

// Vertices of merged cells begin up to some voxels away.
constexpr int kSteps = 2, kStepsOfMerged = 8;

// volumeToMesh puts a vertex at the mean of its cell's edge crossings, up to a tenth of a voxel inside a
// curved surface; this moves it onto the zero level.
void projectToZero(const openvdb::FloatGrid& grid, Mesh& mesh, int steps, const RunContext& ctx) {
    parallelFor(ctx, mesh.points.size(), 4096, [&](std::size_t begin, std::size_t end) {
        TrilinearSampler sampler(grid);
        for (std::size_t i = begin; i < end; ++i)
            for (int step = 0; step < steps; ++step) {
                Vec3d gradient;
                const Vec3d p = cast<double>(mesh.points[i]);
                const double value = sampler.sample(p, gradient);
                const double squared = dot(gradient, gradient);
                if (squared < 1e-12) break;
                Vec3d move = gradient * (-value / squared);
                const double reach = length(move);
                if (reach > 0.5) move = move * (0.5 / reach);
                mesh.points[i] = cast<float>(p + move);
            }
    });
}

}  // namespace

Mesh zeroLevelInIndexSpace(const openvdb::FloatGrid& grid, double adaptivity, const RunContext& ctx) {
    const FloatGridPtr indexGrid = inIndexSpace(grid);
    indexGrid->setGridClass(openvdb::GRID_LEVEL_SET);  // else faces look inward
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    withThreads(ctx, [&] {
        behindWall(ErrorCode::Unusable, "level set", [&] {
            openvdb::tools::volumeToMesh(*indexGrid, points, triangles, quads, 0.0, adaptivity,
                                         /* relaxDisorientedTriangles= */ true);
        });
    });
    throwIfCancelled(ctx);
    Mesh mesh;
    mesh.points.reserve(points.size());
    for (const openvdb::Vec3s& p : points) mesh.points.push_back({p.x(), p.y(), p.z()});
    // OpenVDB's faces run clockwise seen from outside; ours run the other way.
    for (const openvdb::Vec3I& t : triangles) mesh.triangles.push_back({t[2], t[1], t[0]});
    for (const openvdb::Vec4I& q : quads) mesh.quads.push_back({q[3], q[2], q[1], q[0]});
    projectToZero(*indexGrid, mesh, adaptivity > 0 ? kStepsOfMerged : kSteps, ctx);
    return mesh;
}

}  // namespace vdbsynth
