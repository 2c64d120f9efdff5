#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/measure/measures.h"
#include "libvdbsynth/procedural/exemplar.h"
#include "libvdbsynth/relief/relief_statistics.h"
#include "libvdbsynth/vdb/level_set.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

struct CompareOptions {
    /// Axes along which the reference is stationary; empty: those whose two faces cut about the same area of
    /// the solid (half to twice), if a domain is recorded, else none.
    std::optional<std::array<bool, 3>> stationary;
    /// The process that the reference is a sample of: gives the yardstick. Its size is the reference's.
    std::optional<ExemplarOptions> process;
    int fresh = 10;  ///< fresh samples of it, 2..100
    /// Thickness and pores are measured on every voxel; else of models over 10 million voxels on every second
    /// one (of both, if either is that large: ModelStatistics::thicknessCoarsening).
    bool full = false;
    /// [world] radius of the base from which relief is measured (pipeline/relief/relief_extract.h), the same
    /// for all models; empty: relief is not measured.
    std::optional<double> reliefRadius;
};

/// One model to compare with the reference.
struct CompareInput {
    std::string name;
    LevelSet model;
    /// A source map in the model's voxels; exemplar 0 is the reference. Empty: unknown.
    std::optional<std::vector<MappedVoxel>> sources;
};

/// @throw Error InvalidOption (a field out of its range), Unusable (a process that cannot make the
/// reference's size, or a reference without one), and what requireModel (vdb/level_set.h) throws
void validate(const CompareOptions& options, const CompareInput& reference,
              const std::vector<CompareInput>& others);

/// Finds the source map among some grids and stores it. @return false if none has the model's voxels
bool takeSourceMap(const std::vector<GridPtr>& grids, CompareInput& input);

/// The measurements of one model.
struct ModelStatistics {
    std::string name;
    IndexBox domain;
    bool domainRecorded = false;
    double voxelSize = 1;
    std::vector<Statistic> statistics;
    Topology topology;
    GradientError gradient;
    double bandCompleteness =
        1;                    ///< share of the voxels within one of the surface whose neighbours are active
    std::size_t islands = 0;  ///< parts smaller than the smallest hundredth of the reference's
    std::optional<ReliefStatistics> relief;  ///< [voxels], if CompareOptions::reliefRadius asks for it
    int thicknessCoarsening = 1;             ///< side of the samples that thickness was measured on [voxels]
};

/// Where a result's sources were found.
enum class SourceKind {
    None,     ///< nothing near a surface
    Map,      ///< its own source map
    Matching  ///< searched in the reference
};

/// The measurements of a model relative to the reference.
struct ModelDistances {
    struct Scale {
        double wasserstein = 0;   ///< [voxels]
        double coherence = 0;     ///< [voxels] root of the mean squared difference, as are all costs here
        double completeness = 0;  ///< [voxels]
    };
    std::vector<Scale> scales;
    LocalPatches localPatches;
    std::optional<SurfaceDistance> surface;  ///< [voxels of the reference], if both overlap in the world
    SourceKind sourceKind = SourceKind::None;
    double verified = 0;  ///< share of the map's voxels that are correct, 0 without a map
    IndexBox looked;      ///< Matching: the box searched, in the model's voxels
    Novelty novelty;
    std::vector<Verdict> verdicts;  ///< empty without stationary axes
};

struct Comparison {
    ModelStatistics reference;
    std::vector<ModelStatistics> others;
    std::vector<ModelDistances> distances;  ///< of each other
    std::array<bool, 3> stationary{};
    std::size_t parts = 0;              ///< sub-volumes of the reference
    std::uint64_t islandLimit = 0;      ///< [voxels] smaller components are islands
    int reach = 0;                      ///< [voxels] of curves
    std::vector<Yardstick> yardsticks;  ///< empty without a process
};

/// Statistics of a reference and of other models, and their distances: docs/measures.md defines each. All
/// models should have one voxel size; values are in voxels.
/// @throw Error as validate; Memory, Cancelled
/// @par Cost    256^3: some seconds per model   @par Repeats same bits for ctx.seed, any number of threads
Comparison compareModels(const CompareInput& reference, const std::vector<CompareInput>& others,
                         const CompareOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
