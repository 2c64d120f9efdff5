#include "tests/quality/relief_measures.h"

#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::quality {
namespace {

constexpr float kReach = 24;  // [voxels] over bases
constexpr std::size_t kQuantiles = 1000;

Heights heightsOver(const BaseSurface& base) {
    Heights heights;
    heights.statistics = reliefStatistics(base);
    const Mesh mesh = zeroLevel(base.distance, base.distance.box(), Facing::Outward);
    for (const Vec3f& p : mesh.points) {
        const ReliefPoint point = reliefAt(base, p, normalized(sampleGradient(base.distance, p)));
        if (!point.lost) heights.value.push_back(point.height);
    }
    std::sort(heights.value.begin(), heights.value.end());
    return heights;
}

// A picture's heights [voxels] over a plane, to first order, a texel `texel` voxels wide.
BaseSurface overPlane(const ReliefSource& source, double texel, double high) {
    const SampleImage& image = source.heights;
    double mean = 0;
    for (float v : image.values) mean += double(v) / double(image.texels());
    const auto at = [&](int x, int y) {
        float value = 0;
        readCubic(image, {float((x + 0.5) / texel), float((y + 0.5) / texel)}, &value);
        return float((double(value) - mean) * high);
    };
    const float reach = float(high) + 3, middle = std::ceil(reach) + 2;
    const Index3 size{int(image.width * texel), int(image.height * texel), int(2 * middle)};
    BaseSurface base;
    base.reach = reach;
    base.distance = test::fieldFrom(
        size, [=](const Index3& p) { return std::clamp(float(p.z) - middle - 0.3f, -reach, reach); });
    base.scan = test::fieldFrom(size, [&](const Index3& p) {
        const float dx = (at(p.x + 1, p.y) - at(p.x - 1, p.y)) / 2,
                    dy = (at(p.x, p.y + 1) - at(p.x, p.y - 1)) / 2;
        const float d = (float(p.z) - middle - 0.3f - at(p.x, p.y)) / std::sqrt(1 + dx * dx + dy * dy);
        return std::clamp(d, -reach, reach);
    });
    return base;
}

}  // namespace

Heights sampleHeights(const ReliefSource& source, const ReliefOptions& options) {
    if (!source.scan) return heightsOver(overPlane(source, options.scale, kPictureHeight * options.scale));
    ReliefExtractOptions extract;
    extract.base = options.base;
    extract.baseRadius = options.baseRadius;
    return heightsOver(extractRelief(*source.scan, extract).fields);
}

BaseSurface madeSurface(const LevelSet& made, const LevelSet& target) {
    IndexBox box = solidBox(*made.grid, "made");
    const IndexBox other = solidBox(*target.grid, "target");
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::min(box.min[axis], other.min[axis]) - int(kReach);
        box.max[axis] = std::max(box.max[axis], other.max[axis]) + int(kReach);
    }
    BaseSurface base;
    base.reach = kReach;
    base.distance = gatherWideBand(*target.grid, box, {}, kReach, {});
    base.scan = gatherWideBand(*made.grid, box, {}, kReach, {});
    base.distance.translate(Index3{0, 0, 0} - base.distance.box().min);
    base.scan.translate(Index3{0, 0, 0} - base.scan.box().min);
    return base;
}

Heights madeHeights(const LevelSet& made, const LevelSet& target) {
    return heightsOver(madeSurface(made, target));
}

double wasserstein(const Heights& a, const Heights& b) {
    double sum = 0;
    const auto quantile = [](const Heights& h, double q) {
        return double(h.value.at(std::min(h.value.size() - 1, std::size_t(q * double(h.value.size())))));
    };
    for (std::size_t i = 0; i < kQuantiles; ++i) {
        const double q = (double(i) + 0.5) / double(kQuantiles);
        sum += std::abs(quantile(a, q) - a.statistics.mean - quantile(b, q) + b.statistics.mean);
    }
    return sum / double(kQuantiles);
}

}  // namespace vdbsynth::quality
