#include "libvdbsynth/surface/surface_shell.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

Vec3f projectToSurface(const BrickField& distance, const Vec3f& point) {
    Vec3f p = point;
    for (int step = 0; step < 2; ++step) {
        const Vec3f gradient = sampleGradient(distance, p);
        const float squared = dot(gradient, gradient);
        // Next to a medial axis the gradient is short and a full step would diverge.
        if (squared < 0.04f) break;
        p = p - gradient * (sampleTrilinear(distance, p) / std::max(squared, 0.25f));
    }
    return p;
}

namespace {

void connect(SurfaceShell& shell, const RunContext& ctx) {
    std::vector<std::vector<std::uint32_t>> near(shell.size());
    parallelFor(ctx, shell.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (const Index3& step : kAllNeighbours) {
                const std::int32_t j = shell.table.find(shell.table[i] + step);
                if (j >= 0 && dot(shell.normal[i], shell.normal[std::size_t(j)]) > 0)
                    near[i].push_back(std::uint32_t(j));
            }
    });
    shell.begin.assign(1, 0);
    for (const auto& list : near) {
        shell.neighbours.insert(shell.neighbours.end(), list.begin(), list.end());
        shell.begin.push_back(std::uint32_t(shell.neighbours.size()));
    }
}

}  // namespace

SurfaceShell surfaceShell(const BrickField& distance, const RunContext& ctx) {
    SurfaceShell shell;
    shell.table = VoxelTable::where(
        distance, [](float d) { return std::abs(d) <= kShellReach; }, ctx);
    const std::size_t voxels = shell.table.size();
    if (voxels == 0) throw Error(ErrorCode::EmptyInput, "the model has no surface in its domain");
    shell.point.resize(voxels);
    shell.normal.resize(voxels);
    parallelFor(ctx, voxels, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index3& v = shell.table[i];
            const Vec3f at{float(v.x), float(v.y), float(v.z)};
            shell.point[i] = projectToSurface(distance, at);
            const Vec3f normal = sampleGradient(distance, at);
            shell.normal[i] = length(normal) > 1e-6f ? normalized(normal) : Vec3f{0, 0, 1};
        }
    });
    connect(shell, ctx);
    return shell;
}

}  // namespace vdbsynth
