#pragma once
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <pybind11/numpy.h>

#include <optional>
#include <string>

// OpenVDB grids as arrays and back. Arrays are [x, y, z] (z fastest), of vectors [x, y, z, 3]; element (i, j,
// k) of an array of a box is the voxel box.min + (i, j, k).
namespace vdbsynth::python {
namespace py = pybind11;

/// The type of a grid as OpenVDB names it: float, vec3s, ...
std::string typeOf(const openvdb::GridBase& grid);
Affine transformOfGrid(const openvdb::GridBase& grid);
/// [world] where the middle of a voxel is.
Vec3d placeOfVoxel(const openvdb::FloatGrid& grid, const Index3& voxel);
std::uint64_t activeVoxelsOf(const openvdb::GridBase& grid);
/// The box of the active voxels; empty: there are none.
IndexBox activeBoxOf(const openvdb::GridBase& grid);
IndexBox activeBoxOfModel(const openvdb::FloatGrid& grid);

/// All values in a box, those of tiles and of the background included.
/// @throw TypeError (a grid without numbers, such as points), Error InvalidOption (an empty box), Memory
/// (over 2^33 voxels)
py::array valuesOf(const openvdb::GridBase& grid, const IndexBox& box);
/// The same for a level set: distances [world].
py::array distancesOf(const openvdb::FloatGrid& grid, const IndexBox& box);
/// Truths [x, y, z]: which voxels are active.
py::array activeOf(const openvdb::GridBase& grid, const IndexBox& box);

/// The lattice of an array's voxels. Where the origin is a whole number of voxels from zero, as for grids
/// that this library makes, the transform stays a pure scale and indices begin at that number; else at 0, and
/// the transform is translated.
struct ArrayPlace {
    double voxelSize = 1;  ///< [world] above 0
    Vec3d origin;          ///< [world] the middle of the first voxel
};
/// @throw Error InvalidOption (a voxel size that is not above 0, numbers that are not finite)
void requirePlace(const ArrayPlace& place);

/// A grid of an array's type: float32 float, float64 double, int32, int64, bool, or vectors of float32 vec3s.
/// Voxels that differ from the background are active.
/// @throw TypeError (another type of numbers), ValueError (another number of dimensions)
GridPtr gridOfArray(const std::string& name, const py::array& array, const ArrayPlace& place,
                    double background);

/// Calls each(i, j, k, n) for the voxels of a box in the array's order.
template <typename Each>
void forEachOf(const Index3& size, const Each& each) {
    std::size_t n = 0;
    for (int i = 0; i < size.x; ++i)
        for (int j = 0; j < size.y; ++j)
            for (int k = 0; k < size.z; ++k) each(i, j, k, n++);
}

/// The index of an array's first voxel, and what its transform is translated by [world].
struct ArrayCorner {
    Index3 first;
    Vec3d moved;
};
ArrayCorner cornerOf(const ArrayPlace& place);

/// Signed distances [world] as a level set's grid, clamped to the band; active within it.
/// @param halfWidth  [voxels]
FloatGridPtr bandOfArray(const py::array_t<float, py::array::c_style | py::array::forcecast>& distances,
                         const ArrayPlace& place, double halfWidth);
/// The same tree under metadata and a transform of its own.
FloatGridPtr sharedCopy(const openvdb::FloatGrid& grid);
/// For callers without OpenVDB's headers.
GridPtr asGrid(const FloatGridPtr& grid);
void setName(openvdb::GridBase& grid, const std::string& name);
/// Moves a grid in the world.
void translate(openvdb::FloatGrid& grid, const Vec3d& by);

}  // namespace vdbsynth::python
