// Bases by motion: mean curvature flow, and the flow to a surface of given normals [tasdizen2003].
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/base_surface_steps.h"
#include "libvdbsynth/surface/surface_shell.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kStable = 0.15;  // time of a step [samples^2]; under 1/6 the explicit scheme is stable
constexpr int kRounds = 4;        // of normals
constexpr float kWidest = 0.7f;   // difference of unit normals from which they are of two faces: 41 degrees
constexpr float kMargin = 3;      // [samples] of the band beside the radius
constexpr double kTimesOfNormals = 2;  // what of the relief a flow of one time leaves goes in a second one
constexpr float kNone = 1e30f;         // no normals are known

// Mean curvature times the length of the gradient, from a padded brick.
float curvature(const float* v, int x, int y) {
    const float gx = (v[x] - v[-x]) / 2, gy = (v[y] - v[-y]) / 2, gz = (v[1] - v[-1]) / 2;
    const float xx = v[x] + v[-x] - 2 * *v, yy = v[y] + v[-y] - 2 * *v, zz = v[1] + v[-1] - 2 * *v;
    const float xy = (v[x + y] + v[-x - y] - v[x - y] - v[y - x]) / 4;
    const float xz = (v[x + 1] + v[-x - 1] - v[x - 1] - v[1 - x]) / 4;
    const float yz = (v[y + 1] + v[-y - 1] - v[y - 1] - v[1 - y]) / 4;
    const float squared = gx * gx + gy * gy + gz * gz;
    // On a ridge there is no direction: the mean of all.
    if (squared < 1e-4f) return (xx + yy + zz) * (2.f / 3);
    const float along =
        gx * gx * xx + gy * gy * yy + gz * gz * zz + 2 * (gx * gy * xy + gx * gz * xz + gy * gz * yz);
    return xx + yy + zz - along / squared;
}

float slopeOf(const float* v, int x, int y) {
    const float gx = (v[x] - v[-x]) / 2, gy = (v[y] - v[-y]) / 2, gz = (v[1] - v[-1]) / 2;
    return std::sqrt(gx * gx + gy * gy + gz * gz);
}

// One step of d phi / dt = (curvature - wanted) |grad phi|; `wanted` null: 0 everywhere.
BrickField stepped(const BrickField& field, const BrickField* wanted, float time, const RunContext& ctx) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr int kPadded = BrickField::kSide + 2, kX = kPadded * kPadded, kY = kPadded;
        float constant = 0, none = 0;
        if (field.constantIn(brick.expanded(1), constant) ||
            (wanted && wanted->constantIn(brick, none) && none == kNone)) {
            field.readBox(brick.min, brick.size(), samples);
            return;
        }
        float padded[kPadded * kPadded * kPadded], source[BrickField::kSamples];
        field.readBox(brick.min - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        if (wanted) wanted->readBox(brick.min, brick.size(), source);
        const float* own = source;
        forEachVoxel(IndexBox::cube({1, 1, 1}, BrickField::kSide), [&](const Index3& p) {
            const float* v = padded + p.x * kX + p.y * kY + p.z;
            float speed = 0;
            if (!wanted)
                speed = curvature(v, kX, kY);
            else if (*own != kNone)
                speed = curvature(v, kX, kY) - *own * slopeOf(v, kX, kY);
            *samples++ = *v + time * speed;
            ++own;
        });
    });
}

SmoothField flowed(const BrickField& unit, int step, const BrickField* wanted, double time,
                   const RunContext& ctx) {
    const int steps = std::max(1, int(std::ceil(time / kStable)));
    BrickField field = unit;
    for (int i = 0; i < steps; ++i) field = stepped(field, wanted, float(time / steps), ctx);
    return {scaledField(field, float(step), ctx), step};
}

double timeOf(const SmoothField& distances, double radius) {
    const double full = radius / distances.step, own = distances.step > 1 ? 0.5 : 0;
    return (full * full - own * own) / 2;
}

// Means of the shell's normals over those whose guides differ little.
std::vector<Vec3f> guidedNormals(const SurfaceShell& shell, const std::vector<Vec3f>& guide, double radius,
                                 const RunContext& ctx) {
    std::vector<Vec3f> means(shell.size());
    forShellNeighbours(shell, 2 * radius, ctx, [&](std::size_t i, const std::vector<ShellNeighbour>& near) {
        Vec3f sum = shell.normal[i] * 1e-6f;
        for (const ShellNeighbour& n : near) {
            float weight = spreadOf(n.squared, radius);
            if (guide.empty()) {
                weight *= std::max(0.f, dot(shell.normal[i], shell.normal[n.site]));
            } else {
                const Vec3f apart = guide[i] - guide[n.site];
                const float share = dot(apart, apart) / (kWidest * kWidest);
                weight *= share < 1 ? (1 - share) * (1 - share) : 0;
            }
            sum = sum + shell.normal[n.site] * weight;
        }
        means[i] = normalized(sum);
    });
    return means;
}

// The divergence of the normals, extended along the lines to the surface, within `reach` of it.
BrickField divergence(const BrickField& unit, const SurfaceShell& shell, const std::vector<Vec3f>& normal,
                      float reach, const RunContext& ctx) {
    const VoxelTable band = VoxelTable::where(
        unit, [&](float d) { return std::abs(d) < reach; }, ctx);
    const std::vector<Vec3f> extended = extendedOverBand(unit, band, shell, normal, ctx);
    return BrickField::fromVoxels(unit.box(), ctx, [&](const Index3& p) {
        if (band.find(p) < 0) return kNone;
        float sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            Index3 low = p, high = p;
            --low[axis];
            ++high[axis];
            const std::int32_t a = band.find(low), b = band.find(high);
            if (a < 0 || b < 0) return kNone;
            sum += (extended[std::size_t(b)][axis] - extended[std::size_t(a)][axis]) / 2;
        }
        return sum;
    });
}

}  // namespace

SmoothField flowedDistances(const SmoothField& distances, double radius, const RunContext& ctx) {
    return flowed(scaledField(distances.field, 1 / float(distances.step), ctx), distances.step, nullptr,
                  timeOf(distances, radius), ctx);
}

SmoothField distancesByNormals(const SmoothField& distances, double radius, const RunContext& ctx) {
    const BrickField unit = scaledField(distances.field, 1 / float(distances.step), ctx);
    const double samples = radius / distances.step;
    const SurfaceShell shell = surfaceShell(unit, ctx);
    std::vector<Vec3f> guide = guidedNormals(shell, {}, samples, ctx);
    for (int round = 0; round < kRounds; ++round) guide = guidedNormals(shell, guide, samples, ctx);
    const BrickField wanted = divergence(unit, shell, guide, float(samples) + kMargin, ctx);
    return flowed(unit, distances.step, &wanted, kTimesOfNormals * timeOf(distances, radius), ctx);
}

}  // namespace vdbsynth
