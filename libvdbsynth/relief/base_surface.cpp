#include "libvdbsynth/relief/base_surface.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/base_surface_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kRadiiReached = 5;  // four for the mean, one for the relief

// A field whose zero level is meant as distances to first order.
BrickField firstOrder(const BrickField& field, float limit, const RunContext& ctx) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float constant = 0;
        if (field.constantIn(brick.expanded(1), constant)) {
            std::fill_n(samples, BrickField::kSamples, constant);
            return;
        }
        constexpr int kPadded = BrickField::kSide + 2, kX = kPadded * kPadded, kY = kPadded;
        float padded[kPadded * kPadded * kPadded];
        field.readBox(brick.min - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        forEachVoxel(IndexBox::cube({1, 1, 1}, BrickField::kSide), [&](const Index3& p) {
            const float* v = padded + p.x * kX + p.y * kY + p.z;
            const Vec3f gradient{(v[kX] - v[-kX]) / 2, (v[kY] - v[-kY]) / 2, (v[1] - v[-1]) / 2};
            // Next to a medial axis a short gradient would make distances too long.
            *samples++ = std::clamp(*v / std::max(length(gradient), 0.5f), -limit, limit);
        });
    });
}

SmoothField smoothOf(const SmoothField& distances, const BaseOptions& options, const RunContext& ctx) {
    switch (options.kind) {
        case BaseKind::Flow:
            return flowedDistances(distances, options.radius, ctx);
        case BaseKind::Normals:
            return distancesByNormals(distances, options.radius, ctx);
        case BaseKind::Quadrics:
            return distancesByQuadrics(distances, options.radius, ctx);
        default:
            return smoothedDistances(distances, options.kind, options.radius, ctx);
    }
}

// The reach that holds the relief, of which a thousandth may stand out.
void measureRelief(BaseSurface& base, std::vector<float> distances, const BaseOptions& options) {
    std::sort(distances.begin(), distances.end());
    base.amplitude = double(distances[distances.size() - 1 - distances.size() / 1000]);
    base.reach = std::min(std::max(options.reach, float(1.25 * base.amplitude + 2)), largestReach(options));
}

// True if a field has both signs.
bool crosses(const BrickField& field) {
    const Index3 size = field.box().size();
    bool inside = false, outside = false;
    for (int x = 0; x < size.x; x += BrickField::kSide)
        for (int y = 0; y < size.y; y += BrickField::kSide)
            for (int z = 0; z < size.z; z += BrickField::kSide) {
                const IndexBox brick = IndexBox::cube(field.box().min + Index3{x, y, z}, BrickField::kSide)
                                           .intersection(field.box());
                float constant = 0;
                const bool one = field.constantIn(brick, constant);
                forEachVoxel(one ? IndexBox{brick.min, brick.min} : brick,
                             [&](const Index3& p) { (field.inside(p) < 0 ? inside : outside) = true; });
                if (inside && outside) return true;
            }
    return false;
}

// The share of the scan's surface that is as far from the base as distances are known. Parts that the base
// lost are: only its own distances tell, as a smoothed field is nowhere far from zero there.
double shareBeyond(const BaseSurface& base, const Mesh& surface) {
    std::size_t beyond = 0;
    for (const Vec3f& p : surface.points)
        beyond += std::abs(sampleTrilinear(base.distance, p)) > base.reach - 1;
    return double(beyond) / double(surface.points.size());
}

}  // namespace

void validate(const BaseOptions& options) {
    requireOption(options.radius >= 1 && options.radius <= 1000, "radius", roundedText(options.radius, 6),
                  "from 1 to 1000 [voxels]");
    requireOption(options.band >= 1.5f && options.band <= 300, "band", roundedText(double(options.band), 6),
                  "from 1.5 to 300 [voxels]");
    requireOption(options.reach >= 3 && options.reach <= 150, "reach", roundedText(double(options.reach), 6),
                  "from 3 to 150 [voxels]");
}

int baseMargin(double radius) {
    return int(std::ceil(kRadiiReached * radius)) + 3;
}

float largestReach(const BaseOptions& options) {
    return std::max(options.reach, float(1.5 * options.radius + 4));
}

BaseSurface baseFromField(const WideDistances& scan, const SmoothField& smooth, const Mesh& surface,
                          const BaseOptions& options, const RunContext& ctx) {
    BaseSurface base;
    base.radius = options.radius;
    measureRelief(base, distancesFromBase(smooth, surface, ctx), options);
    const IndexBox& box = scan.near.box();
    // Near distances only: farther ones are found from them.
    const BrickField field = firstOrder(refined(smooth, box, 2 * kNearReach + 4, ctx), kNearReach + 1, ctx);
    if (!crosses(field))
        throw Error(ErrorCode::EmptyInput, "`radius` " + roundedText(options.radius, 4) +
                                               " voxels: no base is left of the model; use a smaller one");
    base.distance = joined(wideDistances(field, kNearReach + 1, base.reach, ctx), base.reach, ctx);
    base.scan = joined(scan, base.reach, ctx);
    base.beyond = shareBeyond(base, surface);
    return base;
}

BaseSurface baseSurface(const BrickField& scan, const BaseOptions& options, const RunContext& ctx) {
    validate(options);
    requireField(&scan, "the scan");
    Stage stage(ctx, "smoothing the base", 3);
    const Mesh surface = zeroLevel(scan, scan.box(), Facing::Outward, ctx);
    if (surface.faceCount() == 0) throw Error(ErrorCode::EmptyInput, "the scan has no surface");
    const int step = smoothingStep(options.radius);
    const float reach = kRadiiReached * float(options.radius);
    const WideDistances wide =
        wideDistances(scan, options.band, std::max(wideReach(step, reach), largestReach(options)), ctx);
    const SmoothField distances = latticeDistances(wide, step, reach, ctx, options.kind != BaseKind::Normals);
    stage.advance();
    const SmoothField smooth = smoothOf(distances, options, ctx);
    stage.advance();
    BaseSurface base = baseFromField(wide, smooth, surface, options, ctx);
    stage.advance();
    return base;
}

}  // namespace vdbsynth
