#include "libvdbsynth/patch/scanline/pairing_weights.h"

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/patch/patch_candidates.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kProbe = 0x70616972;
constexpr double kSameWay = 0.5;
constexpr std::size_t kAround = 8;

struct Terms {
    double position = 0, normal = 0, variation = 0, length = 0, direction = 0;
    std::size_t pairs = 0, coherent = 0;
};

// The points of a place's overlap, moved so that the place's corner is the origin.
struct Side {
    std::vector<Vec3f> points;
    std::vector<std::uint32_t> number;
};

Side sideAt(const PatchExemplar& exemplar, const PatchPlace& place, double step, int patch, int overlap) {
    Side side;
    const Vec3f corner = cast<float>(Vec3d{place.i * step, place.j * step, 0});
    const float whole = float(patch * step), strip = float(overlap * step);
    for (std::size_t p = 0; p < exemplar.points.size(); ++p) {
        const Vec3f at = exemplar.points[p] - corner;
        if (at.x < 0 || at.y < 0 || at.x >= whole || at.y >= whole || (at.x >= strip && at.y >= strip))
            continue;
        side.points.push_back(at);
        side.number.push_back(std::uint32_t(p));
    }
    return side;
}

struct Pairs {
    std::vector<Vec3f> at;
    std::vector<Vec3d> move;  // [spacings]
};

// Points that are each other's nearest.
Pairs addMutual(const PatchExemplar& exemplar, const std::vector<float>& variation, const Side& a,
                const Side& b, Terms& terms) {
    Pairs pairs;
    if (a.points.empty() || b.points.empty()) return pairs;
    const PointNeighbours inA(a.points), inB(b.points);
    for (std::size_t p = 0; p < a.points.size(); ++p) {
        std::uint32_t there = 0, back = 0;
        float squared = 0;
        inB.nearest(a.points[p], 1, &there, &squared);
        inA.nearest(b.points[there], 1, &back, &squared);
        if (back != p) continue;
        const std::uint32_t s = a.number[p], q = b.number[there];
        const double together = double(dot(exemplar.normals[s], exemplar.normals[q]));
        if (together < kSameWay) continue;
        const Vec3d move = cast<double>(b.points[there] - a.points[p]) * (1 / exemplar.spacing);
        const double varies = double(variation[s] - variation[q]);
        terms.position += dot(move, move);
        terms.normal += (1 - together) / 2;
        terms.variation += varies * varies;
        ++terms.pairs;
        pairs.at.push_back(a.points[p]);
        pairs.move.push_back(move);
    }
    return pairs;
}

// How much pairs differ from those around them.
void addCoherence(const Pairs& pairs, Terms& terms) {
    if (pairs.at.size() <= kAround) return;
    const PointNeighbours neighbours(pairs.at);
    std::uint32_t numbers[kAround];
    float squared[kAround];
    for (std::size_t p = 0; p < pairs.at.size(); ++p) {
        const std::size_t found = neighbours.nearest(pairs.at[p], kAround, numbers, squared);
        double far = 0;
        Vec3d direction;
        for (std::size_t f = 0; f < found; ++f) {
            if (numbers[f] == p) continue;
            far += length(pairs.move[numbers[f]]) / double(kAround - 1);
            direction = direction + pairs.move[numbers[f]];
        }
        const double own = length(pairs.move[p]);
        if (!(own > 0)) continue;
        terms.length += std::abs(own - far);
        terms.direction += (1 - dot(normalized(direction), pairs.move[p]) / own) / 2;
        ++terms.coherent;
    }
}

PatchPlace bestOther(const PatchField& field, const PatchPlace& place, int patch, int overlap,
                     const RunContext& ctx) {
    const auto candidates =
        patchCandidates(field, ownOverlap(field, place, patch, overlap), {0, {place}, overlap}, ctx);
    if (candidates.empty()) return place;
    return std::min_element(candidates.begin(), candidates.end(),
                            [](const PatchCandidate& a, const PatchCandidate& b) { return a.cost < b.cost; })
        ->place;
}

}  // namespace

PairingWeights nearMatchWeights(const PatchExemplar& exemplar, const std::vector<float>& variation,
                                const PatchField& field, int patch, int overlap, int probes,
                                const RunContext& ctx) {
    Terms terms;
    const auto rows = std::uint32_t(field.lattice.nx - patch + 1),
               across = std::uint32_t(field.lattice.ny - patch + 1);
    for (int probe = 0; probe < probes; ++probe) {
        Random random(ctx.seed, std::uint64_t(probe), kProbe);
        const int i = int(random.below(rows));
        const PatchPlace place{i, int(random.below(across))};
        const PatchPlace other = bestOther(field, place, patch, overlap, ctx);
        if (other == place) continue;
        const double step = field.lattice.step;
        addCoherence(addMutual(exemplar, variation, sideAt(exemplar, place, step, patch, overlap),
                               sideAt(exemplar, other, step, patch, overlap), terms),
                     terms);
    }
    if (terms.pairs == 0 || !(terms.position > 0)) return {};
    const double unit = terms.position / double(terms.pairs);
    const auto weight = [&](double sum, std::size_t count) {
        return count > 0 && sum > 0 ? std::min(1e6, unit * double(count) / sum) : 1.0;
    };
    // Terms here are halved as in eq. 2.
    return {1, weight(terms.normal, terms.pairs), weight(terms.variation, terms.pairs),
            weight(terms.length, terms.coherent), weight(terms.direction, terms.coherent)};
}

}  // namespace vdbsynth
