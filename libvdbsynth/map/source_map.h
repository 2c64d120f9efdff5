#pragma once
#include "libvdbsynth/map/element_sources.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/map/patch_map.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// What attributes and grids that are transferred hold in a result.
enum class CarriedValues {
    Copied,  ///< the value at the source with the largest weight
    Blended  ///< of floats and vectors the mean over all sources, by their weights
};

/// What a result was made by, which says how it is made again from the map.
enum class MapMethod {
    Synthesis,  ///< blocks of exemplars, over a target of its own
    Fill,       ///< blocks of exemplars, in the hole of a model that is kept around it
    Analogy     ///< a source a voxel, beside the surface of a plain model
};

/// One of the exemplars that a source map reads.
struct MappedExemplar {
    IndexBox box;  ///< working box [its index space]: its domain, grown where a method needs room around it
    IndexBox domain;
    std::string hash;              ///< levelSetHash
    std::array<bool, 6> cut{};     ///< fills and analogies: faces of the box where the solid continues beyond
    Affine transform = kIdentity;  ///< from its index space to the world, when the map was made
};

/// From this distance to the plain surface on [whole voxels], up to the next run, voxels without a source are
/// full or empty.
struct DepthRun {
    int from = 0;
    bool full = false;
};

/// What fills and analogies need beside their sources: the model that they were put on is an input of repeat.
struct MappedTarget {
    std::string hash;  ///< levelSetHash
    double voxelSize = 1;
    bool domainRecorded = false;
};

struct MappedAnalogy {
    double scale = 1;              ///< size of the texture, as Source::scale
    float strength = 1;            ///< 0..1
    std::vector<DepthRun> depths;  ///< ascending; before the first as at the first
    /// Strength times mask over the target box, its box beginning at 0; empty box: `strength` everywhere.
    BrickField weight;
};

struct MappedHole {
    Index3 corner;          ///< of the field below [index space of the kept model]
    BrickField distance;    ///< [voxels] to the hole's surface, negative inside; its box begins at 0
    bool fromSelf = false;  ///< the kept model was its own exemplar
    bool guessed = false;   ///< see BlockSynthesisOptions
};

/// Where everything in a result came from: what `repeat` needs, in memory. Either `patches` or `elements` has
/// the sources. Plain values: a copy stands for itself.
struct SourceMap {
    MapMethod method = MapMethod::Synthesis;
    PatchMap patches;         ///< on the target's working box; of synthesis and fills
    ElementSources elements;  ///< of analogies
    int finer = 1;  ///< voxels of the target along one that `elements` counts; theirs and the exemplars'
                    ///< coordinates there are those of the map as it was made
    std::vector<MappedExemplar> exemplars;  ///< of an analogy the textured models
    std::vector<ExemplarVariant> variants;  ///< what `patches.exemplar` counts; empty: the exemplars
    IndexBox targetBox;                     ///< target's working box
    IndexBox targetDomain;
    std::array<bool, 6> cut{};  ///< faces of the target that clip and cap
    /// [voxels] side of the blocks that were matched; those that vote may be smaller. Islands, which have no
    /// place in a block, are told by it.
    int matched = 16;
    bool draft = false;    ///< matched at half the resolution, read without a widened band, normalised
    float band = 8;        ///< [voxels], distances were clamped there
    float halfWidth = 3;   ///< [voxels] of the result
    double voxelSize = 1;  ///< [world] of the exemplars
    MappedTarget target;   ///< of fills and analogies
    MappedAnalogy analogy;
    MappedHole hole;

    /// Number of models that repeat takes: the exemplars, then what a fill or an analogy was put on.
    std::size_t inputs() const {
        const bool self = method == MapMethod::Fill && hole.fromSelf;
        return (self ? 0 : exemplars.size()) + (method == MapMethod::Synthesis ? 0 : 1);
    }
};

/// What has the largest weight at a voxel of a map by blocks. With a variant the position lies between
/// voxels.
/// @param voxel  inside the target box
/// @throw Error InvalidOption (a map without blocks, a voxel outside)
Source strongestSource(const SourceMap& map, const Index3& voxel);

/// All sources that have at least a hundredth of the largest weight at a voxel of a map by blocks; of a map
/// that takes the first block's word, that one.
std::vector<Source> votingSources(const SourceMap& map, const Index3& voxel);

/// A voxel of a result and what has the largest weight there.
struct MappedVoxel {
    Index3 to;
    Source from;
};

/// The source of a voxel of a map whose elements count coarser ones: moved on from the middle of the one it
/// lies in, in the finer exemplar's coordinates.
Source finerSource(const SourceMap& map, std::size_t element, const Index3& voxel);
/// The voxel of the map as it was made that a finer one lies in.
Index3 coarserVoxel(const Index3& voxel, int factor);

/// The exemplar's voxel nearest to a source.
Index3 nearestVoxel(const Source& source);

/// A map by blocks, or of an analogy, for exemplars (and a target) of `factor` times the resolution: voxel i
/// is then the voxels factor * i + shift .. + factor - 1 whose centres lie in it, shift = -((factor - 1) /
/// 2). Sources of single voxels stay as they are; gatherThroughSources reads them finer.
/// @param factor  1..64   @throw Error ShapeMismatch (coordinates beyond 2^30)
SourceMap finerMap(const SourceMap& map, int factor);
/// One box as finerMap has it.
IndexBox finerBox(const IndexBox& box, int factor);

/// Checks what a file may hold and no run makes. @param what  begins the message
/// @throw Error BadData
void requireSound(const SourceMap& map, const std::string& what = "the source map");

}  // namespace vdbsynth
