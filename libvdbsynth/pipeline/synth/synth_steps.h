#pragma once
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/synth/block_synthesis.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/control_grids.h"

#include <memory>
#include <vector>

// Steps that synth and repeat share; for the .cpp files of synth only.
namespace vdbsynth {

using LevelSets = std::vector<const LevelSet*>;

struct SynthPlan {
    BlockSynthesisOptions block;
    SourceMap map;
    double bytes = 0;  ///< that the run is expected to need
};

/// True if places of the result have exemplars of their own rotation or scale.
bool rotatesOrScales(const SynthOptions& options);

/// Sets the rotations of what is wanted by SynthOptions::direction, along the direction of each one's
/// exemplar, in the voxels of `frame`; a note says which directions were taken where none was given.
/// @param wanted  of every variantPlaces(frame)
/// @throw Error as directionsInSpace (pipeline/direction/place_directions.h)
void rotateAlong(const SynthOptions& options, const LevelSets& exemplars, const ControlFrame& frame,
                 const IndexBox& domain, std::vector<WantedVariant>& wanted, const RunContext& ctx);

/// Exemplars as blocks are searched in them (at half the resolution for a draft), and as the result is read
/// from them; without variants. The same fields but for a draft.
struct SearchedFields {
    ExemplarFields searched, read;
};

/// All boxes and options of a run, at half the resolution for a draft whose exemplars are large enough;
/// checks what needs no field. @throw Error as synthesize
SynthPlan planSynthesis(const LevelSets& exemplars, const SynthOptions& options, const RunContext& ctx);

/// @return bytes that a result through a map needs @throw Error Memory
double requireMemoryFor(const RunContext& ctx, const SourceMap& map, const LevelSets& exemplars);

/// How far a domain is moved so that its minimum corner comes to `origin`. [world]
Vec3d movedTo(const Vec3d& origin, const IndexBox& domain, const openvdb::FloatGrid& like);

/// A grid at another place, which shares the other's tree. [world]
FloatGridConstPtr movedGrid(const openvdb::FloatGrid& grid, const Vec3d& by);

SearchedFields gatherExemplars(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx);

/// The fields that a map's result is read from, a draft's too; without variants.
ExemplarFields gatherForVote(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx);

/// The voted field as a level set. Islands are removed first: connected components, solid or void, that are
/// smaller than the smallest of any exemplar (of those that touch no face: than the smallest hundredth) and
/// than (block/2)^3 voxels. Votes of blocks that disagree leave them; no exemplar has any.
/// @param exemplars  that the result was read from, without variants
LevelSet finishSynthesis(const SourceMap& map, BrickField voted, const ExemplarFields& exemplars,
                         const openvdb::FloatGrid& like, const RunContext& ctx);

}  // namespace vdbsynth
