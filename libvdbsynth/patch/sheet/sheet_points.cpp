#include "libvdbsynth/patch/sheet/sheet_points.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

void requireOptions(const SheetOptions& options) {
    if (!(options.reach >= 0 && options.reach <= 64))
        throw Error(ErrorCode::InvalidOption, "a warp's reach must be 0..64 steps");
    if (!(options.limit >= 0.1 && options.limit <= 8))
        throw Error(ErrorCode::InvalidOption, "the limit of a warp must be 0.1..8 steps");
}

// One patch's part of the sheet.
struct PatchPart {
    SheetPoints points;
    BorderWarp border;
};

double periodOf(int count, double step) {
    return count * step;
}

double wrappedTo(double x, double period) {
    const double inside = x - std::floor(x / period) * period;
    return float(inside) < float(period) ? inside : 0;
}

class PartMaker {
public:
    PartMaker(const SheetSource& source, const PointColumns& columns) : mSource(source), mColumns(columns) {}

    PatchPart make(std::int32_t number) const {
        PatchPart part;
        const std::vector<std::uint32_t> own = ownPoints(number);
        const double radius = mSource.options.reach * mSource.arrangement.lattice.step;
        std::vector<Vec3d> places;
        for (const std::uint32_t point : own) places.push_back(cast<double>(mSource.exemplar.points[point]));
        part.border =
            warpAtBorders(radius > 0 ? borderMoves(mSource, number) : BorderMoves{}, radius, places);
        const Vec3d shift = shiftOf(mSource.arrangement, number);
        for (std::size_t p = 0; p < own.size(); ++p) {
            const WarpedPlace& warped = part.border.places[p];
            Vec3d normal = cast<double>(mSource.exemplar.normals[own[p]]);
            if (part.border.warped) normal = warpedNormal(warped.jacobian, normal);
            part.points.points.push_back(cast<float>(onSheet(warped.place + shift)));
            part.points.normals.push_back(cast<float>(normal));
            part.points.source.push_back(own[p]);
            part.points.patch.push_back(number);
        }
        part.border.places = {};
        return part;
    }

private:
    Vec3d onSheet(Vec3d place) const {
        const PatchArrangement& a = mSource.arrangement;
        if (!a.tile) return place;
        place.x = wrappedTo(place.x, periodOf(a.lattice.nx, a.lattice.step));
        place.y = wrappedTo(place.y, periodOf(a.lattice.ny, a.lattice.step));
        return place;
    }

    // The points whose node of the sheet is the patch's.
    std::vector<std::uint32_t> ownPoints(std::int32_t number) const {
        const PatchArrangement& a = mSource.arrangement;
        const LaidPatch& laid = a.patches[std::size_t(number)];
        const Vec3d shift = shiftOf(a, number);
        std::vector<std::uint32_t> own;
        constexpr int kPad = PointColumns::kPad;
        for (int i = laid.from.i - kPad; i < laid.from.i + laid.nx + kPad; ++i)
            for (int j = laid.from.j - kPad; j < laid.from.j + laid.ny + kPad; ++j)
                for (const std::uint32_t* p = mColumns.begin(i, j); p != mColumns.end(i, j); ++p)
                    if (isOwn(number, cast<double>(mSource.exemplar.points[*p]) + shift)) own.push_back(*p);
        return own;
    }

    // Of a tile, what lies beside a patch may come round to columns that are the patch's own.
    bool isNearest(std::int32_t number, int i, int j) const {
        const LaidPatch& laid = mSource.arrangement.patches[std::size_t(number)];
        const PatchPlace beside{laid.from.i + i - laid.at.i, laid.from.j + j - laid.at.j};
        return sourceColumn(mSource.arrangement, laid, i, j) == beside;
    }

    bool isOwn(std::int32_t number, const Vec3d& place) const {
        const PatchArrangement& a = mSource.arrangement;
        const int i = int(std::floor(place.x / a.lattice.step)),
                  j = int(std::floor(place.y / a.lattice.step));
        const std::ptrdiff_t column = a.columnAt(i, j);
        if (column < 0 || !isNearest(number, i, j)) return false;
        const int k = std::clamp(int(std::floor(place.z / a.lattice.step)), 0, a.lattice.nz - 1);
        return a.label[std::size_t(column) * std::size_t(a.lattice.nz) + std::size_t(k)] == number;
    }

    const SheetSource& mSource;
    const PointColumns& mColumns;
};

void append(SheetPoints& all, SheetPoints& part) {
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.source.insert(all.source.end(), part.source.begin(), part.source.end());
    all.patch.insert(all.patch.end(), part.patch.begin(), part.patch.end());
    part = {};
}

SheetResult joined(std::vector<PatchPart>& parts, double spacing) {
    SheetResult result;
    std::size_t centres = 0, points = 0;
    for (const PatchPart& part : parts) points += part.points.size();
    result.sheet.points.reserve(points);
    result.sheet.normals.reserve(points);
    result.sheet.source.reserve(points);
    result.sheet.patch.reserve(points);
    for (PatchPart& part : parts) {
        append(result.sheet, part.points);
        result.borders.warps += part.border.warped ? 1 : 0;
        result.borders.shrunk += part.border.shrunk ? 1 : 0;
        result.borders.apartBefore += part.border.before;
        result.borders.apartAfter += part.border.after;
        centres += part.border.centres;
    }
    if (centres > 0) {
        result.borders.apartBefore /= double(centres) * spacing;
        result.borders.apartAfter /= double(centres) * spacing;
    }
    result.sheet.blended.assign(result.sheet.size(), 0);
    return result;
}

}  // namespace

PointColumns::PointColumns(const PatchExemplar& exemplar, const PatchLattice& lattice)
    : mPadded{lattice.step, lattice.nx + 2 * kPad, lattice.ny + 2 * kPad, lattice.nz} {
    mBegin.assign(mPadded.columns() + 1, 0);
    const auto columnOf = [&](const Vec3f& point) {
        const double i = std::floor(double(point.x) / lattice.step) + kPad,
                     j = std::floor(double(point.y) / lattice.step) + kPad;
        if (i < 0 || j < 0 || i >= mPadded.nx || j >= mPadded.ny) return std::ptrdiff_t(-1);
        return std::ptrdiff_t(mPadded.column(int(i), int(j)));
    };
    for (const Vec3f& point : exemplar.points)
        if (const std::ptrdiff_t at = columnOf(point); at >= 0) ++mBegin[std::size_t(at) + 1];
    for (std::size_t c = 1; c < mBegin.size(); ++c) mBegin[c] += mBegin[c - 1];
    mPoints.resize(mBegin.back());
    std::vector<std::size_t> next(mBegin.begin(), mBegin.end() - 1);
    for (std::size_t p = 0; p < exemplar.points.size(); ++p)
        if (const std::ptrdiff_t at = columnOf(exemplar.points[p]); at >= 0)
            mPoints[next[std::size_t(at)]++] = std::uint32_t(p);
}

SheetResult sheetPoints(const PatchExemplar& exemplar, const PointSetSurface& surface,
                        const PatchField& field, const PatchArrangement& arrangement,
                        const SheetOptions& options, const RunContext& ctx) {
    requireOptions(options);
    const SheetSource source{exemplar, surface, field, arrangement, options};
    const PointColumns columns(exemplar, field.lattice);
    const PartMaker maker(source, columns);
    std::vector<PatchPart> parts(arrangement.patches.size());
    constexpr std::size_t kAtOnce = 64;
    Stage stage(ctx, "warping patches", parts.size());
    for (std::size_t first = 0; first < parts.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, parts.size() - first);
        parallelFor(ctx, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) parts[first + n] = maker.make(std::int32_t(first + n));
        });
        stage.advance(count);
    }
    SheetResult result = joined(parts, exemplar.spacing);
    if (options.blend) blendBorders(source, result.sheet, ctx);
    return result;
}

}  // namespace vdbsynth
