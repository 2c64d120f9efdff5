#include "libvdbsynth/patch/onto/onto_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/patch/onto/onto_layout.h"
#include "libvdbsynth/patch/patch_size.h"
#include "libvdbsynth/patch/patch_synthesis.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr double kDiameter = 1.128;   // of a circle over the side of a square of the same area
constexpr double kLargest = 2.0 / 3;  // of the exemplar's shorter side, so that there are places
constexpr double kSpacing = 0.9;      // [steps] between sites at least, so that each has about a step^2

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double stepOf(const PatchExemplar& exemplar, const OntoOptions& options) {
    PatchOptions sheet;
    sheet.step = options.step;
    return fieldStep(exemplar, sheet);
}

OntoLayoutOptions layoutOf(const PatchField& field, const OntoOptions& options, const RunContext& ctx) {
    const PatchSides sides = patchSides(field, options.patch, options.overlap, ctx);
    const int shorter = std::min(field.lattice.nx, field.lattice.ny);
    const int most = options.patch > 0 ? shorter : std::max(4, int(kLargest * shorter));
    OntoLayoutOptions layout;
    layout.patch = std::min(most, int(std::lround(kDiameter * sides.patch)));
    layout.overlap = std::max(1, std::min(sides.overlap, (layout.patch - 1) / 2));
    layout.tolerance = options.tolerance;
    layout.repairs = options.repairs;
    return layout;
}

// The height in the middle of the exemplar's points.
double middleHeight(const PatchExemplar& exemplar) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3f& p : exemplar.points) {
        if (p.x < 0 || p.y < 0 || double(p.x) >= exemplar.size.x || double(p.y) >= exemplar.size.y) continue;
        low = std::min(low, double(p.z));
        high = std::max(high, double(p.z));
    }
    return low <= high ? 0.5 * (low + high) : 0.5 * exemplar.size.z;
}

// The disks of an arrangement, from their centres.
void remakeDisks(const OntoSurface& surface, OntoArrangement& arrangement, const RunContext& ctx) {
    const auto require = [](bool holds) {
        if (!holds)
            throw Error(ErrorCode::ShapeMismatch, "the map's patches and its surface do not fit together");
    };
    require(arrangement.label.size() == surface.sites.size() * std::size_t(arrangement.nz));
    SurfaceDisks disks(surface);
    Stage stage(ctx, "laying patches", arrangement.patches.size());
    for (OntoPatch& patch : arrangement.patches) {
        require(patch.disk.centre < surface.sites.size());
        patch.disk = disks.around(patch.disk.centre, patch.radius + kOntoRim * arrangement.step);
        stage.advance();
    }
    for (std::uint32_t site = 0; site < surface.sites.size(); ++site)
        for (int k = 0; k < arrangement.nz; ++k) {
            const std::int32_t label = arrangement.column(site)[k];
            require(label < std::int32_t(arrangement.patches.size()) &&
                    (label < 0) == (arrangement.column(site)[0] < 0) &&
                    (label < 0 || arrangement.patches[std::size_t(label)].disk.find(site) >= 0));
        }
}

}  // namespace

void validate(const OntoOptions& options) {
    const auto require = [](bool holds, const char* text) {
        if (!holds) throw Error(ErrorCode::InvalidOption, text);
    };
    require(options.patch >= 0, "`patch` must be at least 0");
    require(options.overlap == 0 || (options.overlap >= 0.05 && options.overlap <= 0.8),
            "`overlap` must be 0.05..0.8");
    require(options.tolerance >= 0 && options.tolerance <= 10, "`tolerance` must be 0..10");
    require(options.step == 0 || (options.step >= 0.5 && options.step <= 64), "`step` must be 0.5..64");
    require(options.repairs >= 0 && options.repairs <= 20, "`repairs` must be 0..20");
    require(options.scale >= 0.001 && options.scale <= 1000, "`scale` must be 0.001..1000");
    require(std::abs(options.heightOffset) < 1e30, "`heightOffset` must be finite");
}

PatchExemplar scaledExemplar(const PatchExemplar& exemplar, double scale) {
    PatchExemplar scaled = exemplar;
    if (scale == 1) return scaled;
    for (Vec3f& point : scaled.points) point = cast<float>(cast<double>(point) * scale);
    scaled.size = scaled.size * scale;
    scaled.spacing *= scale;
    return scaled;
}

double siteSpacing(const PatchExemplar& exemplar, const OntoOptions& options) {
    return kSpacing * stepOf(exemplar, options);
}

OntoResult synthesizeOnto(const PatchExemplar& exemplar, const OntoSurface& surface,
                          const OntoOptions& options, const RunContext& ctx) {
    validate(options);
    auto begin = std::chrono::steady_clock::now();
    PointSetSurfaceOptions kind;
    kind.kernel = exemplar.kernel;
    const PointSetSurface exemplarSurface(exemplar.points, exemplar.normals, kind, ctx);
    const PatchField field =
        patchField(exemplarSurface, exemplar.points, latticeOf(exemplar.size, stepOf(exemplar, options)), {},
                   kFieldReach, ctx);
    const OntoLayoutOptions layout = layoutOf(field, options, ctx);
    OntoResult result;
    result.other = secondsSince(begin);
    begin = std::chrono::steady_clock::now();
    result.arrangement = layOntoSurface(surface, field, layout, ctx);
    result.search = secondsSince(begin);
    begin = std::chrono::steady_clock::now();
    SheetOptions sheet;
    sheet.reach = options.warp ? layout.overlap : 0;
    sheet.blend = options.blend;
    result.zero = middleHeight(exemplar) - options.heightOffset;
    OntoPointsResult made =
        ontoPoints(exemplar, exemplarSurface, field, surface, result.arrangement, result.zero, sheet, ctx);
    result.warp = secondsSince(begin);
    result.sheet = std::move(made.sheet);
    result.borders = made.borders;
    result.bend = made.bend;
    result.step = field.lattice.step;
    result.patch = layout.patch * result.step;
    result.overlap = layout.overlap * result.step;
    result.patches = result.arrangement.patches.size();
    return result;
}

OntoResult repeatOnto(const PatchExemplar& exemplar, const OntoSurface& surface, OntoArrangement arrangement,
                      double zero, const OntoOptions& options, const RunContext& ctx) {
    validate(options);
    PointSetSurfaceOptions kind;
    kind.kernel = exemplar.kernel;
    const PointSetSurface exemplarSurface(exemplar.points, exemplar.normals, kind, ctx);
    const PatchField field = patchField(exemplarSurface, exemplar.points,
                                        latticeOf(exemplar.size, arrangement.step), {}, kFieldReach, ctx);
    if (field.lattice.nz != arrangement.nz)
        throw Error(ErrorCode::ShapeMismatch,
                    "the exemplar is not as high as the map's; give one whose box is that of the run's own");
    OntoResult result;
    result.arrangement = std::move(arrangement);
    remakeDisks(surface, result.arrangement, ctx);
    SheetOptions sheet;
    sheet.reach =
        options.warp ? double(std::lround(result.arrangement.overlap / result.arrangement.step)) : 0.0;
    sheet.blend = options.blend;
    OntoPointsResult made =
        ontoPoints(exemplar, exemplarSurface, field, surface, result.arrangement, zero, sheet, ctx);
    result.zero = zero;
    result.sheet = std::move(made.sheet);
    result.borders = made.borders;
    result.bend = made.bend;
    result.step = field.lattice.step;
    result.overlap = result.arrangement.overlap;
    result.patches = result.arrangement.patches.size();
    return result;
}

}  // namespace vdbsynth
