#include "libvdbsynth/pipeline/compare/compare_steps.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::size_t kMatched = 120;  // patches to search
constexpr int kShortestPart = 16;      // [voxels] side of a sub-volume
constexpr int kLongestReach = 64;      // [voxels]

// Curves extend to half the middle side of the smallest box they are measured in.
int reachFor(const std::vector<Index3>& sizes) {
    int reach = kLongestReach;
    for (const Index3& side : sizes) {
        const int longest = std::max({side.x, side.y, side.z}), shortest = std::min({side.x, side.y, side.z});
        reach = std::min(reach, (side.x + side.y + side.z - longest - shortest) / 2);
    }
    return std::max(1, reach);
}

// Components of the solid whose sizes define the islands, largest first: whole ones if there are any.
const std::vector<std::uint64_t>& wholeParts(const Topology& topology) {
    return topology.solid.interior.empty() ? topology.solid.sizes : topology.solid.interior;
}

std::uint64_t islandLimitOf(const Topology& reference) {
    const std::vector<std::uint64_t>& sizes = wholeParts(reference);
    return sizes.empty() ? 0 : sizes[sizes.size() - 1 - sizes.size() / 100];
}

std::size_t countIslands(const MeasuredModel& model, const Topology& topology, std::uint64_t limit) {
    // Components cut by a domain's face are small for that reason.
    const std::vector<std::uint64_t>& sizes =
        model.beyond == Beyond::Void ? topology.solid.sizes : topology.solid.interior;
    return std::size_t(
        std::count_if(sizes.begin(), sizes.end(), [&](std::uint64_t size) { return size < limit; }));
}

ReliefStatistics reliefOf(const CompareInput& input, double radius, const RunContext& ctx) {
    ReliefExtractOptions options;
    options.baseRadius = radius;
    try {
        return extractRelief(input.model, options, ctx).statistics;
    } catch (const Error& error) {
        throw Error(error.code(), input.name + ": relief: " + error.what());
    }
}

ModelStatistics statisticsOf(const CompareInput& input, const PreparedModel& prepared, int reach,
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

// A position in another model's field, in voxels of the reference's.
template <typename Place>
openvdb::Vec3d inReferenceVoxels(const LevelSet& reference, const PreparedModel& to, const LevelSet& other,
                                 const PreparedModel& from, const Place& p) {
    const auto vec = [](const auto& q) { return openvdb::Vec3d(double(q.x), double(q.y), double(q.z)); };
    const openvdb::Vec3d world = other.grid->transform().indexToWorld(vec(p) + vec(from.corner));
    return reference.grid->transform().worldToIndex(world) - vec(to.corner);
}

Mesh surfaceInReferenceVoxels(const LevelSet& reference, const PreparedModel& to, const LevelSet& other,
                              const PreparedModel& from) {
    Mesh mesh = from.model.surface;
    for (Vec3f& p : mesh.points) {
        const openvdb::Vec3d index = inReferenceVoxels(reference, to, other, from, p);
        p = {float(index.x()), float(index.y()), float(index.z())};
    }
    return mesh;
}

// Box in which vertices of the two surfaces are compared, in voxels of the reference:
// excludes caps. None: everywhere.
std::optional<IndexBox> withoutCaps(const LevelSet& reference, const PreparedModel& to, const LevelSet& other,
                                    const PreparedModel& from) {
    std::optional<IndexBox> box;
    const auto narrow = [&](const IndexBox& by) { box = box ? box->intersection(by) : by; };
    if (to.model.beyond == Beyond::Unknown) narrow(to.model.counted.expanded(-kCapMargin));
    if (from.model.beyond == Beyond::Unknown) {
        const IndexBox own = from.model.counted.expanded(-kCapMargin);
        IndexBox mapped;
        for (int axis = 0; axis < 3; ++axis) {
            const openvdb::Vec3d low = inReferenceVoxels(reference, to, other, from, own.min),
                                 high = inReferenceVoxels(reference, to, other, from, own.max);
            mapped.min[axis] = int(std::ceil(std::min(low[axis], high[axis])));
            mapped.max[axis] = int(std::floor(std::max(low[axis], high[axis])));
        }
        narrow(mapped);
    }
    return box;
}

// True if nearly all of some vertices of one surface are within the band of the other: two versions of one
// object, not two textures at the same position.
bool inOnePlace(const Mesh& mesh, const PreparedModel& to, const std::optional<IndexBox>& within) {
    constexpr std::size_t kLooked = 5000;
    const std::size_t step = std::max<std::size_t>(1, mesh.points.size() / kLooked);
    std::size_t looked = 0, near = 0;
    for (std::size_t i = 0; i < mesh.points.size(); i += step) {
        const Vec3f& p = mesh.points[i];
        const Index3 voxel{int(std::lround(p.x)), int(std::lround(p.y)), int(std::lround(p.z))};
        if (within && !within->contains(voxel)) continue;
        ++looked;
        near += to.model.field->box().contains(voxel) && std::abs(to.model.field->inside(voxel)) < kHalfWidth;
    }
    return looked > 0 && near > looked * 9 / 10;
}

// Box of possible sources and destinations: excludes voxels where caps distort the field.
IndexBox sourcedBox(const MeasuredModel& model) {
    return model.beyond == Beyond::Void ? model.field->box() : model.counted.expanded(-kCapMargin);
}

// The sources that a map gives for voxels near the surface, in the voxels of the two fields.
std::vector<SourcedVoxel> sourcesOfMap(const CompareInput& input, const PreparedModel& result,
                                       const PreparedModel& reference) {
    std::vector<SourcedVoxel> voxels;
    for (const MappedVoxel& mapped : *input.sources) {
        const Index3 place = mapped.to - result.corner;
        if (!sourcedBox(result.model).contains(place) ||
            std::abs(result.model.field->inside(place)) >= kNearSurface || mapped.from.exemplar != 0)
            continue;
        voxels.push_back({place, nearestVoxel(mapped.from) - reference.corner, 0});
    }
    return voxels;
}

void measureSources(const CompareInput& input, const PreparedModel& result, const PreparedModel& reference,
                    ModelDistances& distances, const RunContext& ctx) {
    const BrickField &ofResult = *result.model.field, &ofReference = *reference.model.field;
    const IndexBox from = sourcedBox(reference.model);
    if (input.sources) {
        std::vector<SourcedVoxel> voxels = sourcesOfMap(input, result, reference);
        distances.verified = verifiedShare(voxels, ofResult, ofReference);
        if (distances.verified >= 0.9) {
            const std::size_t looked =
                countNearSurface(ofResult, sourcedBox(result.model), kNearSurface, ctx);
            distances.sourceKind = SourceKind::Map;
            distances.novelty = measureNovelty(std::move(voxels), looked, ofResult, ofReference, from, ctx);
            return;
        }
    }
    MatchedSources matched =
        sourcesByMatching(result.model.field, sourcedBox(result.model), reference.model.field, from, ctx);
    if (matched.looked == 0) return;
    distances.sourceKind = SourceKind::Matching;
    distances.looked = {matched.box.min + result.corner, matched.box.max + result.corner};
    distances.novelty =
        measureNovelty(std::move(matched.voxels), matched.looked, ofResult, ofReference, from, ctx);
}

ModelDistances distancesOf(const CompareInput& reference, const PreparedModel& to, const CompareInput& other,
                           const PreparedModel& from, const RunContext& ctx) {
    Stage stage(ctx, other.name + ": patches against the reference's", 1);
    ModelDistances result;
    const double far = 1e30;
    for (std::size_t s = 0; s < std::min(to.patches.scales.size(), from.patches.scales.size()); ++s) {
        const PatchScale &a = to.patches.scales[s], &b = from.patches.scales[s];
        result.scales.push_back({slicedWasserstein(to.projections[s], from.projections[s], ctx),
                                 std::sqrt(matchPatches(b, a, kMatched, far, ctx).mean),
                                 std::sqrt(matchPatches(a, b, kMatched, far, ctx).mean)});
    }
    const auto bits = [](const MeasuredModel& model) {
        return PatchBits{model.solid.window(model.counted), model.beyond};
    };
    result.localPatches = localPatchSimilarity(bits(to.model), bits(from.model), ctx);
    stage.advance();
    Stage last(ctx, other.name + ": novelty", 1);
    const Mesh mesh = surfaceInReferenceVoxels(reference.model, to, other.model, from);
    const std::optional<IndexBox> counted = withoutCaps(reference.model, to, other.model, from);
    if (to.model.surface.faceCount() > 0 && mesh.faceCount() > 0 && inOnePlace(mesh, to, counted))
        result.surface = surfaceDistance(to.model.surface, mesh, counted, ctx);
    measureSources(other, from, to, result, ctx);
    last.advance();
    return result;
}

}  // namespace

bool takeSourceMap(const std::vector<GridPtr>& grids, CompareInput& input) {
    if (!hasSourcesIn(grids, *input.model.grid)) return false;
    input.sources = strongestSourcesIn(grids);
    return true;
}

namespace {

Comparison compared(const CompareInput& reference, const std::vector<CompareInput>& others,
                    const CompareOptions& options, const RunContext& ctx) {
    Comparison result;
    const int coarsening = options.full ? 1 : thicknessCoarsening(reference, others);
    const PreparedModel to = prepareModel(reference.name, reference.model, coarsening, ctx);
    result.stationary = options.stationary.value_or(cutAxes(to.model));
    const std::vector<IndexBox> parts = subVolumes(to.model.counted, result.stationary, kShortestPart);
    result.parts = parts.size();
    std::vector<Index3> sizes{reference.model.domain.size()};
    if (!parts.empty()) sizes.push_back(parts.front().size());
    for (const CompareInput& other : others) sizes.push_back(other.model.domain.size());
    result.reach = reachFor(sizes);
    result.reference = statisticsOf(reference, to, result.reach, ctx);
    if (options.reliefRadius) result.reference.relief = reliefOf(reference, *options.reliefRadius, ctx);
    result.islandLimit = islandLimitOf(result.reference.topology);
    const Spread spread = parts.empty() ? Spread{} : spreadOf(to, parts, result.reach, ctx);
    std::vector<ScaleProjections> projections;
    for (const CompareInput& other : others) {
        // One model after another, because measuring takes far more memory than the results.
        PreparedModel from = prepareModel(other.name, other.model, coarsening, ctx);
        result.others.push_back(statisticsOf(other, from, result.reach, ctx));
        ModelStatistics& statistics = result.others.back();
        if (options.reliefRadius) statistics.relief = reliefOf(other, *options.reliefRadius, ctx);
        statistics.islands = countIslands(from.model, statistics.topology, result.islandLimit);
        result.distances.push_back(distancesOf(reference, to, other, from, ctx));
        if (!parts.empty())
            result.distances.back().verdicts =
                verdictsOn(spread, from, result.distances.back(), result.reach, ctx);
        if (!parts.empty())
            result.distances.back().verdicts.push_back(judgeFraction(
                result.reference.statistics, double(to.model.counted.volume()), statistics.statistics));
        projections.push_back(std::move(from.projections));
    }
    result.reference.islands = countIslands(to.model, result.reference.topology, result.islandLimit);
    if (options.process) result.yardsticks = yardsticksOf(reference, to, result, projections, options, ctx);
    return result;
}

}  // namespace

void validate(const CompareOptions& options, const CompareInput& reference,
              const std::vector<CompareInput>& others) {
    requireOption(options.fresh >= 2 && options.fresh <= 100, "fresh", std::to_string(options.fresh),
                  "a whole number from 2 to 100");
    if (options.reliefRadius)
        requireOption(*options.reliefRadius > 0 && *options.reliefRadius < 1e30, "reliefRadius",
                      roundedText(*options.reliefRadius, 6), "above 0 (world)");
    const auto nameOf = [](const CompareInput& input) {
        return input.name.empty() ? std::string("a model") : input.name;
    };
    requireModel(&reference.model, nameOf(reference));
    for (const CompareInput& other : others) requireModel(&other.model, nameOf(other));
    if (options.process && !reference.model.domainRecorded)
        throw Error(
            ErrorCode::Unusable,
            reference.name +
                ": has no recorded domain, which sets the size of `process` samples; crop it to a box first");
    const Index3 size = reference.model.domain.size();
    if (options.process &&
        (std::min({size.x, size.y, size.z}) < 8 || std::max({size.x, size.y, size.z}) > 4096))
        throw Error(ErrorCode::Unusable,
                    reference.name + ": `process` makes domains of 8 to 4096 voxels a side only");
    if (!options.process) return;
    ExemplarOptions process = *options.process;
    process.size = size;
    validate(process);
}

Comparison compareModels(const CompareInput& reference, const std::vector<CompareInput>& others,
                         const CompareOptions& options, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        validate(options, reference, others);
        return compared(reference, others, options, ctx);
    });
}

}  // namespace vdbsynth
