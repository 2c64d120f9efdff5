#include "libvdbsynth/patch/patch_candidates.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr double kPerfect = 1e-3;  // of d, for each root of a value
constexpr std::uint32_t kProbe = 0x70726f62;
constexpr int kLanes = 4;

typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef float UnalignedLanes __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

// A column's values are a multiple of four.
float columnDifference(const float* a, const float* b, std::size_t values) {
    Lanes even{}, odd{};
    std::size_t at = 0;
    for (; at + 2 * kLanes <= values; at += 2 * kLanes) {
        const Lanes first = *reinterpret_cast<const UnalignedLanes*>(a + at) -
                            *reinterpret_cast<const UnalignedLanes*>(b + at);
        const Lanes second = *reinterpret_cast<const UnalignedLanes*>(a + at + kLanes) -
                             *reinterpret_cast<const UnalignedLanes*>(b + at + kLanes);
        even += first * first;
        odd += second * second;
    }
    if (at < values) {
        const Lanes last = *reinterpret_cast<const UnalignedLanes*>(a + at) -
                           *reinterpret_cast<const UnalignedLanes*>(b + at);
        even += last * last;
    }
    const Lanes sum = even + odd;
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// What is compared: columns in an order in which those that say most come first.
struct Query {
    std::vector<std::ptrdiff_t> offset;  // [columns] from the place's first column in the exemplar's values
    std::vector<const float*> values;
};

// Columns spread over the overlap first: neighbours say nearly the same.
std::vector<std::size_t> spreadOrder(std::size_t count) {
    std::vector<std::size_t> order;
    order.reserve(count);
    std::size_t stride = 1;
    while (stride * 8 < count) stride *= 2;
    for (std::size_t first = 0; first < stride; ++first) {
        std::size_t reversed = 0;
        for (std::size_t bit = 1; bit < stride; bit *= 2) reversed = 2 * reversed + ((first / bit) & 1);
        for (std::size_t at = reversed; at < count; at += stride) order.push_back(at);
    }
    return order;
}

Query queryOf(const PatchField& exemplar, const PatchOverlap& overlap) {
    const std::size_t length = exemplar.columnLength();
    Query query;
    for (const std::size_t c : spreadOrder(overlap.columns.size())) {
        const auto& column = overlap.columns[c];
        query.offset.push_back(std::ptrdiff_t(exemplar.lattice.column(column.i, column.j) * length));
        query.values.push_back(overlap.values.data() + c * length);
    }
    return query;
}

// In double over columns, so that the sum does not depend on how far others got.
double addDifference(const Query& query, std::size_t begin, std::size_t end, const float* from,
                     std::size_t length, double sum, double limit) {
    for (std::size_t c = begin; c < end && sum <= limit; ++c)
        sum += double(columnDifference(from + query.offset[c], query.values[c], length));
    return sum;
}

bool isExcluded(const PatchPlace& place, const PatchOverlap& overlap, const CandidateOptions& options) {
    if (options.barred && options.barred->any(place.i, place.j, overlap.nx, overlap.ny)) return true;
    return std::any_of(options.excluded.begin(), options.excluded.end(), [&](const PatchPlace& other) {
        return std::abs(place.i - other.i) <= options.exclusion &&
               std::abs(place.j - other.j) <= options.exclusion;
    });
}

double limitOf(double least, double tolerance, std::size_t values) {
    const double d = (1 + tolerance) * std::sqrt(least) + kPerfect * std::sqrt(double(values));
    return d * d;
}

void lower(std::atomic<double>& least, double value) {
    double now = least.load();
    while (value < now && !least.compare_exchange_weak(now, value)) {
    }
}

// The places of an exemplar, compared column by column.
struct Search {
    const PatchField& exemplar;
    const Query& query;
    const PatchOverlap& overlap;
    const CandidateOptions& options;
    std::size_t values;
    int across;

    // The sums over the first columns; infinite for places that are left out.
    std::vector<double> begun(int rows, std::size_t few, const RunContext& ctx) const {
        std::vector<double> partial(std::size_t(rows) * std::size_t(across),
                                    std::numeric_limits<double>::infinity());
        parallelFor(ctx, std::size_t(rows), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (int j = 0; j < across; ++j)
                    if (!isExcluded({int(i), j}, overlap, options))
                        partial[i * std::size_t(across) + std::size_t(j)] =
                            addDifference(query, 0, few, exemplar.column(int(i), j), exemplar.columnLength(),
                                          0, std::numeric_limits<double>::infinity());
        });
        return partial;
    }
    // The whole sum of the place that began best.
    double bound(const std::vector<double>& partial, std::size_t few) const {
        const auto best = std::min_element(partial.begin(), partial.end());
        if (best == partial.end()) return std::numeric_limits<double>::infinity();
        const auto place = int(best - partial.begin());
        return finished(place / across, place % across, few, partial,
                        std::numeric_limits<double>::infinity());
    }
    double finished(int i, int j, std::size_t few, const std::vector<double>& partial, double limit) const {
        const double begun = partial[std::size_t(i) * std::size_t(across) + std::size_t(j)];
        if (!(begun <= limit) || begun == std::numeric_limits<double>::infinity())
            return std::numeric_limits<double>::infinity();
        return addDifference(query, few, query.offset.size(), exemplar.column(i, j), exemplar.columnLength(),
                             begun, limit);
    }
};

}  // namespace

std::vector<PatchCandidate> patchCandidates(const PatchField& exemplar, const PatchOverlap& overlap,
                                            const CandidateOptions& options, const RunContext& ctx) {
    const int rows = exemplar.lattice.nx - overlap.nx + 1, across = exemplar.lattice.ny - overlap.ny + 1;
    if (rows < 1 || across < 1)
        throw Error(ErrorCode::Unusable, "a patch is larger than the exemplar; a smaller `patch` fits");
    const std::size_t length = exemplar.columnLength(), values = overlap.columns.size() * length;
    const Query query = queryOf(exemplar, overlap);
    const Search search{exemplar, query, overlap, options, values, across};
    // The best by a few columns gives a first bound, so that most others are left early.
    const std::size_t few = std::min(query.offset.size(), std::max<std::size_t>(8, query.offset.size() / 16));
    const std::vector<double> partial = search.begun(rows, few, ctx);
    std::atomic<double> least{search.bound(partial, few)};
    std::vector<std::vector<PatchCandidate>> found(static_cast<std::size_t>(rows));
    parallelFor(ctx, std::size_t(rows), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int j = 0; j < across; ++j) {
                const double limit = limitOf(least.load(), options.tolerance, values);
                const double cost = search.finished(int(i), j, few, partial, limit);
                if (!(cost <= limit) || std::isinf(cost)) continue;
                found[i].push_back({{int(i), j}, cost});
                lower(least, cost);
            }
    });
    std::vector<PatchCandidate> candidates;
    const double limit = limitOf(least.load(), options.tolerance, values);
    for (const auto& row : found)
        for (const PatchCandidate& candidate : row)
            if (candidate.cost <= limit) candidates.push_back(candidate);
    return candidates;
}

PatchOverlap ownOverlap(const PatchField& exemplar, const PatchPlace& place, int patchSide, int overlapSide) {
    PatchOverlap overlap;
    overlap.nx = std::min(patchSide, exemplar.lattice.nx);
    overlap.ny = std::min(patchSide, exemplar.lattice.ny);
    for (int i = 0; i < overlap.nx; ++i)
        for (int j = 0; j < overlap.ny; ++j) {
            if (i >= overlapSide && j >= overlapSide) continue;
            overlap.columns.push_back({i, j});
            const float* from = exemplar.column(place.i + i, place.j + j);
            overlap.values.insert(overlap.values.end(), from, from + exemplar.columnLength());
        }
    return overlap;
}

double nearMatchLevel(const PatchField& exemplar, int patchSide, int overlapSide, int probes, int apart,
                      const RunContext& ctx, const BarredColumns* barred) {
    const int rows = std::max(1, exemplar.lattice.nx - patchSide + 1),
              across = std::max(1, exemplar.lattice.ny - patchSide + 1);
    double sum = 0;
    int found = 0;
    for (int probe = 0; probe < probes; ++probe) {
        Random random(ctx.seed, std::uint64_t(probe), kProbe);
        const PatchPlace place{int(random.below(std::uint32_t(rows))),
                               int(random.below(std::uint32_t(across)))};
        const PatchOverlap overlap = ownOverlap(exemplar, place, patchSide, overlapSide);
        if (barred && barred->any(place.i, place.j, overlap.nx, overlap.ny)) continue;
        const auto best = patchCandidates(exemplar, overlap, {0, {place}, apart, barred}, ctx);
        if (best.empty()) continue;
        double least = best.front().cost;
        for (const PatchCandidate& candidate : best) least = std::min(least, candidate.cost);
        sum += least / double(overlap.values.size());
        ++found;
    }
    return found > 0 ? sum / found : std::numeric_limits<double>::infinity();
}

}  // namespace vdbsynth
