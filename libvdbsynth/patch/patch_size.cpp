#include "libvdbsynth/patch/patch_size.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vdbsynth {
namespace {

constexpr double kOverlap = 1.0 / 3;
constexpr double kRise = 0.1, kUncorrelated = 0.2;
constexpr double kFlat = 1e-12;  // [steps^2] the rounding of a mean

// Distances less the mean of their height.
std::vector<double> centred(const PatchField& field) {
    const PatchLattice& l = field.lattice;
    std::vector<double> mean(std::size_t(l.nz), 0.0), values(l.nodes());
    for (std::size_t c = 0; c < l.columns(); ++c)
        for (std::size_t k = 0; k < std::size_t(l.nz); ++k)
            mean[k] += double(field.values[(c * std::size_t(l.nz) + k) * kFieldValues]) / double(l.columns());
    for (std::size_t c = 0; c < l.columns(); ++c)
        for (std::size_t k = 0; k < std::size_t(l.nz); ++k)
            values[c * std::size_t(l.nz) + k] =
                double(field.values[(c * std::size_t(l.nz) + k) * kFieldValues]) - mean[k];
    return values;
}

double product(const std::vector<double>& values, const PatchLattice& l, int di, int dj) {
    double sum = 0;
    for (int i = 0; i + di < l.nx; ++i)
        for (int j = 0; j + dj < l.ny; ++j) {
            const double* a = values.data() + l.column(i, j) * std::size_t(l.nz);
            const double* b = values.data() + l.column(i + di, j + dj) * std::size_t(l.nz);
            for (int k = 0; k < l.nz; ++k) sum += a[k] * b[k];
        }
    return sum / (double(l.nx - di) * double(l.ny - dj));
}

PatchFeature featureOf(const std::vector<double>& correlation, int side) {
    const std::size_t count = correlation.size();
    std::size_t low = 1;
    while (low + 1 < count && correlation[low + 1] < correlation[low]) ++low;
    std::size_t high = low;
    for (std::size_t l = low; l < count; ++l) {
        if (correlation[l] > correlation[high]) high = l;
        // Past the first maximum that is worth the name.
        if (correlation[high] - correlation[low] > kRise && correlation[l] < correlation[high] - kRise) break;
        if (correlation[l] < correlation[low]) low = high = l;
    }
    if (correlation[high] - correlation[low] > kRise && correlation[high] > kUncorrelated && high + 1 < count)
        return {int(high), true};
    for (std::size_t l = 1; l < count; ++l)
        if (correlation[l] < kUncorrelated) return {int(l), false};
    return {std::max(1, side / 2), false};
}

}  // namespace

PatchFeature patchFeature(const PatchField& exemplar, const RunContext& ctx) {
    const std::vector<double> values = centred(exemplar);
    const PatchLattice& l = exemplar.lattice;
    const double whole = product(values, l, 0, 0);
    if (whole <= kFlat) return {std::max(1, std::min(l.nx, l.ny) / 2), false};
    PatchFeature feature;
    for (const bool alongX : {true, false}) {
        const int side = alongX ? l.nx : l.ny, lags = std::max(2, side * 2 / 3);
        std::vector<double> correlation(static_cast<std::size_t>(lags));
        parallelFor(ctx, correlation.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t lag = begin; lag < end; ++lag)
                correlation[lag] = product(values, l, alongX ? int(lag) : 0, alongX ? 0 : int(lag)) / whole;
        });
        const PatchFeature along = featureOf(correlation, side);
        if (along.columns >= feature.columns) feature = along;
    }
    return feature;
}

int patchSide(const PatchField& exemplar, const PatchFeature& feature) {
    const int shorter = std::min(exemplar.lattice.nx, exemplar.lattice.ny);
    const int least = feature.repeats ? 6 : std::max(6, shorter / 4);
    return std::max(std::min(shorter, 2),
                    std::min(std::max(least, feature.columns * 3 / 2), shorter * 2 / 3));
}

PatchSides patchSides(const PatchField& field, double patch, double overlap, const RunContext& ctx) {
    const PatchLattice& l = field.lattice;
    PatchSides sides;
    if (patch > 0) {
        sides.patch = int(std::lround(patch / l.step));
        if (sides.patch > std::min(l.nx, l.ny))
            throw Error(ErrorCode::Unusable, "`patch` " + roundedText(patch, 4) +
                                                 " is larger than the exemplar, " +
                                                 roundedText(std::min(l.nx, l.ny) * l.step, 4) + " wide");
        if (sides.patch < 4)
            throw Error(ErrorCode::InvalidOption, "`patch` " + roundedText(patch, 4) +
                                                      " is under four steps of the field, " +
                                                      roundedText(4 * l.step, 4));
    } else {
        const PatchFeature feature = patchFeature(field, ctx);
        sides.patch = patchSide(field, feature);
        message(
            ctx, MessageLevel::Detail,
            std::string(feature.repeats ? "the exemplar repeats every " : "the exemplar's features are ") +
                roundedText(feature.columns * l.step, 4) + (feature.repeats ? "" : " wide") +
                "; patches are " + roundedText(sides.patch * l.step, 4) + " wide (world)");
        if (sides.patch < 4)
            throw Error(ErrorCode::Unusable,
                        "the exemplar is only " + roundedText(std::min(l.nx, l.ny) * l.step, 4) +
                            " wide, too small for a patch of four steps of " + roundedText(l.step, 4));
    }
    const double share = overlap > 0 ? overlap : kOverlap;
    sides.overlap = std::clamp(int(std::lround(share * sides.patch)), 2, sides.patch - 1);
    return sides;
}

}  // namespace vdbsynth
