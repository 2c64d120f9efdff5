#include "libvdbsynth/pipeline/compare.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/pipeline/make.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/zero_level.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kMargin = 4;               // [voxels] around a whole object: its band and one more
constexpr int kCapMargin = 2;            // [voxels] at a domain's face where caps bend the field
constexpr double kThicknessLimit = 1e7;  // [voxels] of the largest model; above, all are halved for it
constexpr std::size_t kProjected = 4000, kMatched = 120;
constexpr std::size_t kFewestPatches = 20;  // of a sub-volume, to say anything
constexpr int kShortestPart = 16;           // [voxels] side of a sub-volume
constexpr int kLongestReach = 64;           // [voxels]

// A model with all that is measured more than once.
struct Prepared {
    MeasuredModel model;
    Index3 corner;  // the voxel of the grid that is the field's voxel 0
    PatchSource patches;
    std::vector<Projections> projections;
};

Mesh surfaceOf(const openvdb::FloatGrid& grid, const Index3& corner, const RunContext& ctx) {
    Mesh mesh = zeroLevelInIndexSpace(grid, 0, ctx);
    for (Vec3f& p : mesh.points) p = p - Vec3f{float(corner.x), float(corner.y), float(corner.z)};
    return mesh;
}

Prepared prepared(const std::string& name, const LevelSet& levelSet, int coarsening, const RunContext& ctx) {
    Stage reading(ctx, name + ": meshing", 1);
    const bool whole = !levelSet.domainRecorded;
    const IndexBox box = levelSet.domain.expanded(whole ? kMargin : 0);
    requireMemory(ctx, double(box.volume()) * (0.25 + 8.0 / 512) + double(activeVoxels(*levelSet.grid)) * 40,
                  name + ": measuring it", "compare smaller parts of it (crop) or larger voxels");
    Prepared result;
    result.corner = box.min;
    MeasuredModel& model = result.model;
    model.band = std::min(kHalfWidth, float(halfWidthOf(*levelSet.grid))) * 0.999f;
    model.field = std::make_shared<const BrickField>(
        gatherBricks(*levelSet.grid, box, float(1 / voxelSizeOf(*levelSet.grid)), kHalfWidth, ctx));
    model.counted = {levelSet.domain.min - box.min, levelSet.domain.max - box.min};
    model.beyond = whole ? Beyond::Void : Beyond::Unknown;
    model.surface = surfaceOf(*levelSet.grid, box.min, ctx);
    reading.advance();
    Stage thickness(ctx, name + ": thickness", 1);
    prepare(model, coarsening, ctx);
    thickness.advance();
    Stage drawing(ctx, name + ": patches", 1);
    PatchSourceOptions patches;
    patches.box = whole ? IndexBox::fromSize(box.size()) : model.counted.expanded(-kCapMargin);
    result.patches = patchSource(model.field, patches, ctx);
    for (const PatchScale& scale : result.patches.scales)
        result.projections.push_back(project(scale, kProjected, ctx));
    drawing.advance();
    return result;
}

// Axes along which a domain's both faces cut the solid.
std::array<bool, 3> cutAxes(const MeasuredModel& model) {
    std::array<bool, 3> axes{};
    if (model.beyond == Beyond::Void) return axes;
    for (int axis = 0; axis < 3; ++axis) {
        IndexBox low = model.counted, high = model.counted;
        low.max[axis] = low.min[axis];
        high.min[axis] = high.max[axis];
        axes[std::size_t(axis)] = model.solid.window(low).count() > 0 && model.solid.window(high).count() > 0;
    }
    return axes;
}

// Curves go as far as half the middle side of the smallest box they are measured in.
int reachFor(const std::vector<Index3>& sizes) {
    int reach = kLongestReach;
    for (Index3 side : sizes) {
        const int longest = std::max({side.x, side.y, side.z}), shortest = std::min({side.x, side.y, side.z});
        reach = std::min(reach, (side.x + side.y + side.z - longest - shortest) / 2);
    }
    return std::max(1, reach);
}

// Thickness is measured on samples of one size for all models, so that it can be compared.
int coarseningFor(const CompareInput& reference, const std::vector<CompareInput>& others) {
    double largest = double(reference.model.domain.volume());
    for (const CompareInput& other : others) largest = std::max(largest, double(other.model.domain.volume()));
    int coarsening = 1;
    while (largest / coarsening / coarsening / coarsening > kThicknessLimit) coarsening *= 2;
    return coarsening;
}

// Parts of the solid whose size tells what a crumb is, largest first: whole ones where there are any.
const std::vector<std::uint64_t>& wholeParts(const Topology& topology) {
    return topology.solid.interior.empty() ? topology.solid.sizes : topology.solid.interior;
}

std::uint64_t crumbLimitOf(const Topology& reference) {
    const std::vector<std::uint64_t>& sizes = wholeParts(reference);
    return sizes.empty() ? 0 : sizes[sizes.size() - 1 - sizes.size() / 100];
}

std::size_t countCrumbs(const MeasuredModel& model, const Topology& topology, std::uint64_t limit) {
    // What a domain's face cuts is small for that reason.
    const std::vector<std::uint64_t>& sizes =
        model.beyond == Beyond::Void ? topology.solid.sizes : topology.solid.interior;
    return std::size_t(
        std::count_if(sizes.begin(), sizes.end(), [&](std::uint64_t size) { return size < limit; }));
}

ModelStatistics statisticsOf(const CompareInput& input, const Prepared& prepared, int reach,
                             const RunContext& ctx) {
    Stage stage(ctx, input.name + ": statistics", 1);
    ModelStatistics result;
    result.name = input.name;
    result.domain = input.model.domain;
    result.domainRecorded = input.model.domainRecorded;
    result.voxelSize = voxelSizeOf(*input.model.grid);
    result.statistics = measureStatistics(prepared.model, prepared.model.counted, reach, ctx);
    result.topology = measureTopology(prepared.model, ctx);
    result.gradient = measureGradient(prepared.model, ctx);
    const BandQuality band = measureBand(*input.model.grid, ctx);
    const double near = double(band.measured + band.missingNeighbours);
    result.bandCompleteness = near > 0 ? double(band.measured) / near : 1;
    result.thicknessCoarsening = prepared.model.thickness.coarsening;
    stage.advance();
    return result;
}

// Another model's surface in the voxels of the reference, both beginning where the reference's does.
Mesh inReferenceVoxels(const LevelSet& reference, const Prepared& to, const LevelSet& other,
                       const Prepared& from) {
    Mesh mesh = from.model.surface;
    const auto vec = [](const Index3& p) { return openvdb::Vec3d(p.x, p.y, p.z); };
    for (Vec3f& p : mesh.points) {
        const openvdb::Vec3d world = other.grid->transform().indexToWorld(
            openvdb::Vec3d(double(p.x), double(p.y), double(p.z)) + vec(from.corner));
        const openvdb::Vec3d index = reference.grid->transform().worldToIndex(world) - vec(to.corner);
        p = {float(index.x()), float(index.y()), float(index.z())};
    }
    return mesh;
}

// True if nearly all of some vertices of one surface lie within the band of the other: two versions of one
// object, not two textures in one place.
bool inOnePlace(const Mesh& mesh, const Prepared& to) {
    constexpr std::size_t kLooked = 5000;
    const std::size_t step = std::max<std::size_t>(1, mesh.points.size() / kLooked);
    std::size_t looked = 0, near = 0;
    for (std::size_t i = 0; i < mesh.points.size(); i += step, ++looked) {
        const Vec3f& p = mesh.points[i];
        const Index3 voxel{int(std::lround(p.x)), int(std::lround(p.y)), int(std::lround(p.z))};
        near += to.model.field->box().contains(voxel) && std::abs(to.model.field->inside(voxel)) < kHalfWidth;
    }
    return looked > 0 && near > looked * 9 / 10;
}

// The voxels near the surface that a source map names, in the voxels of the two fields.
std::vector<SourcedVoxel> sourcesOfMap(const CompareInput& input, const Prepared& result,
                                       const Prepared& reference) {
    std::vector<SourcedVoxel> voxels;
    const auto sources = openvdb::gridPtrCast<openvdb::Vec3IGrid>(input.source);
    const auto exemplars =
        input.exemplar ? openvdb::gridPtrCast<openvdb::Int32Grid>(input.exemplar) : nullptr;
    if (!sources) return voxels;
    for (auto it = sources->cbeginValueOn(); it; ++it) {
        if (!it.isVoxelValue()) continue;
        const Index3 place = fromCoord(it.getCoord()) - result.corner;
        if (!result.model.counted.contains(place) ||
            std::abs(result.model.field->inside(place)) >= kNearSurface)
            continue;
        if (exemplars && exemplars->tree().getValue(it.getCoord()) != 0) continue;
        const openvdb::Vec3i& from = *it;
        voxels.push_back({place, Index3{from.x(), from.y(), from.z()} - reference.corner, 0});
    }
    return voxels;
}

void measureSources(const CompareInput& input, const Prepared& result, const Prepared& reference,
                    ModelDistances& distances, const RunContext& ctx) {
    const std::size_t ofExemplar =
        countNearSurface(*reference.model.field, reference.model.counted, kNearSurface, ctx);
    if (input.source) {
        std::vector<SourcedVoxel> voxels = sourcesOfMap(input, result, reference);
        distances.verified = verifiedShare(voxels, *result.model.field, *reference.model.field);
        if (distances.verified >= 0.9) {
            const std::size_t looked =
                countNearSurface(*result.model.field, result.model.counted, kNearSurface, ctx);
            distances.sourceKind = SourceKind::Map;
            distances.novelty = measureNovelty(std::move(voxels), looked, ofExemplar, *result.model.field);
            return;
        }
    }
    MatchedSources matched = sourcesByMatching(result.model.field, result.model.counted,
                                               reference.model.field, reference.model.counted, ctx);
    if (matched.looked == 0) return;
    distances.sourceKind = SourceKind::Matching;
    distances.looked = {matched.box.min + result.corner, matched.box.max + result.corner};
    distances.novelty =
        measureNovelty(std::move(matched.voxels), matched.looked, ofExemplar, *result.model.field);
}

ModelDistances distancesOf(const CompareInput& reference, const Prepared& to, const CompareInput& other,
                           const Prepared& from, const RunContext& ctx) {
    Stage stage(ctx, other.name + ": patches beside the reference's", 1);
    ModelDistances result;
    const double far = 1e30;
    for (std::size_t s = 0; s < std::min(to.patches.scales.size(), from.patches.scales.size()); ++s) {
        const PatchScale &a = to.patches.scales[s], &b = from.patches.scales[s];
        result.scales.push_back({slicedWasserstein(to.projections[s], from.projections[s], ctx),
                                 std::sqrt(matchPatches(b, a, kMatched, far, ctx).mean),
                                 std::sqrt(matchPatches(a, b, kMatched, far, ctx).mean)});
    }
    const bool whole = from.model.beyond == Beyond::Void;
    result.localPatches =
        localPatchSimilarity(to.model.solid.window(to.model.counted),
                             whole ? from.model.solid : from.model.solid.window(from.model.counted), ctx);
    stage.advance();
    Stage last(ctx, other.name + ": novelty", 1);
    const Mesh mesh = inReferenceVoxels(reference.model, to, other.model, from);
    if (to.model.surface.faceCount() > 0 && mesh.faceCount() > 0 && inOnePlace(mesh, to))
        result.surface = surfaceDistance(to.model.surface, mesh, ctx);
    measureSources(other, from, to, result, ctx);
    last.advance();
    return result;
}

// Beside the spread of the reference's own sub-volumes.
struct Spread {
    std::vector<std::vector<Statistic>> statistics;  // [statistic][part]
    std::vector<std::vector<double>> wasserstein;    // [scale][part] from the other parts; empty: no spread
};

Spread spreadOf(const Prepared& reference, const std::vector<IndexBox>& parts, int reach,
                const RunContext& ctx) {
    Stage stage(ctx, "measuring the reference's sub-volumes", 1);
    std::vector<std::vector<Statistic>> all(parts.size());
    std::vector<std::vector<double>> far(parts.size());
    parallelFor(ctx, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part) {
            all[part] = measureStatistics(reference.model, parts[part], reach, ctx);
            for (std::size_t s = 0; s < reference.projections.size(); ++s) {
                const Projections& whole = reference.projections[s];
                const Projections inside = within(whole, parts[part], int(s));
                far[part].push_back(
                    inside.places.size() < kFewestPatches
                        ? -1
                        : slicedWasserstein(inside, within(whole, parts[part], int(s), false), ctx));
            }
        }
    });
    Spread spread;
    spread.wasserstein.resize(reference.projections.size());
    spread.statistics.resize(all.front().size());
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (std::size_t i = 0; i < all[part].size(); ++i) spread.statistics[i].push_back(all[part][i]);
        for (std::size_t s = 0; s < far[part].size(); ++s)
            if (far[part][s] >= 0) spread.wasserstein[s].push_back(far[part][s]);
    }
    stage.advance();
    // A scale whose patches do not fit into the parts says nothing.
    for (std::vector<double>& distances : spread.wasserstein)
        if (distances.size() < parts.size()) distances.clear();
    return spread;
}

std::string scaleName(std::size_t scale) {
    return "sliced Wasserstein, patches of " + std::to_string(kPatchSide << scale) + " voxels";
}

std::vector<Verdict> verdictsOn(const Spread& spread, const std::vector<Statistic>& statistics,
                                const ModelDistances& distances) {
    std::vector<Verdict> verdicts;
    for (std::size_t i = 0; i < statistics.size(); ++i)
        verdicts.push_back(judge(spread.statistics[i], statistics[i]));
    for (std::size_t s = 0; s < distances.scales.size(); ++s)
        if (!spread.wasserstein[s].empty())
            verdicts.push_back(
                judgeDistance(scaleName(s), spread.wasserstein[s], distances.scales[s].wasserstein));
    return verdicts;
}

// The value half a voxel on from p along every axis, by cubics through four voxels, which blur far less than
// lines through two.
float betweenVoxels(const BrickField& field, const Index3& p) {
    constexpr float kWeights[4] = {-1.f / 16, 9.f / 16, 9.f / 16, -1.f / 16};
    float sum = 0;
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 4; ++y)
            for (int z = 0; z < 4; ++z)
                sum += kWeights[x] * kWeights[y] * kWeights[z] * field.at(p + Index3{x - 1, y - 1, z - 1});
    return sum;
}

// A model moved by half a voxel along every axis: what a statistic makes of nothing but another sampling.
LevelSet shiftedByHalf(const LevelSet& model, const RunContext& ctx) {
    const float voxel = float(voxelSizeOf(*model.grid));
    const BrickField field = gatherBricks(*model.grid, model.domain, 1 / voxel, kHalfWidth, ctx);
    const BrickField moved =
        BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
            for (int x = brick.min.x; x <= brick.max.x; ++x)
                for (int y = brick.min.y; y <= brick.max.y; ++y)
                    for (int z = brick.min.z; z <= brick.max.z; ++z)
                        *samples++ = betweenVoxels(field, {x, y, z});
        });
    LevelSet result = model;
    result.grid = scatterBricks(moved, model.domain.min, voxel, kHalfWidth, ctx);
    result.grid->setTransform(model.grid->transform().copy());
    return result;
}

// Distances of one model from the reference, by name: those that a yardstick is made of.
std::vector<std::pair<std::string, double>> yardstickDistances(const ModelStatistics& reference,
                                                               const Prepared& to,
                                                               const std::vector<Statistic>& statistics,
                                                               const Prepared& from, const RunContext& ctx) {
    std::vector<std::pair<std::string, double>> result;
    for (std::size_t i = 0; i < statistics.size(); ++i)
        result.emplace_back(statistics[i].name, statisticDistance(reference.statistics[i], statistics[i]));
    for (std::size_t s = 0; s < std::min(to.projections.size(), from.projections.size()); ++s)
        result.emplace_back(scaleName(s), slicedWasserstein(to.projections[s], from.projections[s], ctx));
    return result;
}

std::vector<Yardstick> yardsticksOf(const CompareInput& reference, const Prepared& to,
                                    const Comparison& comparison, const std::vector<Prepared>& others,
                                    const CompareOptions& options, const RunContext& ctx) {
    std::vector<Yardstick> yardsticks;
    const auto add = [&](const std::vector<Statistic>& statistics, const Prepared& from, double share,
                         double Yardstick::*member) {
        const auto distances = yardstickDistances(comparison.reference, to, statistics, from, ctx);
        yardsticks.resize(std::max(yardsticks.size(), distances.size()));
        for (std::size_t i = 0; i < distances.size(); ++i) {
            yardsticks[i].name = distances[i].first;
            yardsticks[i].*member += distances[i].second * share;
        }
    };
    for (std::size_t i = 0; i < others.size(); ++i)
        add(comparison.others[i].statistics, others[i], 1.0 / double(others.size()), &Yardstick::results);
    const auto measure = [&](const LevelSet& model, const std::string& name, double share,
                             double Yardstick::*member) {
        const Prepared fresh = prepared(name, model, to.model.thickness.coarsening, ctx);
        add(measureStatistics(fresh.model, fresh.model.counted, comparison.reach, ctx), fresh, share, member);
    };
    measure(shiftedByHalf(reference.model, ctx), "the shifted reference", 1, &Yardstick::shifted);
    for (int i = 0; i < options.fresh; ++i) {
        MakeOptions make;
        make.exemplar = *options.process;
        make.exemplar.size = reference.model.domain.size();
        make.voxelSize = voxelSizeOf(*reference.model.grid);
        RunContext fresh = ctx;
        Random random(ctx.seed, std::uint64_t(i), 0x46524553);
        fresh.seed = (std::uint64_t(random.bits()) << 32) | random.bits();
        measure(makeModel(make, fresh), "fresh exemplar " + std::to_string(i + 1), 1.0 / options.fresh,
                &Yardstick::fresh);
    }
    return yardsticks;
}

}  // namespace

bool takeSourceMap(const std::vector<GridPtr>& grids, CompareInput& input) {
    GridPtr source, exemplar;
    for (const GridPtr& grid : grids) {
        if (grid->getName() == "source") source = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grid);
        if (grid->getName() == "exemplar") exemplar = openvdb::gridPtrCast<openvdb::Int32Grid>(grid);
    }
    if (!source) return false;
    const auto matrix = [](const openvdb::GridBase& grid) {
        return grid.transform().baseMap()->getAffineMap()->getMat4();
    };
    const openvdb::Mat4d difference = matrix(*source) - matrix(*input.model.grid);
    const double voxel = voxelSizeOf(*input.model.grid);
    for (int i = 0; i < 16; ++i)
        if (std::abs(difference.asPointer()[i]) > 1e-4 * voxel) return false;
    input.source = source;
    input.exemplar = exemplar;
    return true;
}

Comparison compareModels(const CompareInput& reference, const std::vector<CompareInput>& others,
                         const CompareOptions& options, const RunContext& ctx) {
    requireOption(options.fresh >= 2 && options.fresh <= 100, "fresh", std::to_string(options.fresh),
                  "a whole number from 2 to 100");
    if (options.process && !reference.model.domainRecorded)
        throw Error(ErrorCode::Unusable, reference.name +
                                             ": has no recorded domain, so --process cannot "
                                             "tell what size to make; crop it to a box first");
    const ThreadLimit limit(ctx);
    Comparison result;
    const int coarsening = coarseningFor(reference, others);
    const Prepared to = prepared(reference.name, reference.model, coarsening, ctx);
    result.stationary = options.stationary.value_or(cutAxes(to.model));
    const std::vector<IndexBox> parts = subVolumes(to.model.counted, result.stationary, kShortestPart);
    result.parts = parts.size();
    std::vector<Index3> sizes{reference.model.domain.size()};
    if (!parts.empty()) sizes.push_back(parts.front().size());
    for (const CompareInput& other : others) sizes.push_back(other.model.domain.size());
    result.reach = reachFor(sizes);
    result.reference = statisticsOf(reference, to, result.reach, ctx);
    result.crumbLimit = crumbLimitOf(result.reference.topology);
    const Spread spread = parts.empty() ? Spread{} : spreadOf(to, parts, result.reach, ctx);
    std::vector<Prepared> measured;
    for (const CompareInput& other : others) {
        measured.push_back(prepared(other.name, other.model, coarsening, ctx));
        result.others.push_back(statisticsOf(other, measured.back(), result.reach, ctx));
        ModelStatistics& statistics = result.others.back();
        statistics.crumbs = countCrumbs(measured.back().model, statistics.topology, result.crumbLimit);
        result.distances.push_back(distancesOf(reference, to, other, measured.back(), ctx));
        if (!parts.empty())
            result.distances.back().verdicts =
                verdictsOn(spread, statistics.statistics, result.distances.back());
    }
    result.reference.crumbs = countCrumbs(to.model, result.reference.topology, result.crumbLimit);
    if (options.process) result.yardsticks = yardsticksOf(reference, to, result, measured, options, ctx);
    return result;
}

}  // namespace vdbsynth
