#include "libvdbsynth/measure/patch_distribution.h"

#include "libvdbsynth/grid/occupancy.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr int kSamples = kPatchSide * kPatchSide * kPatchSide;
constexpr int kMiddle = kPatchSide / 4, kMiddleSide = kPatchSide / 2;
constexpr std::size_t kDirections = 128;
constexpr std::uint32_t kLotPurpose = 0x4c4f54, kDirectionPurpose = 0x535744;

using Patch = std::array<float, kSamples>;

void readPatch(const BrickField& field, const Index3& corner, Patch& patch) {
    field.readBox(corner, {kPatchSide, kPatchSide, kPatchSide}, patch.data());
}

// `count` of the elements sampled at random (the first steps of a shuffle), in the order
// drawn; all if there are fewer.
template <typename T>
std::vector<T> drawn(std::vector<T> all, std::size_t count, std::uint64_t seed, std::uint32_t purpose) {
    if (all.size() <= count) return all;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(seed, i, purpose);
        std::swap(all[i], all[i + random.below(std::uint32_t(all.size() - i))]);
    }
    all.resize(count);
    return all;
}

// One word for each 64 corners of a row along z: a bit is set if the patch's middle has both signs.
std::vector<std::uint64_t> mixedMiddles(const Occupancy& solid, int x, int y) {
    const std::size_t words = solid.rowWords();
    std::vector<std::uint64_t> any(words + 1, 0), all(words + 1, ~std::uint64_t(0)), mixed(words);
    for (int dx = 0; dx < kMiddleSide; ++dx)
        for (int dy = 0; dy < kMiddleSide; ++dy) {
            const std::uint64_t* row = solid.row(x + kMiddle + dx, y + kMiddle + dy);
            for (std::size_t w = 0; w < words; ++w) {
                any[w] |= row[w];
                all[w] &= row[w];
            }
        }
    for (std::size_t w = 0; w < words; ++w) {
        std::uint64_t some = 0, every = ~std::uint64_t(0);
        for (int dz = kMiddle; dz < kMiddle + kMiddleSide; ++dz) {
            some |= any[w] >> dz | any[w + 1] << (64 - dz);
            every &= all[w] >> dz | all[w + 1] << (64 - dz);
        }
        mixed[w] = some & ~every;
    }
    return mixed;
}

std::vector<Index3> placesIn(const BrickField& field, const IndexBox& box, const RunContext& ctx) {
    const Index3 last = box.max - Index3{kPatchSide - 1, kPatchSide - 1, kPatchSide - 1};
    if (last.x < box.min.x || last.y < box.min.y || last.z < box.min.z) return {};
    const Occupancy solid = Occupancy::fromField(field, ctx);
    const std::size_t planes = std::size_t(last.x - box.min.x) + 1;
    std::vector<std::vector<Index3>> found(planes);
    parallelFor(ctx, planes, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t plane = begin; plane < end; ++plane) {
            const int x = box.min.x + int(plane);
            for (int y = box.min.y; y <= last.y; ++y) {
                const std::vector<std::uint64_t> mixed = mixedMiddles(solid, x, y);
                for (int z = box.min.z; z <= last.z; ++z)
                    if (mixed[std::size_t(z) >> 6] >> (z & 63) & 1) found[plane].push_back({x, y, z});
            }
        }
    });
    std::vector<Index3> places;
    for (const std::vector<Index3>& plane : found) places.insert(places.end(), plane.begin(), plane.end());
    return places;
}

// Data of a patch that bound its cost: means over its 8 octants and its 64 cells of 2^3, and the norm of the
// residual after each level's means are subtracted. Squared differences of means, times their samples, plus
// that of the norms, are at most the patches' difference.
struct Summary {
    std::array<float, 8> octants{};
    std::array<float, 64> cells{};
    float beyondOctants = 0, beyondCells = 0;
};

Summary summaryOf(const Patch& patch) {
    Summary summary;
    std::size_t i = 0;
    double energy = 0;
    for (std::size_t x = 0; x < kPatchSide; ++x)
        for (std::size_t y = 0; y < kPatchSide; ++y)
            for (std::size_t z = 0; z < kPatchSide; ++z, ++i) {
                summary.cells[((x >> 1) * 4 + (y >> 1)) * 4 + (z >> 1)] += patch[i] / 8;
                energy += double(patch[i]) * double(patch[i]);
            }
    double inCells = 0, inOctants = 0;
    for (std::size_t c = 0; c < 64; ++c) {
        summary.octants[(c >> 5) * 4 + (c >> 3 & 1) * 2 + (c >> 1 & 1)] += summary.cells[c] / 8;
        inCells += 8 * double(summary.cells[c]) * double(summary.cells[c]);
    }
    for (float mean : summary.octants) inOctants += 64 * double(mean) * double(mean);
    summary.beyondCells = float(std::sqrt(std::max(0.0, energy - inCells)));
    summary.beyondOctants = float(std::sqrt(std::max(0.0, energy - inOctants)));
    return summary;
}

double costOf(const Patch& a, const Patch& b) {
    // Four sums in parallel, in a fixed order.
    std::array<float, 4> sums{};
    for (std::size_t i = 0; i < kSamples; i += 4)
        for (std::size_t k = 0; k < 4; ++k) sums[k] += (a[i + k] - b[i + k]) * (a[i + k] - b[i + k]);
    return (double(sums[0]) + double(sums[1]) + double(sums[2]) + double(sums[3])) / kSamples;
}

struct Match {
    Index3 place;
    double cost = std::numeric_limits<double>::infinity();
};

constexpr float kMargin = 0.9999f;  // bounds are rounded; this keeps them below

// Summaries of all positions; the coarse level by component first, so that many
// positions are bounded in parallel.
struct SummaryTable {
    std::array<std::vector<float>, 8> octants;
    std::vector<float> beyondOctants;
    std::vector<Summary> all;
};

void boundAll(const Summary& mine, const SummaryTable& table, std::vector<float>& bounds) {
    std::fill(bounds.begin(), bounds.end(), 0.f);
    for (std::size_t k = 0; k < 8; ++k) {
        const float* means = table.octants[k].data();
        for (std::size_t i = 0; i < bounds.size(); ++i)
            bounds[i] += (mine.octants[k] - means[i]) * (mine.octants[k] - means[i]);
    }
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const float rest = mine.beyondOctants - table.beyondOctants[i];
        bounds[i] = (bounds[i] * (kSamples / 8) + rest * rest) * (kMargin / kSamples);
    }
}

float closerBound(const Summary& mine, const Summary& other) {
    std::array<float, 4> sums{};
    for (std::size_t i = 0; i < 64; i += 4)
        for (std::size_t k = 0; k < 4; ++k)
            sums[k] += (mine.cells[i + k] - other.cells[i + k]) * (mine.cells[i + k] - other.cells[i + k]);
    const float rest = mine.beyondCells - other.beyondCells;
    return ((sums[0] + sums[1] + sums[2] + sums[3]) * (kSamples / 64) + rest * rest) * (kMargin / kSamples);
}

// The cheapest of the positions that cost less than `limit`: the one with the least bound first, then all
// whose bound is below its cost, in the order of their bounds.
Match cheapest(const Patch& query, const PatchScale& to, const SummaryTable& table, double limit,
               std::vector<float>& bounds) {
    const Summary mine = summaryOf(query);
    boundAll(mine, table, bounds);
    Match best;
    best.cost = limit;
    Patch patch;
    const auto look = [&](std::size_t i) {
        if (double(closerBound(mine, table.all[i])) > best.cost) return;
        readPatch(*to.field, to.places[i], patch);
        const double cost = costOf(query, patch);
        if (cost < best.cost || (cost == best.cost && to.places[i] < best.place)) best = {to.places[i], cost};
    };
    const auto first = std::min_element(bounds.begin(), bounds.end());
    if (double(*first) >= limit) return best;
    look(std::size_t(first - bounds.begin()));
    std::vector<std::pair<float, std::uint32_t>> left;
    for (std::size_t i = 0; i < bounds.size(); ++i)
        if (double(bounds[i]) <= best.cost) left.emplace_back(bounds[i], std::uint32_t(i));
    std::sort(left.begin(), left.end());
    for (const auto& [bound, i] : left) {
        if (double(bound) > best.cost) break;
        look(i);
    }
    return best;
}

// Moves to the cheapest neighbouring corner while that is cheaper.
Match downhill(const Patch& query, const BrickField& field, Match best) {
    const Index3 last = field.box().max - Index3{kPatchSide - 1, kPatchSide - 1, kPatchSide - 1};
    Patch patch;
    for (bool moved = true; moved && best.cost > 0;) {
        moved = false;
        const Index3 centre = best.place;
        for (const Index3& step : kAllNeighbours) {
            const Index3 p = centre + step;
            if (!IndexBox{field.box().min, last}.contains(p)) continue;
            readPatch(field, p, patch);
            const double cost = costOf(query, patch);
            if (cost < best.cost) {
                best = {p, cost};
                moved = true;
            }
        }
    }
    return best;
}

// The area between two sorted samples' quantile functions.
double quantileDistance(const std::vector<float>& a, const std::vector<float>& b) {
    double area = 0, at = 0;
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
        const double nextA = double(i + 1) / double(a.size()), nextB = double(k + 1) / double(b.size());
        const double next = std::min(nextA, nextB);
        area += (next - at) * std::abs(double(a[i]) - double(b[k]));
        at = next;
        if (nextA <= next) ++i;
        if (nextB <= next) ++k;
    }
    return area;
}

float along(const Patch& patch, const Patch& direction) {
    std::array<float, 4> sums{};
    for (std::size_t i = 0; i < kSamples; i += 4)
        for (std::size_t k = 0; k < 4; ++k) sums[k] += patch[i + k] * direction[i + k];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

Patch directionNumber(std::size_t d, std::uint64_t seed) {
    Random random(seed, d, kDirectionPurpose);
    Patch direction;
    double squared = 0;
    for (float& component : direction) {
        component = float(random.normal());
        squared += double(component) * double(component);
    }
    for (float& component : direction) component /= float(std::sqrt(squared));
    return direction;
}

}  // namespace

PatchSource patchSource(std::shared_ptr<const BrickField> field, const PatchSourceOptions& options,
                        const RunContext& ctx) {
    PatchSource source;
    IndexBox box = options.box;
    for (int scale = 0; scale < options.scales; ++scale) {
        if (scale > 0) {
            field = std::make_shared<const BrickField>(halved(*field, ctx));
            // Only coarse samples whose voxels are all inside.
            box = {{(box.min.x + 1) >> 1, (box.min.y + 1) >> 1, (box.min.z + 1) >> 1},
                   {(box.max.x - 1) >> 1, (box.max.y - 1) >> 1, (box.max.z - 1) >> 1}};
        }
        std::vector<Index3> places = placesIn(*field, box, ctx);
        if (places.empty()) break;
        source.scales.push_back(
            {field, drawn(std::move(places), scale == 0 ? options.limit : options.limit / 3, ctx.seed,
                          kLotPurpose)});
    }
    return source;
}

Projections project(const PatchScale& scale, std::size_t count, const RunContext& ctx) {
    Projections result;
    result.places = drawn(scale.places, count, ctx.seed, kLotPurpose + 1);
    std::vector<Patch> patches(result.places.size());
    parallelFor(ctx, patches.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) readPatch(*scale.field, result.places[i], patches[i]);
    });
    result.values.resize(kDirections);
    parallelFor(ctx, kDirections, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t d = begin; d < end; ++d) {
            const Patch direction = directionNumber(d, ctx.seed);
            for (const Patch& patch : patches) result.values[d].push_back(along(patch, direction));
        }
    });
    return result;
}

Projections within(const Projections& all, const IndexBox& box, int scale, bool inside) {
    std::vector<std::size_t> kept;
    const int side = kPatchSide << scale;
    for (std::size_t i = 0; i < all.places.size(); ++i) {
        const IndexBox patch = IndexBox::cube(all.places[i] * (1 << scale), side);
        if (box.contains(patch) == inside) kept.push_back(i);
    }
    Projections result;
    for (std::size_t i : kept) result.places.push_back(all.places[i]);
    for (const std::vector<float>& values : all.values) {
        result.values.emplace_back();
        for (std::size_t i : kept) result.values.back().push_back(values[i]);
    }
    return result;
}

double slicedWasserstein(const Projections& a, const Projections& b, const RunContext& ctx) {
    if (a.places.empty() || b.places.empty()) return 0;
    std::vector<double> distances(a.values.size());
    parallelFor(ctx, distances.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t d = begin; d < end; ++d) {
            std::vector<float> ofA = a.values[d], ofB = b.values[d];
            std::sort(ofA.begin(), ofA.end());
            std::sort(ofB.begin(), ofB.end());
            distances[d] = quantileDistance(ofA, ofB);
        }
    });
    double sum = 0;
    for (double distance : distances) sum += distance;
    return sum / double(kDirections);
}

PatchMatches matchPatches(const PatchScale& from, const PatchScale& to, std::size_t count, double limit,
                          const RunContext& ctx) {
    SummaryTable table;
    for (std::vector<float>& means : table.octants) means.resize(to.places.size());
    table.beyondOctants.resize(to.places.size());
    table.all.resize(to.places.size());
    parallelFor(ctx, to.places.size(), 1024, [&](std::size_t begin, std::size_t end) {
        Patch patch;
        for (std::size_t i = begin; i < end; ++i) {
            readPatch(*to.field, to.places[i], patch);
            table.all[i] = summaryOf(patch);
            for (std::size_t k = 0; k < 8; ++k) table.octants[k][i] = table.all[i].octants[k];
            table.beyondOctants[i] = table.all[i].beyondOctants;
        }
    });
    PatchMatches result;
    result.from = drawn(from.places, count, ctx.seed, kLotPurpose + 2);
    result.to.resize(result.from.size());
    result.costs.resize(result.from.size());
    parallelFor(ctx, result.from.size(), 8, [&](std::size_t begin, std::size_t end) {
        Patch query;
        std::vector<float> bounds(to.places.size());
        for (std::size_t i = begin; i < end; ++i) {
            readPatch(*from.field, result.from[i], query);
            Match best = cheapest(query, to, table, limit, bounds);
            if (best.cost < limit) best = downhill(query, *to.field, best);
            result.to[i] = best.place;
            result.costs[i] = best.cost;
        }
    });
    for (double cost : result.costs) result.mean += cost;
    result.mean /= double(std::max<std::size_t>(1, result.costs.size()));
    return result;
}

double patchCost(const BrickField& a, const Index3& cornerA, const BrickField& b, const Index3& cornerB) {
    Patch ofA, ofB;
    readPatch(a, cornerA, ofA);
    readPatch(b, cornerB, ofB);
    return costOf(ofA, ofB);
}

}  // namespace vdbsynth
