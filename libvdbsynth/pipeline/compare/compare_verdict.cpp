// A result relative to the reference's sub-volumes and to fresh samples of its process.
#include "libvdbsynth/pipeline/compare/compare_steps.h"

#include "libvdbsynth/math/lattice.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <map>

namespace vdbsynth {
namespace {

constexpr std::size_t kFewestPatches = 20;  // of a sub-volume, to be meaningful

// Statistics of each of several boxes, [statistic][box].
std::vector<std::vector<Statistic>> statisticsIn(const MeasuredModel& model,
                                                 const std::vector<IndexBox>& boxes, int reach,
                                                 const RunContext& ctx) {
    std::vector<std::vector<Statistic>> byBox(boxes.size());
    parallelFor(ctx, boxes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) byBox[i] = measureStatistics(model, boxes[i], reach, ctx);
    });
    std::vector<std::vector<Statistic>> result(byBox.front().size());
    for (const std::vector<Statistic>& all : byBox)
        for (std::size_t i = 0; i < all.size(); ++i) result[i].push_back(all[i]);
    return result;
}

std::vector<Statistic> meanOverParts(const MeasuredModel& model, const Index3& part, int reach,
                                     const RunContext& ctx) {
    const Index3 size = model.counted.size();
    Index3 side = part, count{1, 1, 1};
    for (int axis = 0; axis < 3; ++axis) {
        side[axis] = std::min(side[axis], size[axis]);
        count[axis] = size[axis] / side[axis];
    }
    std::vector<IndexBox> boxes;
    forEachVoxel(IndexBox::fromSize(count), [&](const Index3& cell) {
        const Index3 low = model.counted.min + Index3{cell.x * side.x, cell.y * side.y, cell.z * side.z};
        boxes.push_back({low, low + side - Index3{1, 1, 1}});
    });
    std::vector<Statistic> result;
    for (const std::vector<Statistic>& one : statisticsIn(model, boxes, reach, ctx))
        result.push_back(meanOf(one));
    return result;
}

std::string scaleName(std::size_t scale) {
    return "sliced Wasserstein, patches of " + std::to_string(kPatchSide << scale) + " voxels";
}

// The value half a voxel from p along every axis, by cubics through four voxels, which blur far less than
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

// A model shifted by half a voxel along every axis: the effect of the sampling alone on a statistic.
LevelSet shiftedByHalf(const LevelSet& model, const RunContext& ctx) {
    const float voxel = float(voxelSizeOf(*model.grid));
    const BrickField field = gatherBricks(*model.grid, model.domain, 1 / voxel, kHalfWidth, ctx);
    const BrickField moved =
        BrickField::fromVoxels(field.box(), ctx, [&](const Index3& p) { return betweenVoxels(field, p); });
    LevelSet result = model;
    result.grid = scatterBricks(moved, model.domain.min, voxel, kHalfWidth, ctx);
    result.grid->setTransform(model.grid->transform().copy());
    return result;
}

using DistancesByName = std::map<std::string, double>;

// Distances of one model from the reference that a yardstick uses.
DistancesByName yardstickDistances(const ModelStatistics& reference, const PreparedModel& to,
                                   const std::vector<Statistic>& statistics, const ScaleProjections& from,
                                   const RunContext& ctx) {
    DistancesByName result;
    for (const Statistic& other : statistics)
        for (const Statistic& own : reference.statistics)
            if (own.name == other.name && own.measured() && other.measured())
                result[own.name] = statisticDistance(own, other);
    for (std::size_t s = 0; s < std::min(to.projections.size(), from.size()); ++s)
        result[scaleName(s)] = slicedWasserstein(to.projections[s], from[s], ctx);
    return result;
}

// One row for each quantity that can be measured of the reference, in the order of its statistics.
std::vector<Yardstick> emptyYardsticks(const ModelStatistics& reference, std::size_t scales) {
    std::vector<Yardstick> rows;
    for (const Statistic& statistic : reference.statistics)
        if (statistic.measured()) rows.push_back({statistic.name, 0, 0, 0});
    for (std::size_t s = 0; s < scales; ++s) rows.push_back({scaleName(s), 0, 0, 0});
    return rows;
}

// Adds one sample's share; rows without a number for it are removed, since their mean would be incomplete.
void addSample(const DistancesByName& distances, double share, double Yardstick::*member,
               std::vector<Yardstick>& rows) {
    rows.erase(std::remove_if(rows.begin(), rows.end(),
                              [&](const Yardstick& row) { return distances.count(row.name) == 0; }),
               rows.end());
    for (Yardstick& row : rows) row.*member += distances.at(row.name) * share;
}

}  // namespace

Spread spreadOf(const PreparedModel& reference, const std::vector<IndexBox>& parts, int reach,
                const RunContext& ctx) {
    Stage stage(ctx, "the reference's sub-volumes", 1);
    Spread spread;
    spread.part = parts.front().size();
    spread.statistics = statisticsIn(reference.model, parts, reach, ctx);
    spread.wasserstein.resize(reference.projections.size());
    for (std::size_t s = 0; s < reference.projections.size(); ++s)
        for (const IndexBox& part : parts) {
            const Projections& whole = reference.projections[s];
            const Projections inside = within(whole, part, int(s));
            if (inside.places.size() >= kFewestPatches)
                spread.wasserstein[s].push_back(
                    slicedWasserstein(inside, within(whole, part, int(s), false), ctx));
        }
    // A scale whose patches do not fit into the parts is skipped.
    for (std::vector<double>& distances : spread.wasserstein)
        if (distances.size() < parts.size()) distances.clear();
    stage.advance();
    return spread;
}

std::vector<Verdict> verdictsOn(const Spread& spread, const PreparedModel& other,
                                const ModelDistances& distances, int reach, const RunContext& ctx) {
    const std::vector<Statistic> statistics = meanOverParts(other.model, spread.part, reach, ctx);
    std::vector<Verdict> verdicts;
    for (const Statistic& own : statistics)
        for (const std::vector<Statistic>& parts : spread.statistics)
            if (parts.front().name == own.name && parts.front().measured() && own.measured())
                verdicts.push_back(judge(parts, own));
    for (std::size_t s = 0; s < std::min(distances.scales.size(), spread.wasserstein.size()); ++s)
        if (!spread.wasserstein[s].empty())
            verdicts.push_back(
                judgeDistance(scaleName(s), spread.wasserstein[s], distances.scales[s].wasserstein));
    return verdicts;
}

std::vector<Yardstick> yardsticksOf(const CompareInput& reference, const PreparedModel& to,
                                    const Comparison& comparison, const std::vector<ScaleProjections>& others,
                                    const CompareOptions& options, const RunContext& ctx) {
    std::vector<Yardstick> yardsticks = emptyYardsticks(comparison.reference, to.projections.size());
    const auto add = [&](const std::vector<Statistic>& statistics, const ScaleProjections& from, double share,
                         double Yardstick::*member) {
        addSample(yardstickDistances(comparison.reference, to, statistics, from, ctx), share, member,
                  yardsticks);
    };
    for (std::size_t i = 0; i < others.size(); ++i)
        add(comparison.others[i].statistics, others[i], 1.0 / double(others.size()), &Yardstick::results);
    const auto measure = [&](const LevelSet& model, const std::string& name, double share,
                             double Yardstick::*member) {
        const PreparedModel fresh = prepareModel(name, model, to.model.thickness.coarsening, ctx);
        add(measureStatistics(fresh.model, fresh.model.counted, comparison.reach, ctx), fresh.projections,
            share, member);
    };
    measure(shiftedByHalf(reference.model, ctx), "the shifted reference", 1, &Yardstick::shifted);
    for (int i = 0; i < options.fresh; ++i) {
        MakeOptions make;
        make.exemplar = *options.process;
        make.exemplar.size = reference.model.domain.size();
        make.voxelSize = voxelSizeOf(*reference.model.grid);
        RunContext fresh = ctx;
        Random random(ctx.seed, std::uint64_t(i), 0x46524553);
        fresh.seed = std::uint64_t(random.bits()) << 32;
        fresh.seed |= random.bits();
        measure(makeModel(make, fresh), "fresh exemplar " + std::to_string(i + 1), 1.0 / options.fresh,
                &Yardstick::fresh);
    }
    return yardsticks;
}

}  // namespace vdbsynth
