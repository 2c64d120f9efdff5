#include "libvdbsynth/coordinates/coordinate_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/coordinate_charts.h"
#include "libvdbsynth/coordinates/coordinate_level.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/points/site_levels.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kDenser = 0.7;       // sites closer than this [texels] are not corrected
constexpr double kCellOfStep = 1.15;  // side of a cell whose sites are a step apart, on surfaces at any slope
constexpr double kSmallest = 8;       // [steps] along the sample's shorter side on the coarsest level
constexpr std::size_t kFewest = 12;   // sites on the coarsest level

void requireSites(const CoordinateSites& sites, const std::vector<SampleImage>& samples, double texel) {
    const std::size_t n = sites.sites.size();
    if (!(texel > 0)) throw Error(ErrorCode::InvalidOption, "`texel`: is not above 0");
    if (sites.sites.normal.size() != n || sites.tangent.size() != n ||
        (!sites.label.empty() && sites.label.size() != n))
        throw Error(ErrorCode::ShapeMismatch, "points, normals, tangents and labels differ in number");
    if (samples.empty()) throw Error(ErrorCode::EmptyInput, "there is no sample");
    for (const SampleImage& sample : samples) {
        if (sample.texels() == 0 || sample.channels < 1)
            throw Error(ErrorCode::EmptyInput, "a sample has no texels");
        if (!sample.valid.empty() && sample.valid.size() != sample.texels())
            throw Error(ErrorCode::ShapeMismatch, "a sample's mask has another size than the sample");
        if (sample.channels != samples[0].channels)
            throw Error(ErrorCode::ShapeMismatch, "samples differ in the number of channels");
    }
    for (std::int32_t label : sites.label)
        if (label < 0 || std::size_t(label) >= samples.size())
            throw Error(ErrorCode::ShapeMismatch, "label " + std::to_string(label) + " has no sample");
}

// The side of the square that each site has to itself, from the distances to the last of its neighbours.
// [world]
double meanStep(const SurfaceSites& sites) {
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        if (sites.degree(i) == 0) continue;
        const std::uint32_t last = sites.neighbours[sites.begin[i + 1] - 1];
        const double reach = double(length(sites.point[last] - sites.point[i]));
        sum += reach * std::sqrt(kPi / (double(sites.degree(i)) + 0.5));
        ++counted;
    }
    return counted > 0 ? sum / double(counted) : 0;
}

// Coarser and coarser: levels[0] is the finest, whose parents are levels[1]'s sites.
struct Hierarchy {
    std::vector<CoordinateLevel> levels;
    std::vector<std::vector<std::uint32_t>> parent;  // of the sites of each level but the last
};

CoordinateLevel mergedLevel(const CoordinateLevel& fine, double cell, std::vector<std::uint32_t>& parent,
                            const RunContext& ctx) {
    CoarserSites merged = mergedByCells(fine.sites.point, fine.sites.normal, cell, ctx);
    CoordinateLevel coarse;
    coarse.texel = fine.texel;
    const std::size_t n = merged.point.size();
    std::vector<Vec3f> direction(n);
    coarse.label.assign(n, -1);
    for (std::size_t i = 0; i < fine.sites.size(); ++i) {
        const std::uint32_t p = merged.parent[i];
        direction[p] = direction[p] + fine.field[i];
        if (coarse.label[p] < 0) coarse.label[p] = fine.label[i];
    }
    coarse.field.resize(n);
    for (std::size_t p = 0; p < n; ++p) coarse.field[p] = tangentNear(merged.normal[p], direction[p]);
    coarse.tangent = coarse.field;
    coarse.leastCosine = fine.leastCosine;
    coarse.sites = sitesOfPoints(std::move(merged.point), std::move(merged.normal), kSiteNeighbours, ctx);
    parent = std::move(merged.parent);
    return coarse;
}

int sampleSide(const std::vector<SampleImage>& samples) {
    int side = 1;
    for (const SampleImage& sample : samples) side = std::max(side, largestSquare(sample));
    return side;
}

Hierarchy hierarchyOf(CoordinateLevel finest, const std::vector<SampleImage>& samples,
                      const CoordinateOptions& options, const RunContext& ctx) {
    Hierarchy hierarchy;
    const double first = std::max(1.0, meanStep(finest.sites) / finest.texel);
    const double coarsest = std::max(1.0, double(sampleSide(samples)) / kSmallest);
    const bool dense = meanStep(finest.sites) < kDenser * finest.texel;
    const double texel = finest.texel;
    hierarchy.levels.push_back(std::move(finest));
    double step = dense ? 1 : 2 * first;
    for (int made = dense ? 0 : 1;; ++made, step *= 2) {
        const bool more = options.levels > 0 ? made < options.levels : step <= coarsest || made == 0;
        if (!more || (made > 0 && hierarchy.levels.back().sites.size() < 4 * kFewest)) break;
        std::vector<std::uint32_t> parent;
        hierarchy.levels.push_back(
            mergedLevel(hierarchy.levels.back(), kCellOfStep * step * texel, parent, ctx));
        hierarchy.parent.push_back(std::move(parent));
    }
    return hierarchy;
}

// Every site continues its parent's coordinate; one whose parent takes another sample begins anywhere.
void continueParents(CoordinateLevel& fine, const CoordinateLevel& coarse,
                     const std::vector<std::uint32_t>& parent, std::uint32_t number, const RunContext& ctx) {
    fine.coordinate.resize(fine.sites.size());
    const float toTexels = 1 / float(fine.texel);
    parallelFor(ctx, fine.sites.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t p = parent[i];
            if (fine.label[i] != coarse.label[p]) {
                fine.coordinate[i] =
                    randomSource(coarse.samples[std::size_t(fine.label[i])], ctx.seed, i, number);
                continue;
            }
            const SiteFrame frame = siteFrame(coarse.sites.normal[p], coarse.tangent[p]);
            fine.coordinate[i] = coarse.coordinate[p] +
                                 flattened(frame, fine.sites.point[i] - coarse.sites.point[p]) * toTexels;
        }
    });
}

CoordinateLevel finestLevel(CoordinateSites sites, double texel, float leastCosine) {
    CoordinateLevel level;
    level.texel = texel;
    if (sites.label.empty()) sites.label.assign(sites.sites.size(), 0);
    level.sites = std::move(sites.sites);
    level.field = level.tangent = std::move(sites.tangent);
    level.leastCosine = leastCosine;
    level.label = std::move(sites.label);
    return level;
}

void readSamples(CoordinateLevel& level, const std::vector<SampleImage>& samples,
                 const CoordinateOptions& options, const RunContext& ctx) {
    const double step = std::max(1.0, meanStep(level.sites) / level.texel);
    for (const SampleImage& sample : samples)
        level.samples.push_back(sampleLevel(sample, step, std::size_t(options.similar), ctx));
}

}  // namespace

void validate(const CoordinateOptions& options) {
    const auto require = [](bool good, const char* what) {
        if (!good) throw Error(ErrorCode::InvalidOption, what);
    };
    require(options.passes >= 0 && options.passes <= 20, "`passes`: is not between 0 and 20");
    require(options.coarsePasses >= 0 && options.coarsePasses <= 100,
            "`coarsePasses`: is not between 0 and 100");
    require(options.similar >= 0 && options.similar <= 8, "`similar`: is not between 0 and 8");
    require(options.coherence >= 0 && options.coherence <= 10, "`coherence`: is not between 0 and 10");
    require(options.uniformity >= 0 && options.uniformity <= 10, "`uniformity`: is not between 0 and 10");
    require(options.histogram >= 0 && options.histogram <= 10, "`histogram`: is not between 0 and 10");
    require(options.maxRotation >= 0 && options.maxRotation <= 180,
            "`maxRotation`: is not between 0 and 180 degrees");
    require(options.levels >= 0 && options.levels <= 12, "`levels`: is not between 0 and 12");
}

CoordinateResult synthesizeCoordinates(CoordinateSites sites, const std::vector<SampleImage>& samples,
                                       double texel, const CoordinateOptions& options,
                                       const RunContext& ctx) {
    validate(options);
    requireSites(sites, samples, texel);
    Hierarchy hierarchy =
        hierarchyOf(finestLevel(std::move(sites), texel, float(cosine(options.maxRotation * kPi / 180))),
                    samples, options, ctx);
    const bool dense = meanStep(hierarchy.levels[0].sites) < kDenser * texel;
    CoordinateResult result;
    Stage stage(ctx, "texture coordinates", hierarchy.levels.size());
    for (std::size_t l = hierarchy.levels.size(); l-- > 0; stage.advance()) {
        CoordinateLevel& level = hierarchy.levels[l];
        const bool coarsest = l + 1 == hierarchy.levels.size();
        const bool corrected = l > 0 || !dense || coarsest;
        if (corrected) readSamples(level, samples, options, ctx);
        if (coarsest)
            layCharts(level, std::uint32_t(l), ctx);
        else
            continueParents(level, hierarchy.levels[l + 1], hierarchy.parent[l], std::uint32_t(l), ctx);
        if (!corrected) continue;
        correctCoordinates(level, coarsest ? options.coarsePasses : options.passes, options, ctx);
        result.levels.push_back(levelStats(level, ctx));
        result.levels.back().sites = level.sites.size();
    }
    result.coordinate = std::move(hierarchy.levels[0].coordinate);
    result.tangent = std::move(hierarchy.levels[0].tangent);
    return result;
}

}  // namespace vdbsynth
