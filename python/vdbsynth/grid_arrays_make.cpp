// Grids of arrays. The grids themselves are made by OpenVDB's registry: the code of a new grid of each type
// would take a minute to compile.
#include "python/vdbsynth/grid_arrays.h"

#include "python/vdbsynth/values.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <cmath>

namespace vdbsynth::python {
namespace {

template <typename GridType>
typename GridType::Ptr created(const typename GridType::ValueType& background) {
    openvdb::initialize();
    const auto grid = openvdb::gridPtrCast<GridType>(openvdb::GridBase::createGrid(GridType::gridType()));
    grid->tree().root().setBackground(background, /* updateChildNodes= */ false);
    return grid;
}

// The transform of an array's voxels, and the index of its first one.
openvdb::Coord placed(openvdb::GridBase& grid, const ArrayPlace& place) {
    grid.setTransform(openvdb::math::Transform::createLinearTransform(place.voxelSize));
    const auto [first, moved] = cornerOf(place);
    if (moved.x != 0 || moved.y != 0 || moved.z != 0)
        grid.transform().postTranslate({moved.x, moved.y, moved.z});
    return {first.x, first.y, first.z};
}

Index3 sizeOf(const py::array& array) {
    return {int(array.shape(0)), int(array.shape(1)), int(array.shape(2))};
}

template <typename GridType, typename Read>
GridPtr filled(const py::array& array, const ArrayPlace& place,
               const typename GridType::ValueType& background, const Read& read) {
    const auto grid = created<GridType>(background);
    const openvdb::Coord corner = placed(*grid, place);
    const Index3 size = sizeOf(array);
    const py::gil_scoped_release released;
    openvdb::tree::ValueAccessor<typename GridType::TreeType, false> accessor(grid->tree());
    forEachOf(size, [&](int i, int j, int k, std::size_t n) {
        const auto value = read(n);
        if (!(value == background)) accessor.setValue(corner.offsetBy(i, j, k), value);
    });
    return grid;
}

template <typename GridType>
GridPtr scalarGrid(const py::array& given, const ArrayPlace& place, double background) {
    using Number = typename GridType::ValueType;
    const py::array_t<Number, py::array::c_style | py::array::forcecast> array(given);
    return filled<GridType>(array, place, Number(background), [&](std::size_t n) { return array.data()[n]; });
}

GridPtr vectorGrid(const py::array& given, const ArrayPlace& place, double background) {
    const py::array_t<float, py::array::c_style | py::array::forcecast> array(given);
    const float* values = array.data();
    return filled<openvdb::Vec3SGrid>(array, place, openvdb::Vec3s(float(background)), [&](std::size_t n) {
        return openvdb::Vec3s(values[3 * n], values[3 * n + 1], values[3 * n + 2]);
    });
}

}  // namespace

void requirePlace(const ArrayPlace& place) {
    if (!(place.voxelSize > 0) || !std::isfinite(place.voxelSize))
        throw Error(ErrorCode::InvalidOption,
                    "`voxel_size` " + realText(place.voxelSize) + ": must be above 0");
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(place.origin[axis]))
            throw Error(ErrorCode::InvalidOption,
                        "`origin` " + realText(place.origin[axis]) + ": must be finite");
}

GridPtr gridOfArray(const std::string& name, const py::array& array, const ArrayPlace& place,
                    double background) {
    requirePlace(place);
    const bool vectors = array.ndim() == 4 && array.shape(3) == 3;
    if (array.ndim() != 3 && !vectors)
        throw py::value_error("`" + name +
                              "`: must be an array [x, y, z], or of vectors [x, y, z, 3], not of " +
                              std::to_string(array.ndim()) + " dimensions");
    for (int axis = 0; axis < 3; ++axis)
        if (array.shape(axis) == 0 || array.shape(axis) > 1 << 20)
            throw py::value_error("`" + name + "`: must have from 1 to 1048576 voxels along each axis");
    const char kind = array.dtype().kind();
    const py::ssize_t bytes = array.dtype().itemsize();
    if (vectors && kind == 'f') return vectorGrid(array, place, background);
    if (!vectors && kind == 'b') return scalarGrid<openvdb::BoolGrid>(array, place, background);
    if (!vectors && kind == 'f')
        return bytes > 4 ? scalarGrid<openvdb::DoubleGrid>(array, place, background)
                         : scalarGrid<openvdb::FloatGrid>(array, place, background);
    if (!vectors && (kind == 'i' || (kind == 'u' && bytes < 8)))
        return bytes > 4 || (kind == 'u' && bytes == 4)
                   ? scalarGrid<openvdb::Int64Grid>(array, place, background)
                   : scalarGrid<openvdb::Int32Grid>(array, place, background);
    throw py::type_error("`" + name + "`: must be floats, whole numbers, truths, or vectors of floats, not " +
                         py::cast<std::string>(py::str(array.dtype())));
}

FloatGridPtr bandOfArray(const py::array_t<float, py::array::c_style | py::array::forcecast>& distances,
                         const ArrayPlace& place, double halfWidth) {
    requirePlace(place);
    requireHalfWidth(halfWidth);
    const float limit = float(halfWidth * place.voxelSize);
    const auto grid = created<openvdb::FloatGrid>(limit);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::Coord corner = placed(*grid, place);
    const Index3 size = sizeOf(distances);
    const float* values = distances.data();
    const py::gil_scoped_release released;
    openvdb::tree::ValueAccessor<openvdb::FloatTree, false> accessor(grid->tree());
    forEachOf(size, [&](int i, int j, int k, std::size_t n) {
        const openvdb::Coord voxel = corner.offsetBy(i, j, k);
        if (values[n] >= limit) return;
        if (values[n] <= -limit)
            accessor.setValueOff(voxel, -limit);
        else
            accessor.setValue(voxel, values[n]);  // NaN too, which modelFromGrids refuses
    });
    grid->tree().prune();
    return grid;
}

ArrayCorner cornerOf(const ArrayPlace& place) {
    Index3 first;
    for (int axis = 0; axis < 3; ++axis) {
        const double voxels = place.origin[axis] / place.voxelSize, nearest = std::round(voxels);
        if (!(std::abs(voxels - nearest) < 1e-4 && std::abs(nearest) < double(1 << 28)))
            return {{0, 0, 0}, place.origin};
        first[axis] = int(nearest);
    }
    return {first, {0, 0, 0}};
}

FloatGridPtr sharedCopy(const openvdb::FloatGrid& grid) {
    // Tree and grid are shared until one of them is changed, which nothing here does.
    return openvdb::gridPtrCast<openvdb::FloatGrid>(const_cast<openvdb::FloatGrid&>(grid).copyGrid());
}

void setName(openvdb::GridBase& grid, const std::string& name) {
    grid.setName(name);
}

void translate(openvdb::FloatGrid& grid, const Vec3d& by) {
    grid.transform().postTranslate({by.x, by.y, by.z});
}

}  // namespace vdbsynth::python
