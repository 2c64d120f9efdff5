#include "libvdbsynth/patch/patch_repair.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/patch/layout/patch_hole_layout.h"
#include "libvdbsynth/patch/patch_size.h"
#include "libvdbsynth/patch/sheet/patch_alignment.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

constexpr double kLeastStep = 2, kMostColumns = 288;
constexpr int kStale = 1;               // columns around a hole whose distances refer to what is gone
constexpr int kEnds = 3;                // columns at a sheet's ends whose distances know less
constexpr std::size_t kFewPlaces = 64;  // that a patch should fit at
constexpr int kLeastPatch = 6;          // columns
constexpr double kFits = 1.5;           // [steps] that a patch may be moved

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// The sheet without the points in its hole and, beside it, the exemplar, as one texture.
struct Joined {
    PatchExemplar texture;
    PatchLattice lattice;
    PatchLattice sheet;                // the sheet's part
    std::vector<std::uint8_t> hole;    // [sheet's columns] widened by what is stale
    std::vector<std::uint8_t> barred;  // [columns]
    int other = 0;                     // first column of the exemplar, 0: none
    double up = 0;                     // [world] by which all is raised
    std::size_t removed = 0;
};

bool inHole(const PatchLattice& l, const std::vector<std::uint8_t>& hole, const Vec3f& point) {
    const double i = std::floor(double(point.x) / l.step), j = std::floor(double(point.y) / l.step);
    if (i < 0 || j < 0 || i >= l.nx || j >= l.ny) return false;
    return hole[l.column(int(i), int(j))] != 0;
}

double medianHeight(const PatchExemplar& exemplar) {
    std::vector<float> heights;
    for (const Vec3f& point : exemplar.points) heights.push_back(point.z);
    const auto middle = heights.begin() + std::ptrdiff_t(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    return double(*middle);
}

// [world] From the exemplar's heights to the sheet's.
double heightBetween(const PatchExemplar& sheet, const PatchExemplar& other, double step,
                     const RunContext& ctx) {
    const double same = toPlane(sheet.plane, other.corner).z - toPlane(sheet.plane, sheet.corner).z;
    const double apart = medianHeight(sheet) - medianHeight(other);
    if (std::abs(apart - same) <= step) return same;
    message(ctx, MessageLevel::Note,
            "the exemplar lies " + roundedText(same - apart, 4) +
                " (world) above the sheet, by the medians of both; it is moved down by that");
    return apart;
}

void addPoints(const PatchExemplar& from, const Vec3d& shift, std::uint32_t first, PatchExemplar& to) {
    for (std::size_t p = 0; p < from.points.size(); ++p) {
        to.points.push_back(cast<float>(cast<double>(from.points[p]) + shift));
        to.normals.push_back(from.normals[p]);
        to.number.push_back(first + from.number[p]);
    }
}

// The sheet is copied from where it is whole.
void barOwn(Joined& joined) {
    const PatchLattice& l = joined.lattice;
    for (int i = 0; i < l.nx; ++i)
        for (int j = 0; j < l.ny; ++j)
            if (i < kEnds || j < kEnds || i >= l.nx - kEnds || j >= l.ny - kEnds)
                joined.barred[l.column(i, j)] = 1;
}

void joinOther(const PatchExemplar& sheet, const PatchExemplar& other, std::uint32_t first, Joined& joined,
               const RunContext& ctx) {
    const double step = joined.sheet.step, height = heightBetween(sheet, other, step, ctx);
    double left = 0;
    for (const Vec3f& point : other.points) left = std::min(left, double(point.x));
    // Beyond both margins and what surfaces there depend on.
    const int gap = int(std::ceil((8 * std::max(sheet.spacing, other.spacing) - left) / step)) + 8;
    const PatchLattice beside = latticeOf(other.size, step);
    joined.up = std::ceil(std::max(0.0, -height) / step - 1e-6) * step;
    joined.other = joined.sheet.nx + gap;
    joined.texture.size = {(joined.other + beside.nx) * step, std::max(joined.sheet.ny, beside.ny) * step,
                           joined.up + std::max(sheet.size.z, height + other.size.z)};
    joined.lattice = latticeOf(joined.texture.size, step);
    for (Vec3f& point : joined.texture.points) point.z = float(double(point.z) + joined.up);
    addPoints(other, {joined.other * step, 0, height + joined.up}, first, joined.texture);
    joined.barred.assign(joined.lattice.columns(), 1);
    for (int i = 0; i < beside.nx; ++i)
        for (int j = 0; j < beside.ny; ++j)
            if (joined.other + i < joined.lattice.nx)
                joined.barred[joined.lattice.column(joined.other + i, j)] = 0;
}

Joined joinedOf(const PatchExemplar& sheet, const std::vector<std::uint8_t>& hole, const PatchExemplar* other,
                double step, std::uint32_t first, const RunContext& ctx) {
    Joined joined;
    joined.sheet = joined.lattice = latticeOf(sheet.size, step);
    if (hole.size() != joined.sheet.columns())
        throw Error(ErrorCode::ShapeMismatch, "the hole and the sheet's lattice differ in size");
    joined.hole = widenedColumns(hole, joined.sheet.nx, joined.sheet.ny, kStale);
    PatchExemplar& texture = joined.texture;
    texture.size = sheet.size;
    texture.spacing = sheet.spacing;
    texture.kernel = other ? std::min(sheet.kernel, other->kernel) : sheet.kernel;
    texture.plane = sheet.plane;
    texture.corner = sheet.corner;
    for (std::size_t p = 0; p < sheet.points.size(); ++p) {
        if (inHole(joined.sheet, hole, sheet.points[p])) {
            ++joined.removed;
            continue;
        }
        texture.points.push_back(sheet.points[p]);
        texture.normals.push_back(sheet.normals[p]);
        texture.number.push_back(sheet.number[p]);
    }
    if (texture.points.empty())
        throw Error(ErrorCode::Unusable, "the hole covers the whole sheet; nothing is left to continue");
    joined.barred = joined.hole;
    if (other)
        joinOther(sheet, *other, first, joined, ctx);
    else
        barOwn(joined);
    return joined;
}

// A part of a field.
PatchField partOf(const PatchField& field, int i0, int i1, int j0, int j1) {
    const PatchLattice& l = field.lattice;
    PatchField part{{l.step, i1 - i0, j1 - j0, l.nz}, {}};
    for (int i = i0; i < i1; ++i)
        part.values.insert(part.values.end(), field.column(i, j0),
                           field.column(i, j1 - 1) + field.columnLength());
    return part;
}

// Of the four parts of a sheet beside its hole the widest: the hole would be a feature of the whole.
PatchField besideHole(const PatchField& field, const Joined& joined) {
    const int nx = joined.sheet.nx, ny = joined.sheet.ny;
    int i0 = nx, i1 = 0, j0 = ny, j1 = 0;
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
            if (joined.hole[joined.sheet.column(i, j)]) {
                i0 = std::min(i0, i);
                i1 = std::max(i1, i + 1);
                j0 = std::min(j0, j);
                j1 = std::max(j1, j + 1);
            }
    const std::array<std::array<int, 4>, 4> parts{
        {{0, i0, 0, ny}, {i1, nx, 0, ny}, {0, nx, 0, j0}, {0, nx, j1, ny}}};
    const auto width = [](const std::array<int, 4>& part) {
        return std::min(part[1] - part[0], part[3] - part[2]);
    };
    const auto best = *std::max_element(parts.begin(), parts.end(),
                                        [&](const auto& a, const auto& b) { return width(a) < width(b); });
    if (width(best) < 2 * kLeastPatch) return field;
    return partOf(field, best[0], best[1], best[2], best[3]);
}

PatchSides sidesOf(const PatchField& field, const Joined& joined, const BarredColumns& barred,
                   const PatchOptions& options, const RunContext& ctx) {
    if (options.patch > 0) return patchSides(field, options.patch, options.overlap, ctx);
    const bool own = joined.other == 0;
    const PatchField copied =
        own ? besideHole(field, joined) : partOf(field, joined.other, field.lattice.nx, 0, field.lattice.ny);
    const int side = patchSide(own ? field : copied, patchFeature(copied, ctx));
    PatchSides sides = patchSides(field, side * field.lattice.step, options.overlap, ctx);
    const int wanted = sides.patch;
    sides.patch = std::min({wanted, joined.sheet.nx, joined.sheet.ny});
    while (sides.patch > kLeastPatch && barred.places(sides.patch, sides.patch) < kFewPlaces) --sides.patch;
    if (sides.patch == wanted) return sides;
    sides.overlap = std::max(1, sides.overlap * sides.patch / wanted);
    message(ctx, MessageLevel::Note,
            "a patch of " + roundedText(wanted * field.lattice.step, 4) +
                " (world) fits at few places beside the hole; it is made " +
                roundedText(sides.patch * field.lattice.step, 4) +
                " wide. An EXEMPLAR without a hole has more");
    return sides;
}

// What stays does not move: all others are moved back by as much as it was.
void alignToKept(const Joined& joined, const PointSetSurface& surface, const PatchField& field,
                 PatchArrangement& arrangement, const RunContext& ctx) {
    const std::vector<LaidPatch> laid = arrangement.patches;
    alignPatches(joined.texture, surface, field, arrangement, ctx);
    const Vec3d back = arrangement.patches.front().fine;
    for (std::size_t p = 0; p < laid.size(); ++p) {
        Vec3d& fine = arrangement.patches[p].fine;
        for (const int axis : {0, 1})
            fine[axis] =
                std::clamp(fine[axis] - back[axis], laid[p].fine[axis] - kFits, laid[p].fine[axis] + kFits);
    }
    arrangement.patches.front().fine = {};
}

bool same(const Vec3f& a, const Vec3f& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// Tells the points that are untouched from all others. Points beyond the lattice are no node's, and stay.
void sort(const SheetPoints& made, const Joined& joined, std::uint32_t first, RepairResult& result) {
    const PatchExemplar& texture = joined.texture;
    for (std::size_t p = 0; p < made.size(); ++p) {
        const std::uint32_t number = texture.number[made.source[p]];
        if (made.patch[p] == 0 && number < first && !made.blended[p] &&
            same(made.points[p], texture.points[made.source[p]])) {
            result.kept.push_back(number);
            continue;
        }
        Vec3f place = made.points[p];
        place.z = float(double(place.z) - joined.up);
        result.made.points.push_back(place);
        result.made.normals.push_back(made.normals[p]);
        result.made.source.push_back(number);
        result.made.patch.push_back(made.patch[p]);
        result.made.blended.push_back(made.blended[p]);
    }
    const double step = joined.sheet.step;
    for (std::size_t p = 0; p < texture.points.size(); ++p) {
        const double i = std::floor(double(texture.points[p].x) / step),
                     j = std::floor(double(texture.points[p].y) / step);
        const bool beyond = i < 0 || j < 0 || i >= joined.sheet.nx || j >= joined.sheet.ny;
        if (texture.number[p] < first && beyond) result.kept.push_back(texture.number[p]);
    }
    std::sort(result.kept.begin(), result.kept.end());
}

}  // namespace

double repairStep(const PatchExemplar& sheet, const PatchOptions& options) {
    if (options.step > 0) return options.step * sheet.spacing;
    return std::max(kLeastStep * sheet.spacing, std::max(sheet.size.x, sheet.size.y) / kMostColumns);
}

RepairResult repairPatches(const PatchExemplar& sheet, const std::vector<std::uint8_t>& hole,
                           const PatchExemplar* exemplar, const PatchOptions& options,
                           const RunContext& ctx) {
    auto begin = std::chrono::steady_clock::now();
    RepairResult result;
    for (const std::uint32_t number : sheet.number) result.first = std::max(result.first, number + 1);
    const Joined joined = joinedOf(sheet, hole, exemplar, repairStep(sheet, options), result.first, ctx);
    PointSetSurfaceOptions kind;
    kind.kernel = joined.texture.kernel;
    const PointSetSurface surface(joined.texture.points, joined.texture.normals, kind, ctx);
    const PatchField field = patchField(surface, joined.texture.points, joined.lattice, {}, kFieldReach, ctx);
    const BarredColumns barred(joined.lattice, joined.barred);
    const PatchSides sides = sidesOf(field, joined, barred, options, ctx);
    result.other = secondsSince(begin);
    begin = std::chrono::steady_clock::now();
    LayoutOptions layout{sides.patch, sides.overlap, options.tolerance, false, options.repairs, &barred};
    PatchArrangement arrangement =
        layIntoHole(field, joined.sheet.nx, joined.sheet.ny, joined.hole, layout, ctx);
    result.search = secondsSince(begin);
    begin = std::chrono::steady_clock::now();
    if (options.warp) alignToKept(joined, surface, field, arrangement, ctx);
    SheetOptions points;
    points.reach = options.warp ? sides.overlap : 0;
    points.blend = options.blend;
    const SheetResult made = sheetPoints(joined.texture, surface, field, arrangement, points, ctx);
    sort(made.sheet, joined, result.first, result);
    result.warp = secondsSince(begin);
    result.removed = joined.removed;
    result.patches = arrangement.patches.size() - 1;
    result.borders = made.borders;
    result.patch = sides.patch * field.lattice.step;
    result.overlap = sides.overlap * field.lattice.step;
    result.step = field.lattice.step;
    return result;
}

}  // namespace vdbsynth
