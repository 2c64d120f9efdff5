#pragma once
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/pipeline/fill/fill.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <vector>

// Steps that fill and repeat share; for the .cpp files of fill only.
namespace vdbsynth {

inline constexpr float kFillBand = 8;  ///< [voxels] of distances that patches compare

/// Everything that is known before filling, over one box of the kept model's voxels.
struct Surroundings {
    IndexBox box;
    CutFaces cut{};
    BrickField known, hole,
        open;  ///< distances [voxels], distances to the hole, 1 where a sample is unknown
};

/// Without `open`. @throw Error Unusable (the hole lies outside the model's domain)
Surroundings surroundingsOf(const LevelSet& partial, const openvdb::FloatGrid& hole, IndexBox box,
                            const RunContext& ctx);

/// Fills `open`: 1 in the hole, and where a distance may refer to its inside. With a guess in the hole only,
/// since distances to the guess are as good as the guess.
void markOpen(Surroundings& around, bool guessed, const RunContext& ctx);

/// The kept model itself as an exemplar: its known distances, and 1 where they may be copied.
struct SelfExemplar {
    BrickField field, mask;
    IndexBox box;
};
SelfExemplar selfExemplar(const LevelSet& partial, const openvdb::FloatGrid& hole, const IndexBox& box,
                          bool guessed, const RunContext& ctx);

/// A separate exemplar in the form that patches read.
BrickField fillExemplar(const LevelSet& exemplar, const IndexBox& box, const CutFaces& cut,
                        const RunContext& ctx);

/// The hole of a map as a grid in the voxels of `like`.
FloatGridPtr holeGridOf(const MappedHole& hole, const openvdb::FloatGrid& like, const RunContext& ctx);

/// The kept model with a field in its hole, with attributes. @param from  what was copied from
LevelSet fillThroughMap(const SourceMap& map, const Surroundings& around, const BrickField& filled,
                        const LevelSet& partial, const openvdb::FloatGrid& hole, const LevelSet& from,
                        const RunContext& ctx);

/// repeatMap for a fill. @param exemplars  one, or none if the kept model was its own exemplar
LevelSet repeatFill(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                    const LevelSet& partial, const RunContext& ctx);

}  // namespace vdbsynth
