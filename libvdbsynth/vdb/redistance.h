#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/level_set.h"

#include <array>

namespace vdbsynth {

/// Distances to the zero level of any field whose sign says inside and outside: a valid narrow band. The
/// zero level is meshed and projected (zero_level.h), distances are exact to that mesh, signs are those of
/// the field, so cavities that no outside path reaches keep theirs.
/// @param field      negative inside; any transform of uniform voxels, which the result keeps
/// @param halfWidth  [voxels], at least 1.5
/// @throw Error EmptyInput "WHAT has no surface ..."
/// @par Repeats same bits for any number of threads
FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx = {});

/// Which faces of a domain cut through the solid: low and high face of x, y, z.
using CutFaces = std::array<bool, 6>;

/// The level set over `domain` as distances [voxels] clamped to [-halfWidth, halfWidth], in a field that
/// begins at 0. The band is widened by exact distances to the zero level; what the level set has of its own
/// stays where it is a distance (gradient within 0.3 of 1) and within 0.2 voxels of that to the mesh, since a
/// mesh lies inside what is round, by a tenth of a voxel in a bar three voxels thick. At a cut face the caps
/// of a clipped model do not count: the last layer of voxels inside is taken to go on beyond the face, so
/// that a block beside a cut sees material, not the cut.
/// @par Repeats same bits for any number of threads
BrickField widenBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                     float halfWidth, const RunContext& ctx = {});

/// widenBand at half the resolution: a field of ceil(n/2) voxels a side, distances in its own, doubled
/// voxels.
BrickField widenBandCoarse(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                           float halfWidth, const RunContext& ctx = {});

inline constexpr CutFaces kAllCut{true, true, true, true, true, true};

/// A field [voxels] closed by caps half a voxel outside the cut faces of `domain`, over the domain grown by
/// the band. Beyond the field's own box its nearest samples go on.
BrickField closeField(const BrickField& field, const IndexBox& domain, const CutFaces& cut, float limit,
                      const RunContext& ctx = {});

/// A field [voxels] as a level set, its voxel 0 at `corner`, its voxel size and rotation those of
/// `like`, closed by caps half a voxel outside the cut faces, then rebuilt to `halfWidth`; good distances
/// stay, as in widenBand. Large ones are rebuilt in parts, with the same bits.
/// @throw Error EmptyInput (no surface)
FloatGridPtr closeAndRebuild(const BrickField& field, const Index3& corner, const CutFaces& cut,
                             float halfWidth, const openvdb::FloatGrid& like, const std::string& what,
                             const RunContext& ctx = {});

/// closeAndRebuild to kHalfWidth at a fraction of its cost: the field keeps its zero level and its values are
/// made distances by a few steps of the eikonal equation (OpenVDB's level set tracker), of first order where
/// the rebuild is exact. For drafts.
FloatGridPtr closeAndNormalize(const BrickField& field, const Index3& corner, const CutFaces& cut,
                               const openvdb::FloatGrid& like, const std::string& what,
                               const RunContext& ctx = {});

/// The level set over `domain` as distances [voxels] as they are, clamped to its narrow band, in a field that
/// begins at 0; for what is only read, not searched.
BrickField gatherNarrowBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
