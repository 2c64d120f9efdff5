#pragma once
#include "libvdbsynth/map/element_sources.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/math/vec3.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// The values that transferred attributes and grids have in a result.
enum class AttributeValues {
    Copied,  ///< the value at the source with the largest weight
    Blended  ///< of floats and vectors the mean over all sources, by their weights
};

/// The method that made a result, which determines how repeat applies the map.
enum class MapMethod {
    Synthesis,  ///< blocks of exemplars, over a separate target
    Fill,       ///< blocks of exemplars, in the hole of a model that is kept around it
    Analogy     ///< one source per voxel, near the surface of a plain model
};

/// One of the exemplars that a source map reads.
struct MappedExemplar {
    IndexBox box;  ///< working box [its index space]: its domain, enlarged where a method needs a margin
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

/// The target of fills and analogies, which is an input of repeat beside the sources.
struct MappedTarget {
    std::string hash;  ///< levelSetHash
    double voxelSize = 1;
    bool domainRecorded = false;
};

struct MappedAnalogy {
    double scale = 1;              ///< size of the texture, as Source::scale
    float strength = 1;            ///< 0..1
    std::vector<DepthRun> depths;  ///< ascending; below the first: as the first
    /// Strength times mask over the target box; its box begins at 0; empty box: `strength` everywhere.
    BrickField weight;
};

struct MappedHole {
    Index3 corner;          ///< of the field below [index space of the kept model]
    BrickField distance;    ///< [voxels] to the hole's surface, negative inside; its box begins at 0
    bool fromSelf = false;  ///< the kept model was its own exemplar
    bool guessed = false;   ///< see BlockSynthesisOptions
};

/// The sources of everything in a result: the input of `repeat`, in memory. Either `patches` or `elements`
/// has the sources. Plain values: a copy is independent.
struct SourceMap {
    MapMethod method = MapMethod::Synthesis;
    PatchMap patches;         ///< on the target's working box; of synthesis and fills
    ElementSources elements;  ///< of analogies
    int finer = 1;  ///< voxels of the target along one voxel of `elements`, whose coordinates, like the
                    ///< exemplars', stay at the original resolution
    std::vector<MappedExemplar> exemplars;  ///< of an analogy the textured models
    std::vector<ExemplarVariant> variants;  ///< what `patches.exemplar` numbers; empty: the exemplars
    IndexBox targetBox;                     ///< target's working box
    IndexBox targetDomain;
    std::array<bool, 6> cut{};  ///< faces of the target that clip and cap
    /// [voxels] side of the matched blocks; those that vote may be smaller. The size limit
    /// of islands follows from it.
    int matched = 16;
    bool draft = false;    ///< matched at half the resolution, read without a widened band, normalised
    float band = 8;        ///< [voxels], limit of the distances
    float halfWidth = 3;   ///< [voxels] of the result
    double voxelSize = 1;  ///< [world] of the exemplars
    Vec3d moved;           ///< [world] of a synthesis: from where the first exemplar's voxels put the result
    MappedTarget target;   ///< of fills and analogies
    MappedAnalogy analogy;
    MappedHole hole;

    /// Number of models that repeat takes: the exemplars, then the target of a fill or an analogy.
    std::size_t inputs() const {
        const bool self = method == MapMethod::Fill && hole.fromSelf;
        return (self ? 0 : exemplars.size()) + (method == MapMethod::Synthesis ? 0 : 1);
    }
};

/// The source with the largest weight at a voxel of a map by blocks. With a variant the
/// position lies between voxels.
/// @param voxel  inside the target box
/// @throw Error InvalidOption (a map without blocks, a voxel outside)
Source strongestSource(const SourceMap& map, const Index3& voxel);

/// All sources with at least a hundredth of the largest weight at a voxel of a map by blocks; with
/// PatchVote::First only the first block's.
std::vector<Source> votingSources(const SourceMap& map, const Index3& voxel);

/// A voxel of a result and the source with the largest weight there.
struct MappedVoxel {
    Index3 to;
    Source from;
};

/// The source of a voxel of a map whose elements are coarser: offset from the middle of the coarse voxel it
/// lies in, in the finer exemplar's coordinates.
Source finerSource(const SourceMap& map, std::size_t element, const Index3& voxel);
/// The voxel of the original map that contains a finer one.
Index3 coarserVoxel(const Index3& voxel, int factor);

/// The exemplar's voxel nearest to a source.
Index3 nearestVoxel(const Source& source);

/// A map by blocks, or of an analogy, for exemplars (and a target) of `factor` times the resolution: voxel i
/// then becomes the voxels factor * i + shift .. + factor - 1 whose centres lie in it, shift = -((factor - 1)
/// / 2). Sources of single voxels do not change; gatherThroughSources reads them finer.
/// @param factor  1..64   @throw Error ShapeMismatch (coordinates beyond 2^30)
SourceMap finerMap(const SourceMap& map, int factor);
/// One box, scaled as by finerMap.
IndexBox finerBox(const IndexBox& box, int factor);

/// Checks for what a file may hold but no run writes. @param what  begins the message
/// @throw Error BadData
void requireSound(const SourceMap& map, const std::string& what = "the source map");

}  // namespace vdbsynth
