// Values at the shell of voxels beside a surface: neighbours within a radius, and the band around it.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/relief/base_surface_steps.h"
#include "libvdbsynth/surface/surface_shell.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

BrickField scaledField(const BrickField& field, float by, const RunContext& ctx) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] *= by;
    });
}

float spreadOf(float squared, double radius) {
    return float(exponential(-0.5 * double(squared) / (radius * radius)));
}

void forShellNeighbours(const SurfaceShell& shell, double reach, const RunContext& ctx,
                        const std::function<void(std::size_t, const std::vector<ShellNeighbour>&)>& visit) {
    const int most = int(std::ceil(reach));
    std::vector<Index3> steps;
    forEachVoxel(IndexBox{{-most, -most, -most}, {most, most, most}}, [&](const Index3& s) {
        if (s.x * s.x + s.y * s.y + s.z * s.z <= reach * reach) steps.push_back(s);
    });
    parallelFor(ctx, shell.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::vector<ShellNeighbour> near;
        for (std::size_t i = begin; i < end; ++i) {
            near.clear();
            for (const Index3& step : steps) {
                const std::int32_t j = shell.table.find(shell.table[i] + step);
                if (j < 0) continue;
                const Vec3f apart = shell.point[std::size_t(j)] - shell.point[i];
                near.push_back({std::uint32_t(j), dot(apart, apart)});
            }
            visit(i, near);
        }
    });
}

namespace {

// Shares of the shell's voxels around a place; those of the cell that holds it, else the nearest around.
Vec3f readShell(const SurfaceShell& shell, const std::vector<Vec3f>& values, const Vec3f& at) {
    const Index3 low{int(std::floor(at.x)), int(std::floor(at.y)), int(std::floor(at.z))};
    Vec3f sum;
    float weights = 0;
    for (int widened = 0; widened < 2 && weights == 0; ++widened)
        forEachVoxel(IndexBox{low, low + Index3{1, 1, 1}}.expanded(widened), [&](const Index3& p) {
            const std::int32_t i = shell.table.find(p);
            if (i < 0) return;
            const float reach = float(1 + widened);
            const float weight = std::max(1e-3f, reach - std::abs(at.x - float(p.x))) *
                                 std::max(1e-3f, reach - std::abs(at.y - float(p.y))) *
                                 std::max(1e-3f, reach - std::abs(at.z - float(p.z)));
            sum = sum + values[std::size_t(i)] * weight;
            weights += weight;
        });
    return weights > 0 ? sum * (1 / weights) : sum;
}

}  // namespace

std::vector<Vec3f> extendedOverBand(const BrickField& unit, const VoxelTable& band, const SurfaceShell& shell,
                                    const std::vector<Vec3f>& values, const RunContext& ctx) {
    std::vector<Vec3f> extended(band.size());
    parallelFor(ctx, band.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index3& v = band[i];
            const Vec3f foot = projectToSurface(unit, {float(v.x), float(v.y), float(v.z)});
            extended[i] = readShell(shell, values, foot);
        }
    });
    return extended;
}

}  // namespace vdbsynth
