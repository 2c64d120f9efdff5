#include "libvdbsynth/patch/sheet/border_blend.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/points/even_sampling.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kBlendRings = 2;  // of nodes beside a border whose points move

// Spreads the moved points evenly; all others stay.
void spread(const PointSetSurface& surface, const std::vector<std::uint32_t>& near,
            const std::vector<std::uint8_t>& moves, double spacing, SheetPoints& sheet,
            const RunContext& ctx) {
    std::vector<Vec3f> points, normals;
    std::vector<char> fixed;
    for (std::size_t n = 0; n < near.size(); ++n) {
        points.push_back(sheet.points[near[n]]);
        normals.push_back(sheet.normals[near[n]]);
        fixed.push_back(moves[n] ? 0 : 1);
    }
    EvenSamplingOptions options;
    options.spacing = spacing;
    options.rounds = 3;
    const EvenSampling even = evenSampling(surface, points, normals, fixed, options, ctx);
    SheetPoints result;
    std::vector<std::uint8_t> replaced(sheet.size(), 0);
    for (const std::uint32_t point : near) replaced[point] = 1;
    const auto add = [&](std::size_t from, const Vec3f& point, const Vec3f& normal) {
        result.points.push_back(point);
        result.normals.push_back(normal);
        result.source.push_back(sheet.source[from]);
        result.patch.push_back(sheet.patch[from]);
        result.blended.push_back(sheet.blended[from]);
    };
    for (std::size_t p = 0; p < sheet.size(); ++p)
        if (!replaced[p]) add(p, sheet.points[p], sheet.normals[p]);
    for (std::size_t p = 0; p < even.points.size(); ++p)
        add(near[even.source[p]], even.points[p], even.normals[p]);
    sheet = std::move(result);
}

}  // namespace

int blendSupport(const BlendOptions& options) {
    return kBlendRings + int(std::ceil(3.5 * options.kernel * options.spacing / options.step)) + 1;
}

void blendNearBorders(const std::vector<std::uint8_t>& ring, const BlendOptions& options, SheetPoints& sheet,
                      const RunContext& ctx) {
    const int support = blendSupport(options);
    std::vector<Vec3f> points, normals;
    std::vector<std::uint32_t> moving, near;
    std::vector<std::uint8_t> moves;
    for (std::size_t p = 0; p < sheet.size(); ++p) {
        if (ring[p] > support) continue;
        points.push_back(sheet.points[p]);
        normals.push_back(sheet.normals[p]);
        near.push_back(std::uint32_t(p));
        moves.push_back(ring[p] < kBlendRings ? 1 : 0);
        if (ring[p] < kBlendRings) moving.push_back(std::uint32_t(p));
    }
    if (moving.empty()) return;
    PointSetSurfaceOptions kind;
    kind.kernel = options.kernel;
    const PointSetSurface surface(std::move(points), std::move(normals), kind, ctx);
    std::vector<Vec3f> moved(moving.size()), turned(moving.size());
    Stage stage(ctx, "blending borders", 1);
    parallelFor(ctx, moving.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const std::uint32_t p = moving[m];
            const Vec3d place = cast<double>(sheet.points[p]), normal = cast<double>(sheet.normals[p]);
            const auto foot = surface.project(place, normal);
            const bool holds =
                foot && length(foot->point - place) < 2 * options.spacing && dot(foot->normal, normal) > 0;
            moved[m] = holds ? cast<float>(foot->point) : sheet.points[p];
            turned[m] = holds ? cast<float>(foot->normal) : sheet.normals[p];
        }
    });
    for (std::size_t m = 0; m < moving.size(); ++m) {
        sheet.points[moving[m]] = moved[m];
        sheet.normals[moving[m]] = turned[m];
        sheet.blended[moving[m]] = 1;
    }
    if (options.even) spread(surface, near, moves, options.spacing, sheet, ctx);
    stage.advance();
}

}  // namespace vdbsynth
