#include "libvdbsynth/patch/sheet/border_blend.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

std::size_t nodeOf(const PatchArrangement& a, const Vec3f& point) {
    const double step = a.lattice.step;
    const auto at = [&](float x, int count) {
        return std::clamp(int(std::floor(double(x) / step)), 0, count - 1);
    };
    return a.lattice.column(at(point.x, a.lattice.nx), at(point.y, a.lattice.ny)) *
               std::size_t(a.lattice.nz) +
           std::size_t(at(point.z, a.lattice.nz));
}

}  // namespace

void blendBorders(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx) {
    const BlendOptions options{source.exemplar.kernel, source.exemplar.spacing,
                               source.arrangement.lattice.step, source.options.even};
    const std::vector<std::uint8_t> distance =
        borderDistance(source.arrangement, blendSupport(options) + 1, ctx);
    std::vector<std::uint8_t> ring;
    for (const Vec3f& point : sheet.points) ring.push_back(distance[nodeOf(source.arrangement, point)]);
    blendNearBorders(ring, options, sheet, ctx);
}

}  // namespace vdbsynth
