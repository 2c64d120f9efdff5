#include "libvdbsynth/measure/novelty.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/measure/patch_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr int kStride = 4;
constexpr std::size_t kPatches = 6000;
constexpr std::size_t kPlaces = 60000;
constexpr double kNearCost = 0.25;         // [voxels^2] below this, a descent may reach a copy
constexpr double kCopyCost = 0.25 * 0.25;  // [voxels^2]

bool earlier(const SourcedVoxel& a, const SourcedVoxel& b) {
    return a.place < b.place;
}

Vec3f gradientAt(const BrickField& field, const Index3& p) {
    Vec3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Index3 low = p, high = p;
        --low[axis];
        ++high[axis];
        gradient[axis] = (field.at(high) - field.at(low)) / 2;
    }
    return gradient;
}

struct Jumps {
    double sum = 0;
    std::size_t count = 0;
    double mean() const { return count ? sum / double(count) : 0; }
};

void summarizeRuns(DisjointSets& runs, std::size_t count, std::size_t looked, Novelty& novelty) {
    std::vector<std::size_t> sizes(count, 0);
    for (std::size_t i = 0; i < count; ++i) ++sizes[runs.root(std::uint32_t(i))];
    double inRuns = 0, number = 0;
    for (std::size_t size : sizes) {
        if (size < 2) continue;
        inRuns += double(size);
        number += 1;
        novelty.largestRun = std::max(novelty.largestRun, double(size));
    }
    novelty.verbatimShare = looked > 0 ? inRuns / double(looked) : 0;
    novelty.meanRun = number > 0 ? inRuns / number : 0;
}

void measureUse(const std::vector<SourcedVoxel>& voxels, const BrickField& exemplar, const IndexBox& box,
                Novelty& novelty, const RunContext& ctx) {
    std::vector<Index3> sources;
    for (const SourcedVoxel& v : voxels)
        if (box.contains(v.source) && std::abs(exemplar.inside(v.source)) < kNearSurface)
            sources.push_back(v.source);
    std::sort(sources.begin(), sources.end());
    const auto different = std::unique(sources.begin(), sources.end()) - sources.begin();
    const std::size_t all = countNearSurface(exemplar, box, kNearSurface, ctx);
    if (all == 0) return;
    novelty.exemplarUsed = double(different) / double(all);
    novelty.largestShare = novelty.largestRun / double(all);
}

int chebyshev(const Index3& a, const Index3& b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

// Keeps at most about kPatches of the positions, those nearest to the one nearest to the common middle.
void keepCompact(std::vector<Index3>& places) {
    if (places.size() <= kPatches) return;
    Vec3d sum{0, 0, 0};
    for (const Index3& p : places) sum = sum + Vec3d{double(p.x), double(p.y), double(p.z)};
    const Vec3d mean = sum * (1 / double(places.size()));
    const Index3 middle{int(std::lround(mean.x)), int(std::lround(mean.y)), int(std::lround(mean.z))};
    const Index3 centre = *std::min_element(
        places.begin(), places.end(),
        [&](const Index3& a, const Index3& b) { return chebyshev(a, middle) < chebyshev(b, middle); });
    std::vector<int> distances;
    for (const Index3& p : places) distances.push_back(chebyshev(p, centre));
    std::nth_element(distances.begin(), distances.begin() + std::ptrdiff_t(kPatches), distances.end());
    const int reach = distances[kPatches];
    places.erase(std::remove_if(places.begin(), places.end(),
                                [&](const Index3& p) { return chebyshev(p, centre) >= reach; }),
                 places.end());
}

// The box covered by the patches at these positions.
IndexBox boxOf(const std::vector<Index3>& places) {
    if (places.empty()) return {};
    IndexBox box{places.front(), places.front()};
    for (const Index3& p : places)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], p[axis]);
            box.max[axis] = std::max(box.max[axis], p[axis] + kPatchSide - 1);
        }
    return box;
}

// If continuing a neighbour's source gives a copy here too, that is the source: a repeating texture has many
// equal positions, and runs should not end without need.
void followNeighbours(const PatchScale& of, const PatchScale& in, PatchMatches& matches) {
    std::map<Index3, std::size_t> numbers;
    for (std::size_t i = 0; i < matches.from.size(); ++i) numbers[matches.from[i]] = i;
    const IndexBox places{in.field->box().min,
                          in.field->box().max - Index3{kPatchSide - 1, kPatchSide - 1, kPatchSide - 1}};
    const auto follow = [&](std::size_t i, int direction) {
        for (int axis = 0; axis < 3; ++axis) {
            Index3 step{0, 0, 0};
            step[axis] = direction * kStride;
            const auto neighbour = numbers.find(matches.from[i] - step);
            if (neighbour == numbers.end() || matches.costs[neighbour->second] >= kCopyCost) continue;
            const Index3 place = matches.to[neighbour->second] + step;
            if (place == matches.to[i]) return;
            if (!places.contains(place)) continue;
            const double cost = patchCost(*of.field, matches.from[i], *in.field, place);
            if (cost >= kCopyCost) continue;
            matches.to[i] = place;
            matches.costs[i] = cost;
            return;
        }
    };
    for (const auto& [place, i] : numbers) follow(i, 1);
    for (auto it = numbers.rbegin(); it != numbers.rend(); ++it) follow(it->second, -1);
}

}  // namespace

Novelty measureNovelty(std::vector<SourcedVoxel> voxels, std::size_t looked, const BrickField& result,
                       const BrickField& exemplar, const IndexBox& exemplarBox, const RunContext& ctx) {
    Novelty novelty;
    novelty.voxels = voxels.size();
    if (voxels.empty()) return novelty;
    std::sort(voxels.begin(), voxels.end(), earlier);
    DisjointSets runs(voxels.size());
    std::vector<Vec3f> gradients(voxels.size());
    for (std::size_t i = 0; i < voxels.size(); ++i) gradients[i] = gradientAt(result, voxels[i].place);
    Jumps seams, inner;
    for (int axis = 0; axis < 3; ++axis) {
        // Neighbours of sorted positions are sorted too, so one pass finds them all.
        std::size_t next = 0;
        for (std::size_t i = 0; i < voxels.size(); ++i) {
            SourcedVoxel neighbour;
            neighbour.place = voxels[i].place;
            ++neighbour.place[axis];
            while (next < voxels.size() && earlier(voxels[next], neighbour)) ++next;
            if (next == voxels.size()) break;
            if (voxels[next].place != neighbour.place) continue;
            Index3 expected = voxels[i].source;
            ++expected[axis];
            const bool together =
                voxels[next].source == expected && voxels[next].exemplar == voxels[i].exemplar;
            Jumps& jumps = together ? inner : seams;
            jumps.sum += double(length(gradients[i] - gradients[next]));
            ++jumps.count;
            if (together) runs.join(std::uint32_t(i), std::uint32_t(next));
        }
    }
    summarizeRuns(runs, voxels.size(), looked, novelty);
    measureUse(voxels, exemplar, exemplarBox, novelty, ctx);
    if (inner.count > 0 && seams.count > 0 && inner.sum > 0) novelty.seamRatio = seams.mean() / inner.mean();
    if (inner.count + seams.count > 0)
        novelty.seamShare = double(seams.count) / double(inner.count + seams.count);
    return novelty;
}

double verifiedShare(const std::vector<SourcedVoxel>& voxels, const BrickField& result,
                     const BrickField& exemplar) {
    std::size_t good = 0;
    for (const SourcedVoxel& v : voxels)
        if (exemplar.box().contains(v.source) &&
            std::abs(result.at(v.place) - exemplar.inside(v.source)) < 0.25f)
            ++good;
    return voxels.empty() ? 0 : double(good) / double(voxels.size());
}

std::size_t countNearSurface(const BrickField& field, const IndexBox& box, float reach,
                             const RunContext& ctx) {
    if (box.empty()) return 0;
    std::vector<std::size_t> counts(std::size_t(box.size().x), 0);
    parallelFor(ctx, counts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t plane = begin; plane < end; ++plane)
            for (int y = box.min.y; y <= box.max.y; ++y)
                for (int z = box.min.z; z <= box.max.z; ++z)
                    counts[plane] += std::abs(field.inside({box.min.x + int(plane), y, z})) < reach;
    });
    return std::accumulate(counts.begin(), counts.end(), std::size_t(0));
}

MatchedSources sourcesByMatching(std::shared_ptr<const BrickField> result, const IndexBox& box,
                                 std::shared_ptr<const BrickField> exemplar, const IndexBox& exemplarBox,
                                 const RunContext& ctx) {
    MatchedSources found;
    PatchSourceOptions everywhere;
    everywhere.box = box;
    everywhere.limit = ~std::size_t(0);
    everywhere.scales = 1;
    PatchSource of = patchSource(result, everywhere, ctx);
    PatchSourceOptions drawn;
    drawn.box = exemplarBox;
    drawn.scales = 1;
    drawn.limit = kPlaces;
    const PatchSource in = patchSource(exemplar, drawn, ctx);
    if (of.scales.empty() || in.scales.empty()) return found;
    PatchScale& queries = of.scales.front();
    const auto offLattice = [](const Index3& p) { return p.x % kStride || p.y % kStride || p.z % kStride; };
    queries.places.erase(std::remove_if(queries.places.begin(), queries.places.end(), offLattice),
                         queries.places.end());
    keepCompact(queries.places);
    found.box = boxOf(queries.places);
    PatchMatches matches = matchPatches(queries, in.scales.front(), queries.places.size(), kNearCost, ctx);
    followNeighbours(queries, in.scales.front(), matches);
    const int margin = (kPatchSide - kStride) / 2;
    for (std::size_t i = 0; i < matches.from.size(); ++i)
        forEachVoxel(IndexBox::cube({margin, margin, margin}, kStride), [&](const Index3& at) {
            const Index3 place = matches.from[i] + at;
            if (std::abs(result->inside(place)) >= kNearSurface) return;
            ++found.looked;
            if (matches.costs[i] < kCopyCost) found.voxels.push_back({place, matches.to[i] + at, 0});
        });
    return found;
}

}  // namespace vdbsynth
