#include "libvdbsynth/patch/patch_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/patch/layout/patch_layout.h"
#include "libvdbsynth/patch/patch_size.h"
#include "libvdbsynth/patch/scanline/pairing_weights.h"
#include "libvdbsynth/patch/scanline/scanline_patches.h"
#include "libvdbsynth/patch/sheet/patch_alignment.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "libvdbsynth/points/surface_variation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

constexpr int kProbes = 8;

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

PointSetSurface surfaceOf(const PatchExemplar& exemplar, PointSetKind kind, const RunContext& ctx) {
    PointSetSurfaceOptions options;
    options.kind = kind;
    options.kernel = exemplar.kernel;
    return PointSetSurface(exemplar.points, exemplar.normals, options, ctx);
}

int wholeColumns(double side, double step) {
    return int(std::ceil(side / step - 1e-6));
}

// Columns of a sheet, with as many on all sides as its border needs, and at least as the surface at its ends
// depends on. A tile has no ends.
int columnsOf(const PatchExemplar& exemplar, const PatchOptions& options, double side, double step) {
    constexpr double kReach = 7;  // [spacings]
    const double beyond = std::max(options.border, kReach * exemplar.spacing);
    return wholeColumns(side, step) + (options.tile ? 0 : 2 * wholeColumns(beyond, step));
}

// [world] Where the lattice of an arrangement begins.
double beginOf(const PatchArrangement& arrangement, const PatchOptions& options) {
    const PatchLattice& l = arrangement.lattice;
    return -(l.nx - wholeColumns(options.width, l.step)) / 2 * l.step;
}

void add(const SheetPoints& from, std::size_t point, const Vec3f& place, SheetPoints& to) {
    to.points.push_back(place);
    to.normals.push_back(from.normals[point]);
    to.source.push_back(from.source[point]);
    to.patch.push_back(from.patch[point]);
    to.blended.push_back(from.blended[point]);
}

// Moves the sheet so that it begins at 0, and keeps it and its border; a tile's border is its other side.
SheetPoints placed(const SheetPoints& sheet, const PatchArrangement& arrangement,
                   const PatchOptions& options) {
    const double border = options.border, begin = beginOf(arrangement, options);
    const int periods = options.tile && border > 0 ? 1 : 0;
    SheetPoints kept;
    for (int i = -periods; i <= periods; ++i)
        for (int j = -periods; j <= periods; ++j)
            for (std::size_t p = 0; p < sheet.size(); ++p) {
                const Vec3d at = cast<double>(sheet.points[p]) +
                                 Vec3d{begin + i * options.width, begin + j * options.depth, 0};
                if (at.x >= -border && at.y >= -border && at.x < options.width + border &&
                    at.y < options.depth + border)
                    add(sheet, p, cast<float>(at), kept);
            }
    return kept;
}

SheetOptions sheetOptionsOf(const PatchOptions& options, double reach) {
    SheetOptions sheet;
    sheet.reach = options.warp ? reach : 0;
    sheet.blend = options.blend;
    return sheet;
}

PatchResult byPaper(const PatchExemplar& exemplar, const PatchField& field, const PatchSides& sides,
                    const PatchOptions& options, const RunContext& ctx) {
    ScanlineOptions scanline;
    scanline.patch = sides.patch;
    scanline.margin = sides.overlap;
    scanline.tolerance = options.tolerance;
    scanline.pairing.limits = options.limits;
    scanline.pairing.rounds = options.rounds;
    if (options.seedPlace) {
        const Vec3d place =
            toPlane(exemplar.plane, *options.seedPlace - exemplar.corner) * (1 / field.lattice.step);
        scanline.seed = PatchPlace{int(std::lround(place.x)), int(std::lround(place.y))};
    }
    scanline.pairing.weights =
        options.weights
            ? *options.weights
            : nearMatchWeights(exemplar, surfaceVariation(exemplar.points, exemplar.normals, 16, ctx), field,
                               sides.patch, sides.overlap, kProbes, ctx);
    ScanlineResult made =
        scanlinePatches(exemplar, field, {options.width, options.depth, options.border}, scanline, ctx);
    PatchResult result;
    result.sheet = std::move(made.sheet);
    result.patches = made.patches;
    result.pairs = made.pairs;
    result.unwarped = made.unwarped;
    result.weights = scanline.pairing.weights;
    result.search = made.seconds.search;
    result.warp = made.seconds.warp;
    result.blend = made.seconds.blend;
    result.other = made.seconds.other;
    return result;
}

PatchResult byCuts(const PatchExemplar& exemplar, const PointSetSurface& surface, const PatchField& field,
                   const PatchSides& sides, const PatchOptions& options, const RunContext& ctx) {
    const double step = field.lattice.step;
    for (const double side : {options.width, options.depth})
        if (options.tile && std::abs(wholeColumns(side, step) * step - side) > 1e-5 * step)
            throw Error(ErrorCode::InvalidOption, "to tile, `size` must be whole steps of the field, " +
                                                      roundedText(step, 6) + " each");
    PatchResult result;
    auto begin = std::chrono::steady_clock::now();
    result.arrangement =
        layPatches(field, columnsOf(exemplar, options, options.width, step),
                   columnsOf(exemplar, options, options.depth, step),
                   {sides.patch, sides.overlap, options.tolerance, options.tile, options.repairs}, ctx);
    result.search = secondsSince(begin);
    begin = std::chrono::steady_clock::now();
    if (options.warp) alignPatches(exemplar, surface, field, result.arrangement, ctx);
    SheetResult made = sheetPoints(exemplar, surface, field, result.arrangement,
                                   sheetOptionsOf(options, result.arrangement.overlap), ctx);
    result.warp = secondsSince(begin);
    result.sheet = std::move(made.sheet);
    result.borders = made.borders;
    result.patches = result.arrangement.patches.size();
    result.sheet = placed(result.sheet, result.arrangement, options);
    return result;
}

}  // namespace

void validate(const PatchOptions& options) {
    const auto require = [](bool holds, const char* text) {
        if (!holds) throw Error(ErrorCode::InvalidOption, text);
    };
    require(options.width > 0 && options.depth > 0, "`size` must be above 0");
    require(options.border >= 0 && options.border < 1e30, "`border` must be at least 0");
    require(options.patch >= 0, "`patch` must be at least 0");
    require(options.overlap == 0 || (options.overlap >= 0.05 && options.overlap <= 0.8),
            "`overlap` must be 0.05..0.8");
    require(options.tolerance >= 0 && options.tolerance <= 10, "`tolerance` must be 0..10");
    require(options.step == 0 || (options.step >= 0.5 && options.step <= 64), "`step` must be 0.5..64");
    require(options.repairs >= 0 && options.repairs <= 20, "`repairs` must be 0..20");
    PairingOptions pairing;
    if (options.weights) pairing.weights = *options.weights;
    pairing.limits = options.limits;
    pairing.rounds = options.rounds;
    validate(pairing);
}

double fieldStep(const PatchExemplar& exemplar, const PatchOptions& options) {
    constexpr double kLeast = 2, kMostColumns = 72;
    const double step =
        options.step > 0
            ? options.step * exemplar.spacing
            : std::max(kLeast * exemplar.spacing, std::max(exemplar.size.x, exemplar.size.y) / kMostColumns);
    return options.tile && options.width > 0 ? options.width / std::max(1.0, std::round(options.width / step))
                                             : step;
}

PatchResult synthesizePatches(const PatchExemplar& exemplar, const PatchOptions& options,
                              const RunContext& ctx) {
    validate(options);
    const auto begin = std::chrono::steady_clock::now();
    const bool paper = options.method == PatchMethod::Paper;
    const PointSetSurface surface =
        surfaceOf(exemplar, paper ? PointSetKind::AdamsonAlexa : PointSetKind::Apss, ctx);
    const PatchField field =
        patchField(surface, exemplar.points, latticeOf(exemplar.size, fieldStep(exemplar, options)), {},
                   kFieldReach, ctx);
    const PatchSides sides = patchSides(field, options.patch, options.overlap, ctx);
    const double prepared = secondsSince(begin);
    PatchResult result = paper ? byPaper(exemplar, field, sides, options, ctx)
                               : byCuts(exemplar, surface, field, sides, options, ctx);
    result.other += prepared;
    result.patch = sides.patch * field.lattice.step;
    result.overlap = sides.overlap * field.lattice.step;
    result.step = field.lattice.step;
    return result;
}

SheetResult repeatPatches(const PatchExemplar& exemplar, const PatchArrangement& arrangement,
                          const PatchOptions& options, const RunContext& ctx) {
    validate(options);
    const PointSetSurface surface = surfaceOf(exemplar, PointSetKind::Apss, ctx);
    const PatchField field = patchField(
        surface, exemplar.points, latticeOf(exemplar.size, arrangement.lattice.step), {}, kFieldReach, ctx);
    for (const LaidPatch& patch : arrangement.patches)
        if (patch.from.i < 0 || patch.from.j < 0 || patch.from.i + patch.nx > field.lattice.nx ||
            patch.from.j + patch.ny > field.lattice.ny || field.lattice.nz != arrangement.lattice.nz)
            throw Error(
                ErrorCode::ShapeMismatch,
                "the map's patches reach beyond this exemplar; give one whose box is that of the run's own");
    SheetResult result =
        sheetPoints(exemplar, surface, field, arrangement, sheetOptionsOf(options, arrangement.overlap), ctx);
    result.sheet = placed(result.sheet, arrangement, options);
    return result;
}

}  // namespace vdbsynth
