#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/sheet/sheet_points_steps.h"
#include "libvdbsynth/points/even_sampling.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kBlendRings = 1;  // of nodes beside a border whose points move

constexpr double kSupport = 8;    // [spacings] what the surface depends on, and a projection's way
constexpr double kSpreading = 3;  // [spacings] what points are spread among: the reach of their forces, ditto

// The last ring of nodes that has points within some spacings of those that move.
int ringsAround(const SheetSource& source, double spacings) {
    return kBlendRings + int(spacings * source.exemplar.spacing / source.arrangement.lattice.step);
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

// A surface through points is smoother than they are. So that nothing is smoothed away where both sides
// agree, points are put off it by as much as the exemplar's are off the exemplar's own.
struct Detail {
    float along = 0;  // [world] along the normal
    Vec3f turn;       // of the normal
};

class BorderBlend {
public:
    BorderBlend(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx)
        : mSource(source), mArrangement(source.arrangement), mSheet(sheet), mContext(ctx) {}

    void run() {
        collect();
        if (std::count(mMoves.begin(), mMoves.end(), std::uint8_t(1)) == 0) return;
        PointSetSurfaceOptions options;
        options.kernel = mSource.exemplar.kernel;
        const PointSetSurface surface(mPoints, mNormals, options, mContext);
        dropFar();
        Stage stage(mContext, "blending borders", 2);
        project(surface);
        stage.advance();
        replace(mSource.options.even ? spread(surface) : EvenSampling{mPoints, mNormals, all(), 0, 0});
        stage.advance();
    }

private:
    void collect() {
        const int support = ringsAround(mSource, kSupport);
        const auto distance = borderDistance(mArrangement, support + 1, mContext);
        for (std::size_t p = 0; p < mSheet.size(); ++p) {
            const int ring = distance[nodeOf(mArrangement, mSheet.points[p])];
            if (ring > support) continue;
            add(p, mSheet.points[p], ring, false);
            if (mArrangement.tile) addCopies(p, ring, (support + 1) * mArrangement.lattice.step);
        }
    }

    void add(std::size_t p, const Vec3f& place, int ring, bool copy) {
        mPoints.push_back(place);
        mNormals.push_back(mSheet.normals[p]);
        mNumber.push_back(std::uint32_t(p));
        mRing.push_back(std::uint8_t(ring));
        mMoves.push_back(ring < kBlendRings ? 1 : 0);
        mCopy.push_back(copy ? 1 : 0);
    }

    // What only the surface needs takes no part in the rest.
    void dropFar() {
        const int most = ringsAround(mSource, kSpreading);
        std::size_t kept = 0;
        for (std::size_t n = 0; n < mPoints.size(); ++n) {
            if (mRing[n] > most) continue;
            mPoints[kept] = mPoints[n];
            mNormals[kept] = mNormals[n];
            mNumber[kept] = mNumber[n];
            mMoves[kept] = mMoves[n];
            mCopy[kept++] = mCopy[n];
        }
        mPoints.resize(kept);
        mNormals.resize(kept);
        mNumber.resize(kept);
        mMoves.resize(kept);
        mCopy.resize(kept);
    }

    // What a tile's point is across its ends: both see the same around them, and move as one. Copies come
    // next to their point, so that of two points too near the same one stays on both sides.
    void addCopies(std::size_t p, int ring, double reach) {
        const double nx = periodAlong(0), ny = periodAlong(1);
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
                const Vec3d at = cast<double>(mSheet.points[p]) + Vec3d{i * nx, j * ny, 0};
                if ((i == 0 && j == 0) || at.x < -reach || at.y < -reach || at.x > nx + reach ||
                    at.y > ny + reach)
                    continue;
                add(p, cast<float>(at), ring, true);
            }
    }

    double periodAlong(int axis) const {
        return (axis == 0 ? mArrangement.lattice.nx : mArrangement.lattice.ny) * mArrangement.lattice.step;
    }

    // Points without a surface that faces their way stay.
    void project(const PointSetSurface& surface) {
        const double most = 2 * mSource.exemplar.spacing;
        parallelFor(mContext, mPoints.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                if (!mMoves[n]) continue;
                const Vec3d place = cast<double>(mPoints[n]), normal = cast<double>(mNormals[n]);
                const auto foot = surface.project(place, normal);
                mMoves[n] = foot && length(foot->point - place) < most && dot(foot->normal, normal) > 0;
                if (!mMoves[n]) continue;
                mPoints[n] = cast<float>(foot->point);
                mNormals[n] = cast<float>(foot->normal);
            }
        });
    }

    // Only the moved points are spread.
    EvenSampling spread(const PointSetSurface& surface) const {
        std::vector<char> fixed;
        for (const std::uint8_t moves : mMoves) fixed.push_back(moves ? 0 : 1);
        EvenSamplingOptions options;
        options.spacing = mSource.exemplar.spacing;
        options.rounds = 3;
        options.onSurface = true;
        return evenSampling(surface, mPoints, mNormals, fixed, options, mContext);
    }

    std::vector<std::uint32_t> all() const {
        std::vector<std::uint32_t> numbers(mPoints.size());
        for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] = std::uint32_t(n);
        return numbers;
    }

    void replace(const EvenSampling& even) {
        SheetPoints result;
        std::vector<std::uint8_t> replaced(mSheet.size(), 0);
        for (const std::uint32_t number : mNumber) replaced[number] = 1;
        const auto append = [&](std::size_t from, const Vec3f& point, const Vec3f& normal, bool blended) {
            result.points.push_back(point);
            result.normals.push_back(normal);
            result.source.push_back(mSheet.source[from]);
            result.patch.push_back(mSheet.patch[from]);
            result.blended.push_back(blended ? 1 : 0);
        };
        for (std::size_t p = 0; p < mSheet.size(); ++p)
            if (!replaced[p]) append(p, mSheet.points[p], mSheet.normals[p], false);
        const std::vector<Detail> detail = details();
        for (std::size_t e = 0; e < even.points.size(); ++e) {
            const std::uint32_t near = even.source[e], number = mNumber[near];
            if (mCopy[near]) continue;
            const Detail lost = mMoves[near] ? detail[mSheet.source[number]] : Detail{};
            append(number, onTile(even.points[e] + even.normals[e] * lost.along),
                   mMoves[near] ? normalized(even.normals[e] + lost.turn) : even.normals[e], mMoves[near]);
        }
        mSheet = std::move(result);
    }

    // Of the exemplar's points that were moved; others have none.
    std::vector<Detail> details() const {
        const PatchExemplar& exemplar = mSource.exemplar;
        std::vector<std::uint8_t> used(exemplar.points.size(), 0);
        for (std::size_t n = 0; n < mNumber.size(); ++n)
            if (mMoves[n]) used[mSheet.source[mNumber[n]]] = 1;
        std::vector<Detail> details(used.size());
        parallelFor(mContext, used.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                if (!used[p]) continue;
                const Vec3d place = cast<double>(exemplar.points[p]),
                            normal = cast<double>(exemplar.normals[p]);
                const auto foot = mSource.surface.project(place, normal);
                if (!foot || length(foot->point - place) > exemplar.spacing) continue;
                details[p] = {float(dot(place - foot->point, foot->normal)),
                              cast<float>(normal - foot->normal)};
            }
        });
        return details;
    }

    Vec3f onTile(Vec3f point) const {
        if (!mArrangement.tile) return point;
        for (const int axis : {0, 1}) {
            const float period = float(periodAlong(axis));
            if (point[axis] < 0) point[axis] += period;
            if (point[axis] >= period) point[axis] -= period;
        }
        return point;
    }

    const SheetSource& mSource;
    const PatchArrangement& mArrangement;
    SheetPoints& mSheet;
    const RunContext& mContext;
    // Near borders; of a tile with copies across its ends.
    std::vector<Vec3f> mPoints, mNormals;
    std::vector<std::uint32_t> mNumber;  // of the sheet's points
    std::vector<std::uint8_t> mRing, mMoves, mCopy;
};

}  // namespace

void blendBorders(const SheetSource& source, SheetPoints& sheet, const RunContext& ctx) {
    BorderBlend(source, sheet, ctx).run();
}

}  // namespace vdbsynth
