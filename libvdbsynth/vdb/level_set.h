#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

/// A model as all commands use it: a narrow-band level set, negative inside, with a domain.
struct LevelSet {
    FloatGridPtr grid;                  ///< name "surface", class level set, uniform voxels
    IndexBox domain;                    ///< the box that sizes and statistics refer to
    bool domainRecorded = false;        ///< false: the domain is the box of the solid
    std::vector<GridPtr> attributes{};  ///< other grids of the model, of any kind: colour, density, ...
    /// [world] the source mesh, if it was requested
    std::shared_ptr<const Mesh> source{};
};

inline constexpr float kHalfWidth = 3.f;  ///< [voxels] of every level set by default
inline constexpr const char* kSurfaceName = "surface";
inline constexpr const char* kDomainKey =
    "vdbsynth:domain";  ///< metadata `i,j,k,I,J,K`, both corners inclusive

/// What every function requires of a model, null or not: a level set (no fog volume) of cubic voxels, finite
/// values and a band of at least 1.5 voxels a side, and a nonempty domain within 2^28 voxels of the origin.
/// modelFromGrids (vdb_file.h) converts any grid.
/// @param what  begins the message, for example "the exemplar"
/// @throw Error InvalidOption (null model or grid, bad domain), Unusable (another kind of grid, voxels that
/// are not cubes, a band too narrow), EmptyInput (no active voxels), BadData (NaN or infinite values)
/// @par Cost  reads every value once
void requireModel(const LevelSet* model, const std::string& what, const RunContext& ctx = {});
/// @param field  names the options' field @throw Error InvalidOption (empty, or beyond 2^28)
void requireBox(const IndexBox& box, const std::string& field);
/// @param field  names the options' field @throw Error InvalidOption (not from 1.5 to 100 voxels)
void requireHalfWidth(double halfWidth, const std::string& field = "halfWidth");

/// A copy that shares no grid with the model.
LevelSet withOwnGrids(const LevelSet& model);

std::string boxText(const IndexBox& box);
/// Parses `i,j,k,I,J,K`. @return false unless it is exactly six whole numbers within 2^28, min <= max
bool parseBox(const std::string& text, IndexBox& box);

/// [world] length of a voxel side.
double voxelSizeOf(const openvdb::FloatGrid& grid);
/// From index space to the world.
Affine transformOf(const openvdb::FloatGrid& grid);
/// Box of the solid: the voxels with a negative value.
/// @throw Error EmptyInput "WHAT has no inside ..."
IndexBox solidBox(const openvdb::FloatGrid& grid, const std::string& what);
/// Number of voxels with a negative value, from the tree's leaves and tiles.
double solidVoxels(const openvdb::FloatGrid& grid);
/// A copy whose tree is shared and whose transform is the identity.
FloatGridPtr inIndexSpace(const openvdb::FloatGrid& grid);
/// Half-width of the band [voxels], from the background value.
double halfWidthOf(const openvdb::FloatGrid& grid);
std::size_t activeVoxels(const openvdb::FloatGrid& grid);
/// Sets name, class and the domain's metadata.
void stampLevelSet(LevelSet& levelSet);
/// Hash of values, active states (of leaves and tiles), background and transform; not of metadata.
std::string levelSetHash(const openvdb::FloatGrid& grid);

/// How close a level set is to a distance field, measured on its active voxels within the band.
struct BandQuality {
    /// Mean of | |grad| - 1 | where |value| < 1 voxel, by central or upwind differences, whichever is closer
    /// to 1: on the ridge inside a wall or bar a true distance has no central gradient.
    double gradientErrorMean = 0;
    double gradientErrorP99 = 0;
    std::size_t measured = 0;           ///< voxels that were measured
    std::size_t missingNeighbours = 0;  ///< active voxels next to the zero level with an inactive neighbour
    bool finite = true;
};
BandQuality measureBand(const openvdb::FloatGrid& grid, const RunContext& ctx = {});

/// The range of a grid's active voxels and tiles, and whether all its values, including
/// inactive ones, are finite.
struct ValueRange {
    double minimum = 0, maximum = 0;
    bool finite = true;
};

ValueRange rangeOf(const openvdb::FloatGrid& grid);

/// A float grid unchanged, a double grid converted to floats, null for any other kind.
FloatGridPtr asFloat(const GridPtr& grid);

}  // namespace vdbsynth
