#include "libvdbsynth/patch/scanline/scanline_patches.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/patch/scanline/scanline_steps.h"
#include "libvdbsynth/points/even_sampling.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "libvdbsynth/points/surface_variation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kChoice = 0x7363616e;

// Adds the time of its life to a sum.
class Timer {
public:
    explicit Timer(double& seconds) : mSeconds(seconds), mBegin(std::chrono::steady_clock::now()) {}
    ~Timer() { mSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - mBegin).count(); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

private:
    double& mSeconds;
    std::chrono::steady_clock::time_point mBegin;
};

class Scanline {
public:
    Scanline(const PatchExemplar& exemplar, const PatchField& field, const Vec3d& size,
             const ScanlineOptions& options, const RunContext& ctx)
        : mExemplar(exemplar),
          mField(field),
          mSize(size),
          mOptions(options),
          mContext(ctx),
          mStep(field.lattice.step),
          mMargin(options.margin * mStep),
          mSheet(mMargin) {
        mVariation = surfaceVariation(exemplar.points, exemplar.normals, 16, ctx);
    }

    ScanlineResult run() {
        const double pitch = (mOptions.patch - mOptions.margin) * mStep;
        const auto count = [&](double side) {
            return std::max(1, int(std::ceil((side + 2 * mMargin) / pitch - 1e-9)));
        };
        const int across = count(mSize.x), along = count(mSize.y);
        Stage stage(mContext, "laying patches", std::size_t(across) * std::size_t(along));
        for (int j = 0; j < along; ++j)
            for (int i = 0; i < across; ++i) {
                lay({i * pitch - mMargin, j * pitch - mMargin, mOptions.patch * mStep, mMargin, i > 0,
                     j > 0});
                stage.advance();
            }
        const Timer timer(mResult.seconds.other);
        finish();
        return std::move(mResult);
    }

private:
    void lay(const ScanlinePatch& patch) {
        std::vector<ScanlinePoint> neighbours;
        std::optional<PointSetSurface> surface;
        PatchPlace place;
        {
            const Timer timer(mResult.seconds.search);
            neighbours = mSheet.gathered(patch.box().grown(mMargin));
            surface = surfaceOf(neighbours);
            place = placeFor(patch, neighbours, surface);
        }
        std::vector<ScanlinePoint> points = pointsAt(place, patch);
        if (surface) {
            const Timer timer(mResult.seconds.warp);
            const std::size_t pairs =
                warpToNeighbours(patch, neighbours, mExemplar.spacing, mOptions, points, mContext);
            mResult.pairs += pairs;
            if (pairs < 4) ++mResult.unwarped;
        }
        if (surface) {
            const Timer timer(mResult.seconds.blend);
            blendToNeighbours(patch, *surface, points, mContext);
        }
        const Timer timer(mResult.seconds.other);
        const PlaneBox box = patch.box();
        mSheet.removeInside(box);
        for (const ScanlinePoint& point : points)
            if (box.holds(point.point)) mSheet.insert(point);
        ++mResult.patches;
    }

    std::optional<PointSetSurface> surfaceOf(const std::vector<ScanlinePoint>& neighbours) const {
        if (neighbours.empty()) return std::nullopt;
        std::vector<Vec3f> points, normals;
        for (const ScanlinePoint& point : neighbours) {
            points.push_back(point.point);
            normals.push_back(point.normal);
        }
        PointSetSurfaceOptions options;
        options.kind = PointSetKind::AdamsonAlexa;
        return PointSetSurface(std::move(points), std::move(normals), options, mContext);
    }

    // Step 2 and the choice of step 3.
    PatchPlace placeFor(const ScanlinePatch& patch, const std::vector<ScanlinePoint>& neighbours,
                        const std::optional<PointSetSurface>& surface) const {
        const int side = mOptions.patch;
        Random random(mContext.seed, mResult.patches, kChoice);
        if (!surface) {
            if (mOptions.seed && mResult.patches == 0) return *mOptions.seed;
            const int i = int(random.below(std::uint32_t(mField.lattice.nx - side + 1)));
            return {i, int(random.below(std::uint32_t(mField.lattice.ny - side + 1)))};
        }
        const PatchOverlap overlap = measured(patch, neighbours, *surface);
        const auto candidates = patchCandidates(mField, overlap, {mOptions.tolerance, {}, 0}, mContext);
        return candidates[random.below(std::uint32_t(candidates.size()))].place;
    }

    // D(O_k) of what lies there.
    PatchOverlap measured(const ScanlinePatch& patch, const std::vector<ScanlinePoint>& neighbours,
                          const PointSetSurface& surface) const {
        std::vector<Vec3f> points;
        for (const ScanlinePoint& neighbour : neighbours) points.push_back(neighbour.point);
        const PatchLattice lattice{mStep, mOptions.patch, mOptions.patch, mField.lattice.nz};
        PatchOverlap overlap;
        overlap.nx = overlap.ny = mOptions.patch;
        const auto add = [&](int i0, int j0, int nx, int ny) {
            const PatchField part =
                patchField(surface, points, {mStep, nx, ny, lattice.nz},
                           Vec3d{patch.x + i0 * mStep, patch.y + j0 * mStep, 0}, kFieldReach, quiet());
            for (int i = 0; i < nx; ++i)
                for (int j = 0; j < ny; ++j) overlap.columns.push_back({i0 + i, j0 + j});
            overlap.values.insert(overlap.values.end(), part.values.begin(), part.values.end());
        };
        const int margin = mOptions.margin, side = mOptions.patch;
        if (patch.left) add(0, 0, margin, side);
        if (patch.below) add(patch.left ? margin : 0, 0, side - (patch.left ? margin : 0), margin);
        return overlap;
    }

    RunContext quiet() const {
        RunContext ctx = mContext;
        ctx.onProgress = nullptr;
        return ctx;
    }

    // F_k and a margin more on all sides, on the sheet.
    std::vector<ScanlinePoint> pointsAt(const PatchPlace& place, const ScanlinePatch& patch) const {
        const double x = place.i * mStep, y = place.j * mStep, side = patch.side + patch.margin;
        const PlaneBox box = PlaneBox{x, y, x + side, y + side}.grown(patch.margin);
        const Vec3f shift = cast<float>(Vec3d{patch.x - x, patch.y - y, 0});
        std::vector<ScanlinePoint> points;
        for (std::size_t p = 0; p < mExemplar.points.size(); ++p)
            if (box.holds(mExemplar.points[p]))
                points.push_back({mExemplar.points[p] + shift, mExemplar.normals[p], mVariation[p],
                                  std::uint32_t(p), std::int32_t(mResult.patches), 0});
        return points;
    }

    // Step 8, and the relaxation.
    void finish() {
        SheetPoints sheet;
        const PlaneBox inside = PlaneBox{0, 0, mSize.x, mSize.y}.grown(std::min(mSize.z, mMargin));
        std::vector<ScanlinePoint> points = mSheet.all();
        if (mOptions.relax && !points.empty()) relax(points);
        for (const ScanlinePoint& point : points) {
            if (!inside.holds(point.point)) continue;
            sheet.points.push_back(point.point);
            sheet.normals.push_back(point.normal);
            sheet.source.push_back(point.source);
            sheet.patch.push_back(point.patch);
            sheet.blended.push_back(point.blended);
        }
        mResult.sheet = std::move(sheet);
    }

    // Only blended points move: elsewhere the sampling is the exemplar's.
    void relax(std::vector<ScanlinePoint>& points) const {
        std::vector<Vec3f> places, normals;
        std::vector<char> fixed;
        for (const ScanlinePoint& point : points) {
            places.push_back(point.point);
            normals.push_back(point.normal);
            fixed.push_back(point.blended ? 0 : 1);
        }
        const PointSetSurface surface(places, normals, {}, mContext);
        EvenSamplingOptions options;
        options.spacing = mExemplar.spacing;
        const EvenSampling even = evenSampling(surface, places, normals, fixed, options, mContext);
        std::vector<ScanlinePoint> spread;
        for (std::size_t p = 0; p < even.points.size(); ++p) {
            spread.push_back(points[even.source[p]]);
            spread.back().point = even.points[p];
            spread.back().normal = even.normals[p];
        }
        points = std::move(spread);
    }

    const PatchExemplar& mExemplar;
    const PatchField& mField;
    const Vec3d mSize;
    const ScanlineOptions& mOptions;
    const RunContext& mContext;
    const double mStep, mMargin;
    std::vector<float> mVariation;
    PointBuckets mSheet;
    ScanlineResult mResult;
};

}  // namespace

void validate(const ScanlineOptions& options) {
    const auto require = [](bool holds, const char* text) {
        if (!holds) throw Error(ErrorCode::InvalidOption, text);
    };
    require(options.patch >= 4, "a patch must be at least four steps of the field wide");
    require(options.margin >= 1 && options.margin < options.patch,
            "a patch must be wider than its margin, and that at least a step of the field");
    require(options.tolerance >= 0 && options.tolerance <= 10, "`tolerance` must be 0..10");
    require(options.clusterPoints >= 2 && options.clusterPoints <= 10000, "`clusterPoints` must be 2..10000");
    require(options.clusterVariation >= 0 && options.clusterVariation <= 1.0 / 3,
            "`clusterVariation` must be 0..1/3");
    validate(options.pairing);
}

ScanlineResult scanlinePatches(const PatchExemplar& exemplar, const PatchField& field, const Vec3d& size,
                               const ScanlineOptions& options, const RunContext& ctx) {
    validate(options);
    if (!(size.x > 0 && size.y > 0)) throw Error(ErrorCode::InvalidOption, "`size` must be above 0");
    if (options.patch > std::min(field.lattice.nx, field.lattice.ny))
        throw Error(ErrorCode::Unusable, "a patch is larger than the exemplar; a smaller `patch` fits");
    if (options.seed &&
        (options.seed->i < 0 || options.seed->j < 0 || options.seed->i > field.lattice.nx - options.patch ||
         options.seed->j > field.lattice.ny - options.patch))
        throw Error(ErrorCode::InvalidOption, "the seed patch must lie in the exemplar");
    return Scanline(exemplar, field, size, options, ctx).run();
}

}  // namespace vdbsynth
