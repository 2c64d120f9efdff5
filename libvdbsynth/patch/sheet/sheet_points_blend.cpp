#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"
#include "libvdbsynth/points/even_sampling.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kBlendRings = 2;  // of nodes beside a border whose points move

// Rings of nodes whose points the surface at the moved ones depends on: the kernel's reach, and one more.
int supportRings(const SheetSource& source) {
    const double reach =
        3.5 * source.exemplar.kernel * source.exemplar.spacing / source.arrangement.lattice.step;
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

// What a tile has beyond its sides: the points at the opposite ones.
void addPeriods(const SheetSource& source, int rings, std::vector<Vec3f>& points,
                std::vector<Vec3f>& normals) {
    const PatchLattice& l = source.arrangement.lattice;
    const double width = l.nx * l.step, depth = l.ny * l.step, reach = rings * l.step;
    const std::size_t count = points.size();
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) {
            if (i == 0 && j == 0) continue;
            for (std::size_t p = 0; p < count; ++p) {
                const Vec3d at = cast<double>(points[p]) + Vec3d{i * width, j * depth, 0};
                if (at.x < -reach || at.y < -reach || at.x > width + reach || at.y > depth + reach) continue;
                points.push_back(cast<float>(at));
                normals.push_back(normals[p]);
            }
        }
}

// How far the surface of the exemplar's points is from each of those that are needed, along its normal: what
// a fit makes of curvature and noise.
std::vector<float> fitErrors(const SheetSource& source, const SheetPoints& sheet, const RunContext& ctx) {
    const PatchExemplar& exemplar = source.exemplar;
    std::vector<std::uint8_t> needed(exemplar.points.size(), 0);
    for (std::size_t p = 0; p < sheet.size(); ++p)
        if (sheet.blended[p]) needed[sheet.source[p]] = 1;
    std::vector<float> error(exemplar.points.size(), 0.f);
    parallelFor(ctx, error.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            if (!needed[p]) continue;
            const Vec3d place = cast<double>(exemplar.points[p]), normal = cast<double>(exemplar.normals[p]);
            const auto foot = source.surface.project(place, normal);
            if (foot && length(foot->point - place) < exemplar.spacing)
                error[p] = float(dot(foot->point - place, foot->normal));
        }
    });
    return error;
}

}  // namespace

void blendBorders(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx) {
    const int support = supportRings(source);
    const std::vector<std::uint8_t> distance = borderDistance(source.arrangement, support + 1, ctx);
    std::vector<Vec3f> points, normals;
    std::vector<std::uint32_t> moving, near;
    std::vector<std::uint8_t> moves;
    for (std::size_t p = 0; p < sheet.size(); ++p) {
        const int ring = distance[nodeOf(source.arrangement, sheet.points[p])];
        if (ring > support) continue;
        points.push_back(sheet.points[p]);
        normals.push_back(sheet.normals[p]);
        near.push_back(std::uint32_t(p));
        moves.push_back(ring < kBlendRings ? 1 : 0);
        if (ring < kBlendRings) moving.push_back(std::uint32_t(p));
    }
    if (moving.empty()) return;
    PointSetSurfaceOptions options;
    options.kernel = source.exemplar.kernel;
    if (source.arrangement.tile) addPeriods(source, support, points, normals);
    const PointSetSurface surface(std::move(points), std::move(normals), options, ctx);
    std::vector<Vec3f> moved(moving.size()), turned(moving.size());
    std::vector<std::uint8_t> held(moving.size());
    Stage stage(ctx, "blending borders", 1);
    parallelFor(ctx, moving.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const std::uint32_t p = moving[m];
            const Vec3d place = cast<double>(sheet.points[p]), normal = cast<double>(sheet.normals[p]);
            const auto foot = surface.project(place, normal);
            const bool holds = foot && length(foot->point - place) < 2 * source.exemplar.spacing &&
                               dot(foot->normal, normal) > 0;
            held[m] = holds ? 1 : 0;
            moved[m] = holds ? cast<float>(foot->point) : sheet.points[p];
            turned[m] = holds ? cast<float>(foot->normal) : sheet.normals[p];
        }
    });
    for (std::size_t m = 0; m < moving.size(); ++m) {
        sheet.points[moving[m]] = moved[m];
        sheet.normals[moving[m]] = turned[m];
        sheet.blended[moving[m]] = held[m];
    }
    if (source.options.even) spread(surface, near, moves, source.exemplar.spacing, sheet, ctx);
    const std::vector<float> error = fitErrors(source, sheet, ctx);
    for (std::size_t p = 0; p < sheet.size(); ++p)
        if (sheet.blended[p]) sheet.points[p] = sheet.points[p] - sheet.normals[p] * error[sheet.source[p]];
    stage.advance();
}

}  // namespace vdbsynth
