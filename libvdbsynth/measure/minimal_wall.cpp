#include "libvdbsynth/measure/minimal_wall.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vdbsynth {
namespace {

constexpr std::size_t kMostRays = 500000;
constexpr double kFirstReach = 16;   // [voxels]
constexpr double kLeastStep = 0.1;   // [voxels]
constexpr double kSafeStep = 0.9;    // of the value: fields are distances only nearly
constexpr double kFirstStep = 0.05;  // [voxels] into the solid
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Ray {
    Vec3d start, inward;  // on the surface, length 1
    double area = 0;      // [voxels^2] of the face; 0: no ray
    double thickness = kInfinite;
};

std::vector<Ray> raysOf(const BrickField& field, const RunContext& ctx) {
    const Mesh mesh = zeroLevel(field, field.box(), Facing::Outward, ctx);
    if (mesh.quads.empty()) throw Error(ErrorCode::EmptyInput, "the solid to measure has no surface");
    const std::size_t stride = (mesh.quads.size() + kMostRays - 1) / kMostRays;
    std::vector<Ray> rays((mesh.quads.size() + stride - 1) / stride);
    parallelFor(ctx, rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Quad& q = mesh.quads[i * stride];
            std::array<Vec3d, 4> p;
            for (std::size_t k = 0; k < 4; ++k) p[k] = cast<double>(mesh.points[q[k]]);
            const Vec3d normal = cross(p[2] - p[0], p[3] - p[1]);
            rays[i].start = (p[0] + p[1] + p[2] + p[3]) * 0.25;
            rays[i].inward = -normalized(normal);
            rays[i].area = length(normal) / 2;
        }
    });
    return rays;
}

// The way through the solid; infinite if it is longer than `reach`, NaN if the ray does not begin in it.
double thicknessAlong(const BrickField& field, const Ray& ray, double reach) {
    const auto value = [&](double way) {
        return double(sampleTrilinear(field, cast<float>(ray.start + ray.inward * way)));
    };
    // The middle of a face is not exactly on the surface, which lies as far along the ray as the value says.
    const double entry = value(0);
    double way = std::max(0.0, entry) + kFirstStep, at = value(way);
    if (!(at < 0)) return std::numeric_limits<double>::quiet_NaN();
    while (way - entry < reach) {
        const double step = std::max(kLeastStep, -kSafeStep * at), next = value(way + step);
        if (next >= 0) return way - entry + step * at / (at - next);
        way += step;
        at = next;
    }
    return kInfinite;
}

void march(const BrickField& field, std::vector<Ray>& rays, double reach, const RunContext& ctx) {
    parallelFor(ctx, rays.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (rays[i].area <= 0 || rays[i].thickness < kInfinite) continue;
            rays[i].thickness = thicknessAlong(field, rays[i], reach);
            if (std::isnan(rays[i].thickness)) rays[i].area = 0;
        }
    });
}

// The ray at which `share` of the area is reached, from the thinnest on; null if too few have ended.
const Ray* rayAt(const std::vector<Ray>& rays, double share) {
    std::vector<const Ray*> ended;
    double area = 0, reached = 0;
    for (const Ray& ray : rays) {
        area += ray.area;
        if (ray.area > 0 && ray.thickness < kInfinite) ended.push_back(&ray);
    }
    std::sort(ended.begin(), ended.end(), [](const Ray* a, const Ray* b) {
        return a->thickness != b->thickness ? a->thickness < b->thickness : a < b;
    });
    for (const Ray* ray : ended) {
        reached += ray->area;
        if (reached >= share * area * (1 - 1e-9)) return ray;
    }
    return nullptr;
}

}  // namespace

void validate(const MinimalWallOptions& options) {
    requireOption(options.share > 0 && options.share <= 1, "share", roundedText(options.share, 6),
                  "above 0, to 1");
}

std::optional<MinimalWall> minimalWall(const BrickField& field, const MinimalWallOptions& options,
                                       const RunContext& ctx) {
    validate(options);
    requireField(&field, "the solid to measure");
    return withThreads(ctx, [&]() -> std::optional<MinimalWall> {
        std::vector<Ray> rays = raysOf(field, ctx);
        const Index3 size = field.box().size();
        const double farthest = length(Vec3d{double(size.x), double(size.y), double(size.z)});
        for (double reach = kFirstReach;; reach *= 4) {
            march(field, rays, std::min(reach, farthest), ctx);
            if (const Ray* ray = rayAt(rays, options.share)) return MinimalWall{ray->thickness, ray->start};
            if (reach >= farthest) return std::nullopt;
        }
    });
}

}  // namespace vdbsynth
