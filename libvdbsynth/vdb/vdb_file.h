#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/vdb/level_set.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth {

/// One grid of a VDB file, as `info` prints it.
struct GridSummary {
    std::string name;  ///< NAME[0], NAME[1], ... where several grids have it, as `gridName` takes it
    std::string type, gridClass;
    Vec3d voxelSize;
    bool linear = true, halfPrecision = false;
    Affine transform = kIdentity;  ///< from index space to the world; only where linear
    std::uint64_t activeVoxels = 0;
    IndexBox activeBox;
    bool isFloat = false;
    double background = 0, minimum = 0, maximum = 0;  ///< only where isFloat
    bool finite = true;                               ///< only where isFloat
    std::vector<std::pair<std::string, std::string>> metadata;
};

/// @throw Error InvalidOption (one is null), as for every function here that takes grids
void requireGrids(const std::vector<GridPtr>& grids);

std::vector<GridSummary> summarizeGrids(const std::vector<GridPtr>& grids);

/// File metadata: names and values.
using VdbMetadata = std::vector<std::pair<std::string, std::string>>;

struct VdbContents {
    std::vector<GridPtr> grids;
    VdbMetadata metadata;
};

/// All of a file. A grid of a kind that this OpenVDB does not support is left out with a warning, and
/// metadata of a newer vdb_synth (read/metadata_format.h) are a warning.
/// @throw Error Io (missing, a directory, not readable), BadData (not a VDB file, truncated, corrupt)
VdbContents readVdb(const std::string& path, const RunContext& ctx = {});

struct VdbReadOptions {
    /// Which grid, as its name or NAME[1] for the second of that name. Empty: "surface", else the first level
    /// set, else the first field of distances, else a fog volume with `iso`; a note names it where several
    /// could be meant.
    std::string gridName;
    /// A fog volume is solid where its value is above this; the surface of a field of distances without a
    /// class lies at this distance.
    std::optional<double> iso;
};

/// @throw Error InvalidOption (an iso that is not finite)
void validate(const VdbReadOptions& options);

/// Reads a model from any VDB file: sound level sets unchanged (half precision as floats, an anisotropic or
/// sheared transform resampled to its smallest voxel), others repaired (read/level_set_repair.h: turned
/// signs, lost insides, open cuts, wrong backgrounds), fields of no class as level sets if their values are
/// distances, fog volumes by `iso`. What is guessed or repaired is said in a note. A recorded domain is kept;
/// else the domain is the box of the solid. The domain of a solid that a clip cut open along planes ends at
/// them and counts as recorded, with air at the other sides.
/// @throw Error  Io (missing, a directory, not readable), BadData (not a VDB file, truncated, corrupt, NaN,
///               no usable grid, frustum transform), InvalidOption (an iso that is no number, null grids),
///               Unusable (a fog volume without iso), EmptyInput (no surface)
/// @par Repeats  same bits for any number of threads
LevelSet readVdbModel(const std::string& path, const VdbReadOptions& options = {},
                      const RunContext& ctx = {});

/// The same from grids in memory, which are not changed; the result shares a level set's tree.
/// @param path  for messages
LevelSet modelFromGrids(const std::string& path, const std::vector<GridPtr>& grids,
                        const VdbReadOptions& options = {}, const RunContext& ctx = {});

/// The grid that modelFromGrids would convert. @throw Error BadData (none is usable)
/// @param note  set to a sentence where several grids could be meant
GridPtr pickedGrid(const std::string& path, const std::vector<GridPtr>& grids,
                   const VdbReadOptions& options = {}, std::string* note = nullptr);

/// The model at another voxel size; its domain is the same box of the world in whole voxels. A level set is
/// resampled by its zero level, so detail under a voxel is lost, never added: what is lost is a warning.
/// Closed voids stay. @param name  begins the messages
/// @throw Error EmptyInput (nothing is left), Unusable (over half of the surface is lost), Memory
LevelSet resampled(const LevelSet& model, double voxelSize, const RunContext& ctx = {},
                   const std::string& name = "the model");

/// Reads a float or double grid unchanged: the named one, or the only one. @throw Error as readVdbModel
FloatGridPtr readVdbFloatGrid(const std::string& path, const std::string& name, const RunContext& ctx = {});
/// Reads one named grid of any type, by its name or NAME[1]. @throw Error as readVdbModel
GridPtr readVdbGrid(const std::string& path, const std::string& name, const RunContext& ctx = {});
/// All grids of a file. @throw Error as readVdbModel
std::vector<GridPtr> readVdbGrids(const std::string& path, const RunContext& ctx = {});

/// A grid's name, for callers without OpenVDB's headers.
std::string nameOf(const openvdb::GridBase& grid);

/// Writes grids to a VDB file. The random UUID in OpenVDB's header is replaced by one derived from the
/// content, so equal grids and metadata give equal bytes.
/// @throw Error Io (cannot be created, disk full)
void writeVdb(const std::string& path, const std::vector<GridPtr>& grids, const VdbMetadata& metadata);

}  // namespace vdbsynth
