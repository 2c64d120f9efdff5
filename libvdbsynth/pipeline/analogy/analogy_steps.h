#pragma once
#include "libvdbsynth/analogy/volume_analogy.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/convert/domain_faces.h"

#include <memory>

// Steps of analogy; for its .cpp files only.
namespace vdbsynth {

/// Placement of a field's voxels: voxel p of the field is at index corner + p * step of a grid.
struct FieldPlace {
    const openvdb::FloatGrid* like = nullptr;
    Vec3d corner;
    double step = 1;

    Vec3d toWorld(const Vec3d& voxel) const;
    /// Of a direction, in voxels.
    Vec3d fromWorldDirection(const Vec3d& direction) const;
};

inline constexpr int kMostReach = 40;  ///< [voxels] farthest that a texture may reach from its plain surface

/// @throw Error ShapeMismatch unless the models of a pair have the same voxels
void requireOnePlace(const AnalogyModelPair& pair);

/// A pair as fields over one box, at the texture's scale.
struct PairFields {
    std::shared_ptr<const BrickField> plain, textured;
    IndexBox box;            ///< index space of the pair
    IndexBox inner;          ///< of the fields
    CutFaces cutTextured{};  ///< faces of the box where the textured solid continues beyond
    FieldPlace place;
};

/// @throw Error ShapeMismatch (other voxels, or no overlap), Memory
PairFields gatherPair(const AnalogyModelPair& pair, double scale, const RunContext& ctx);

/// A field in larger or smaller voxels; distances are in its own.
BrickField scaledField(const BrickField& field, double scale, const RunContext& ctx);

inline constexpr int kDraftLevels = 2;  ///< of its half resolution: its band is no wider than else

/// How far textures reach from the plain surfaces and how deep they dig [voxels].
struct TextureDepth {
    float reach = 0;
    float dig = 0;  ///< -1 if a pair's does so at all depths
};

struct PreparedPairs {
    AnalogyOptions options;                 ///< that they were prepared with
    std::vector<LevelSet> plain, textured;  ///< of each pair
    std::vector<PairFields> fields;         ///< at the target's resolution
    std::vector<FieldPlace> places;         ///< of the fields that are searched
    TextureDepth depth;
    std::shared_ptr<const TrainedPairs> trained;
};

/// preparePairs, of valid options and pairs.
std::shared_ptr<const PreparedPairs> preparedPairs(const std::vector<AnalogyModelPair>& pairs,
                                                   const AnalogyOptions& options, const RunContext& ctx);

/// The pairs as a draft searches them, at half the scale.
std::vector<PairFields> halvedPairs(const std::vector<PairFields>& fields, const RunContext& ctx);

/// The target's distances up to `band` [voxels] as a draft searches them, in voxels of twice the size.
std::shared_ptr<const BrickField> halvedTarget(const LevelSet& target, const IndexBox& box,
                                               const CutFaces& cut, float band, const RunContext& ctx);

/// The sources of a draft's voxels for the eight of the target that each stands for, still in voxels of the
/// draft's pairs.
VolumeAnalogyResult refinedDraft(const VolumeAnalogyResult& draft, const IndexBox& target);

/// A textured model over a box of its index space at the texture's scale, as gatherPair makes it.
BrickField gatherTextured(const LevelSet& textured, const IndexBox& box, const CutFaces& cut, float reach,
                          double scale, const RunContext& ctx);

/// A position as a map's file holds it: a voxel, and single precision from there.
Vec3d asWritten(const Vec3d& position);

/// The result of a map applied to textured fields and a plain model, rebuilt and stamped; without attributes.
/// @param factor  see finerMap; `map` is at its original resolution
/// @param plain   distances over the target's box [voxels of the target]
/// @param reach   [voxels] depth of the texture, for a message; 0: unknown
LevelSet analogyThroughMap(const SourceMap& map, int factor, const std::vector<ExemplarSamples>& textured,
                           const BrickField& plain, const LevelSet& target, float reach,
                           const RunContext& ctx);

/// The grids of a result: those of the textured models through the map, but where a mask keeps the target,
/// over the target's own.
/// @param map    at the result's resolution   @param plain  as for analogyThroughMap
std::vector<GridPtr> analogyAttributes(const SourceMap& map, const std::vector<const LevelSet*>& textured,
                                       const BrickField& plain, const LevelSet& target,
                                       const openvdb::FloatGrid& result, const RunContext& ctx);

/// repeatMap for an analogy.
LevelSet repeatAnalogy(const SourceMap& map, int factor, const std::vector<const LevelSet*>& textured,
                       const LevelSet& target, const RunContext& ctx);

/// Largest distance of the textured surface from the plain one. [voxels]
float reachOf(const BrickField& plain, const BrickField& textured);

/// How deep a texture digs: largest depth below the plain surface that the textured model leaves empty.
/// [voxels]
/// @return -1 if it is empty at all depths, as with holes and shells
float digOf(const BrickField& plain, const BrickField& textured);

/// The share of the texture's depth at every voxel of the target that leaves a core of 1.5 voxels in its
/// local thickness [hildebrand1997]; see ThinParts. Says on what share of the surface it is under 1.
/// @param plain  distances of the target [voxels], valid up to `band`; box begins at 0
/// @param dig    digOf   @param reach  of the texture [voxels]
/// @return empty where nothing is too thin, or `dig` is under 1
/// @throw Error Memory, Cancelled   @par Repeats same bits for any number of threads
BrickField thinWeight(const BrickField& plain, float dig, float reach, float band,
                      const AnalogyOptions& options, const RunContext& ctx);

/// Frames around a field's surface, from a source of directions.
/// @param what   for messages, such as "the target"
/// @param field  the options' field that the source is from, for messages
/// @throw Error Unusable (no direction anywhere), EmptyInput, BadData (a grid of another kind)
FrameField framesOf(std::shared_ptr<const BrickField> distance, const FieldPlace& place,
                    const DirectionSource& source, const std::string& what, const std::string& field,
                    const RunContext& ctx);

}  // namespace vdbsynth
