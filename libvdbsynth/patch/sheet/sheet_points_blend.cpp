#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kBlendRings = 2;     // of nodes beside a border whose points move
constexpr double kTooNear = 0.45;  // [spacings]
constexpr std::size_t kNearest = 6;

// Rings of nodes whose points the surface at the moved ones depends on: 6.9 spacings, and one more.
int supportRings(const SheetSource& source) {
    const double reach = 7 * source.exemplar.spacing / source.arrangement.lattice.step;
    return kBlendRings + int(std::ceil(reach)) + 1;
}

std::size_t nodeOf(const PatchArrangement& a, const Vec3f& point) {
    const double step = a.lattice.step;
    const auto at = [&](float x, int count) {
        return std::clamp(int(std::floor(double(x) / step)), 0, count - 1);
    };
    return a.lattice.column(at(point.x, a.lattice.nx), at(point.y, a.lattice.ny)) *
               std::size_t(a.lattice.nz) +
           std::size_t(at(point.z, a.lattice.nz));
}

template <typename T>
void keep(std::vector<T>& values, const std::vector<std::uint8_t>& dropped) {
    std::size_t to = 0;
    for (std::size_t from = 0; from < values.size(); ++from)
        if (!dropped[from]) values[to++] = values[from];
    values.resize(to);
}

// Of two points of different patches that are too near each other the one of the later patch goes.
void dropNear(const std::vector<std::uint32_t>& near, double spacing, SheetPoints& sheet,
              const RunContext& ctx) {
    std::vector<Vec3f> places;
    for (const std::uint32_t point : near) places.push_back(sheet.points[point]);
    const PointNeighbours neighbours(places);
    std::vector<std::uint8_t> dropped(sheet.size(), 0);
    const float apart = float(kTooNear * kTooNear * spacing * spacing);
    parallelFor(ctx, near.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::uint32_t numbers[kNearest];
        float squared[kNearest];
        for (std::size_t n = begin; n < end; ++n) {
            const std::size_t found = neighbours.nearest(places[n], kNearest, numbers, squared);
            const std::uint32_t own = near[n];
            for (std::size_t f = 0; f < found; ++f) {
                const std::uint32_t other = near[numbers[f]];
                if (squared[f] < apart && sheet.patch[other] < sheet.patch[own] &&
                    dot(sheet.normals[other], sheet.normals[own]) > 0)
                    dropped[own] = 1;
            }
        }
    });
    keep(sheet.points, dropped);
    keep(sheet.normals, dropped);
    keep(sheet.source, dropped);
    keep(sheet.patch, dropped);
    keep(sheet.blended, dropped);
}

}  // namespace

void blendBorders(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx) {
    const int support = supportRings(source);
    const std::vector<std::uint8_t> distance = borderDistance(source.arrangement, support + 1, ctx);
    std::vector<Vec3f> points, normals;
    std::vector<std::uint32_t> moving;
    for (std::size_t p = 0; p < sheet.size(); ++p) {
        const int ring = distance[nodeOf(source.arrangement, sheet.points[p])];
        if (ring > support) continue;
        points.push_back(sheet.points[p]);
        normals.push_back(sheet.normals[p]);
        if (ring < kBlendRings) moving.push_back(std::uint32_t(p));
    }
    if (moving.empty()) return;
    PointSetSurfaceOptions options;
    options.kernel = source.exemplar.kernel;
    const PointSetSurface surface(std::move(points), std::move(normals), options, ctx);
    std::vector<Vec3f> moved(moving.size()), turned(moving.size());
    Stage stage(ctx, "blending borders", 1);
    parallelFor(ctx, moving.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const std::uint32_t p = moving[m];
            const Vec3d place = cast<double>(sheet.points[p]), normal = cast<double>(sheet.normals[p]);
            const auto foot = surface.project(place, normal);
            const bool holds = foot && length(foot->point - place) < 2 * source.exemplar.spacing &&
                               dot(foot->normal, normal) > 0;
            moved[m] = holds ? cast<float>(foot->point) : sheet.points[p];
            turned[m] = holds ? cast<float>(foot->normal) : sheet.normals[p];
        }
    });
    for (std::size_t m = 0; m < moving.size(); ++m) {
        sheet.points[moving[m]] = moved[m];
        sheet.normals[moving[m]] = turned[m];
        sheet.blended[moving[m]] = 1;
    }
    if (source.options.even) dropNear(moving, source.exemplar.spacing, sheet, ctx);
    stage.advance();
}

}  // namespace vdbsynth
