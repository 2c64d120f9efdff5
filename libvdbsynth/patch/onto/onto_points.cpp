#include "libvdbsynth/patch/onto/onto_points.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/patch/onto/chart_surface.h"
#include "libvdbsynth/patch/onto/onto_points_steps.h"
#include "libvdbsynth/patch/sheet/border_blend.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vdbsynth {
namespace {

// One patch's part of the surface.
struct OntoPart {
    SheetPoints points;
    std::vector<std::size_t> node;  // [points]
    std::vector<float> bend;        // [sites that are the patch's at half height]
    std::size_t bare = 0, dropped = 0;
    BorderWarp border;
};

struct Heights {
    double low = std::numeric_limits<double>::infinity(), high = -low;
};

// Of the points over the exemplar's box, from that which lies on the surface.
Heights heightsOf(const PatchExemplar& exemplar, double zero) {
    Heights heights;
    for (const Vec3f& p : exemplar.points) {
        if (p.x < 0 || p.y < 0 || double(p.x) >= exemplar.size.x || double(p.y) >= exemplar.size.y) continue;
        heights.low = std::min(heights.low, double(p.z) - zero);
        heights.high = std::max(heights.high, double(p.z) - zero);
    }
    return heights;
}

class PartMaker {
public:
    PartMaker(const OntoSource& source, const Heights& heights, std::int32_t number)
        : mSource(source),
          mHeights(heights),
          mNumber(number),
          mPatch(source.arrangement.patches[std::size_t(number)]),
          mBase(source.surface.sites, mPatch.disk, source.arrangement.step) {}

    OntoPart make() {
        const std::vector<std::uint32_t> own = ownPoints();
        const double radius = mSource.options.reach * mSource.arrangement.step;
        std::vector<Vec3d> places;
        for (const std::uint32_t point : own) places.push_back(cast<double>(mSource.exemplar.points[point]));
        mPart.border =
            warpAtBorders(radius > 0 ? ontoBorderMoves(mSource, mNumber) : BorderMoves{}, radius, places);
        for (std::size_t p = 0; p < own.size(); ++p) place(own[p], mNode[p], mPart.border.places[p]);
        mPart.border.places = {};
        measureBend();
        return std::move(mPart);
    }

private:
    std::optional<ChartPlace> baseAt(const Vec3d& place) const {
        const Vec2f at = mPatch.onDisk({place.x, place.y});
        return mBase.at(double(at.x), double(at.y));
    }

    // The points whose node is the patch's; sets mNode.
    std::vector<std::uint32_t> ownPoints() {
        const OntoArrangement& a = mSource.arrangement;
        const double reach = mPatch.radius + a.step;
        std::vector<std::uint32_t> own;
        for (std::uint32_t p = 0; p < mSource.exemplar.points.size(); ++p) {
            const Vec3f& point = mSource.exemplar.points[p];
            const double dx = double(point.x) - mPatch.from.x, dy = double(point.y) - mPatch.from.y;
            if (dx * dx + dy * dy > reach * reach) continue;
            const Vec2f at = mPatch.onDisk({double(point.x), double(point.y)});
            const auto base = mBase.at(double(at.x), double(at.y));
            if (!base) continue;
            const std::ptrdiff_t member =
                mBase.nearestMember(mSource.surface.sites, mPatch.disk, at, base->point);
            if (member < 0) continue;
            const int k = std::clamp(int(std::floor(double(point.z) / a.step)), 0, a.nz - 1);
            const std::size_t node =
                std::size_t(mPatch.disk.site[std::size_t(member)]) * std::size_t(a.nz) + std::size_t(k);
            if (a.label[node] != mNumber) continue;
            own.push_back(p);
            mNode.push_back(node);
        }
        return own;
    }

    void place(std::uint32_t point, std::size_t node, const WarpedPlace& warped) {
        const auto base = baseAt(warped.place);
        if (!base) return;
        const double h = warped.place.z - mSource.zero;
        // Along the disk's axes, then along the exemplar's.
        const Vec3d x = base->alongPoint[0] + base->alongNormal[0] * h,
                    y = base->alongPoint[1] + base->alongNormal[1] * h;
        const double c = double(mPatch.turn.x), s = double(mPatch.turn.y);
        const std::array<Vec3d, 3> bent{x * c - y * s, x * s + y * c, base->normal};
        if (!(determinant(bent) > 0)) {
            ++mPart.dropped;
            return;
        }
        const Vec3d normal = warpedNormal(warped.jacobian, cast<double>(mSource.exemplar.normals[point]));
        mPart.points.points.push_back(cast<float>(base->point + base->normal * h));
        mPart.points.normals.push_back(cast<float>(warpedNormal(bent, normal)));
        mPart.points.source.push_back(point);
        mPart.points.patch.push_back(mNumber);
        mPart.node.push_back(node);
    }

    void measureBend() {
        const OntoArrangement& a = mSource.arrangement;
        for (std::size_t m = 0; m < mPatch.disk.size(); ++m) {
            if (a.column(mPatch.disk.site[m])[a.nz / 2] != mNumber) continue;
            const auto base = mBase.at(double(mPatch.disk.at[m].x), double(mPatch.disk.at[m].y));
            if (!base) {
                ++mPart.bare;
                continue;
            }
            double bend = 0;
            for (const double curvature : base->curvatures())
                for (const double h : {mHeights.low, mHeights.high}) bend = std::max(bend, -h * curvature);
            mPart.bend.push_back(float(bend));
        }
    }

    const OntoSource& mSource;
    const Heights& mHeights;
    const std::int32_t mNumber;
    const OntoPatch& mPatch;
    const ChartSurface mBase;
    std::vector<std::size_t> mNode;  // [own points]
    OntoPart mPart;
};

void append(SheetPoints& all, const SheetPoints& part) {
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.source.insert(all.source.end(), part.source.begin(), part.source.end());
    all.patch.insert(all.patch.end(), part.patch.begin(), part.patch.end());
}

OntoBend bendOf(const std::vector<OntoPart>& parts) {
    constexpr double kCounted = 0.99;
    OntoBend result;
    std::vector<float> all;
    for (const OntoPart& part : parts) {
        all.insert(all.end(), part.bend.begin(), part.bend.end());
        result.bare += part.bare;
        result.dropped += part.dropped;
    }
    if (all.empty()) return result;
    std::sort(all.begin(), all.end());
    result.most = double(all[std::size_t(kCounted * double(all.size() - 1))]);
    const auto folded = all.end() - std::lower_bound(all.begin(), all.end(), 1.f);
    result.folded = double(folded) / double(all.size());
    return result;
}

OntoPointsResult joined(std::vector<OntoPart>& parts, double spacing, std::vector<std::size_t>& node) {
    OntoPointsResult result;
    result.bend = bendOf(parts);
    std::size_t centres = 0;
    for (OntoPart& part : parts) {
        append(result.sheet, part.points);
        node.insert(node.end(), part.node.begin(), part.node.end());
        result.borders.warps += part.border.warped ? 1 : 0;
        result.borders.shrunk += part.border.shrunk ? 1 : 0;
        result.borders.apartBefore += part.border.before;
        result.borders.apartAfter += part.border.after;
        centres += part.border.centres;
        part = {};
    }
    if (centres > 0) {
        result.borders.apartBefore /= double(centres) * spacing;
        result.borders.apartAfter /= double(centres) * spacing;
    }
    result.sheet.blended.assign(result.sheet.size(), 0);
    return result;
}

void requireOptions(const SheetOptions& options) {
    if (!(options.reach >= 0 && options.reach <= 64))
        throw Error(ErrorCode::InvalidOption, "a warp's reach must be 0..64 steps");
    if (!(options.limit >= 0.1 && options.limit <= 8))
        throw Error(ErrorCode::InvalidOption, "the limit of a warp must be 0.1..8 steps");
}

}  // namespace

OntoPointsResult ontoPoints(const PatchExemplar& exemplar, const PointSetSurface& exemplarSurface,
                            const PatchField& field, const OntoSurface& surface,
                            const OntoArrangement& arrangement, double zero, const SheetOptions& options,
                            const RunContext& ctx) {
    requireOptions(options);
    const OntoSource source{exemplar, exemplarSurface, field, surface, arrangement, zero, options};
    const Heights heights = heightsOf(exemplar, zero);
    std::vector<OntoPart> parts(arrangement.patches.size());
    constexpr std::size_t kAtOnce = 16;
    Stage stage(ctx, "bending patches", parts.size());
    for (std::size_t first = 0; first < parts.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, parts.size() - first);
        parallelFor(ctx, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n)
                parts[first + n] = PartMaker(source, heights, std::int32_t(first + n)).make();
        });
        stage.advance(count);
    }
    std::vector<std::size_t> node;
    OntoPointsResult result = joined(parts, exemplar.spacing, node);
    if (!options.blend) return result;
    const BlendOptions blend{exemplar.kernel, exemplar.spacing, arrangement.step, options.even};
    const std::vector<std::uint8_t> distance = ontoBorderDistance(source, blendSupport(blend) + 1, ctx);
    std::vector<std::uint8_t> ring;
    for (const std::size_t n : node) ring.push_back(distance[n]);
    blendNearBorders(ring, blend, result.sheet, ctx);
    return result;
}

}  // namespace vdbsynth
