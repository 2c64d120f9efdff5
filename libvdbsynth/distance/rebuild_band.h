#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/affine.h"

#include <functional>
#include <memory>

namespace vdbsynth {

struct RebuildOptions {
    float halfWidth = 3;  ///< [voxels] of the rebuilt band, at least 1.5
    float voxelSize = 1;  ///< what one voxel is in the unit of the field's values
    /// True: distances that the field has of its own stay where they are good ones (signed_distance.h), up to
    /// `band`; false: only its zero level is meant.
    bool keepDistances = false;
    float band = 3;  ///< [voxels] where the field's own distances end
    /// Of the faces that distances are measured to, where the band is rebuilt in one part (else Inward). It
    /// decides the last bit of some distances, nothing else.
    Facing facing = Facing::Inward;
};

/// Gives a field that covers a box of index space at least, for as long as a part needs it.
using FieldReader = std::function<std::shared_ptr<const BrickField>(const IndexBox& box)>;
/// Takes one part of a rebuilt band, from the calling thread in a fixed order: distances [voxels] over a box
/// of index space in whole cubes of 8 voxels, at multiples of 8.
using PartTaker = std::function<void(const BrickField& part)>;

/// Distances to the zero level of a field whose sign says inside and outside, as a valid narrow band: the
/// zero level is meshed (zero_level.h), distances are exact to that mesh, signs are those of the field, so
/// cavities that no outside path reaches keep theirs. Large boxes are rebuilt in parts, with the same bits:
/// meshes and distances of all of it at once take several times the memory of the result.
/// @param read  called from many threads
/// @param box   of index space: what the band may touch
/// @throw Error Cancelled
/// @par Repeats same bits for any number of threads
void rebuildBand(const FieldReader& read, const IndexBox& box, const RebuildOptions& options,
                 const PartTaker& take, const RunContext& ctx = {});

/// Where the voxels of one lattice lie in another.
struct LatticeMap {
    Affine toField;    ///< from the result's index space to the field's
    Affine fromField;  ///< its inverse
};

/// rebuildBand on another lattice, of any scale, rotation or shear: the zero level is meshed in the voxels of
/// the field or of the result, whichever are smaller, distances to it are measured in the result's, signs are
/// those of the trilinear field. So a closed void stays one as long as a voxel of the result lies in it.
/// @param options  its voxelSize, keepDistances and band are in voxels of the result
/// @param box      of the result's index space: what the band may touch
/// @throw Error Cancelled
/// @par Cost    as rebuildBand; coarser by a factor f: as of the field, at most (1 + 16 f / 1024)^3 times
/// @par Repeats same bits for any number of threads
void resampleBand(const FieldReader& read, const LatticeMap& map, const IndexBox& box,
                  const RebuildOptions& options, const PartTaker& take, const RunContext& ctx = {});

/// rebuildBand of a whole field, as one.
/// @param field  in index space
/// @return distances [voxels] over the field's box grown by the half-width to whole cubes of 8 voxels at
///         multiples of 8
BrickField rebuiltBand(const BrickField& field, const RebuildOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
