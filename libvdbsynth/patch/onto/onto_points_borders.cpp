#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/patch/onto/onto_points_steps.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kSameWay = 0.5;     // cosine between normals of both sides
constexpr double kNearBorder = 1.2;  // [steps] from a border's node to a centre
constexpr float kNear = 1.5f;        // [steps] from a surface, of nodes that have a foot

Vec3d turnedBy(const Vec3d& v, const Vec2f& turn) {
    const double c = double(turn.x), s = double(turn.y);
    return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

class BorderReader {
public:
    BorderReader(const OntoSource& source, std::int32_t number)
        : mSource(source),
          mArrangement(source.arrangement),
          mNumber(number),
          mPatch(mArrangement.patches[std::size_t(number)]) {}

    BorderMoves read() {
        for (std::size_t m = 0; m < mPatch.disk.size(); ++m) readColumn(m);
        return spreadMoves(mFound, mArrangement.step);
    }

private:
    void readColumn(std::size_t m) {
        const SurfaceSites& sites = mSource.surface.sites;
        const std::uint32_t site = mPatch.disk.site[m];
        const std::int32_t* here = mArrangement.column(site);
        std::vector<std::int32_t> seen;
        for (int k = 0; k < mArrangement.nz; ++k) {
            if (here[k] != mNumber) continue;
            seen.clear();
            const auto note = [&](std::int32_t other) {
                if (other != mNumber && other != OntoArrangement::kNone &&
                    std::find(seen.begin(), seen.end(), other) == seen.end())
                    seen.push_back(other);
            };
            for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n)
                note(mArrangement.column(sites.neighbours[n])[k]);
            if (k > 0) note(here[k - 1]);
            if (k + 1 < mArrangement.nz) note(here[k + 1]);
            for (const std::int32_t other : seen) addPair(m, k, other);
        }
    }

    // From the foot of a border's node on this side to the other side's surface.
    void addPair(std::size_t m, int k, std::int32_t number) {
        const double step = mArrangement.step;
        const PlanePlace own = mPatch.inExemplar(mPatch.disk.at[m]);
        const OntoPatch& other = mArrangement.patches[std::size_t(number)];
        const std::ptrdiff_t there = other.disk.find(mPatch.disk.site[m]);
        if (there < 0 || std::abs(readDistance(mSource.field, own, k)) > kNear) return;
        const Vec3d node{own.x, own.y, (k + 0.5) * step};
        const auto here = mSource.exemplarSurface.project(node);
        if (!here || length(here->point - node) > kNearBorder * step) return;
        const Vec2f turn = turnBetween(mPatch.disk, std::ptrdiff_t(m), other.disk, there);
        const Vec2f at = other.disk.at[std::size_t(there)] +
                         rotated(mPatch.onDisk({here->point.x, here->point.y}) - mPatch.disk.at[m], turn);
        const PlanePlace theirs = other.inExemplar(at);
        const Vec3d across{theirs.x, theirs.y, here->point.z};
        // From this patch's exemplar axes to the other's.
        const Vec2f whole = rotated(rotated(turn, other.turn), {mPatch.turn.x, -mPatch.turn.y});
        const Vec3d facing = turnedBy(here->normal, whole);
        const auto foot = mSource.exemplarSurface.project(across, facing);
        if (!foot || dot(foot->normal, facing) < kSameWay) return;
        const Vec3d move = turnedBy(foot->point - across, {whole.x, -whole.y});
        if (length(move) > mSource.options.limit * step) return;
        mFound.centres.push_back(here->point);
        mFound.moves.push_back(move * 0.5);
    }

    const OntoSource& mSource;
    const OntoArrangement& mArrangement;
    const std::int32_t mNumber;
    const OntoPatch& mPatch;
    BorderMoves mFound;
};

}  // namespace

BorderMoves ontoBorderMoves(const OntoSource& source, std::int32_t patch) {
    return BorderReader(source, patch).read();
}

std::vector<std::uint8_t> ontoBorderDistance(const OntoSource& source, int most, const RunContext& ctx) {
    const SurfaceSites& sites = source.surface.sites;
    const OntoArrangement& a = source.arrangement;
    const std::size_t nz = std::size_t(a.nz);
    std::vector<std::uint8_t> distance(a.label.size(), std::uint8_t(most));
    // Over the columns beside one and its own, and the three nodes around one.
    const auto around = [&](std::uint32_t site, int k, const auto& holds) {
        const auto inColumn = [&](std::uint32_t other) {
            for (int at = std::max(0, k - 1); at <= std::min(a.nz - 1, k + 1); ++at)
                if (holds(std::size_t(other) * nz + std::size_t(at))) return true;
            return false;
        };
        if (inColumn(site)) return true;
        for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n)
            if (inColumn(sites.neighbours[n])) return true;
        return false;
    };
    for (int ring = 0; ring < most; ++ring) {
        const std::vector<std::uint8_t> before = distance;
        parallelFor(ctx, sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t site = begin; site < end; ++site)
                for (int k = 0; k < a.nz; ++k) {
                    const std::size_t node = site * nz + std::size_t(k);
                    if (before[node] != most) continue;
                    const bool holds = around(std::uint32_t(site), k, [&](std::size_t other) {
                        return ring == 0 ? a.label[other] != a.label[node] : before[other] == ring - 1;
                    });
                    if (holds) distance[node] = std::uint8_t(ring);
                }
        });
    }
    return distance;
}

}  // namespace vdbsynth
