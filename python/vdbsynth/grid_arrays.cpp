#include "python/vdbsynth/grid_arrays.h"

#include "python/vdbsynth/values.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/level_set.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth::python {
namespace {

constexpr double kMostVoxels = double(1ull << 33);

Index3 fromCoord(const openvdb::Coord& c) {
    return {c.x(), c.y(), c.z()};
}

void requireArrayBox(const IndexBox& box) {
    requireBox(box, "box");
    if (double(box.volume()) > kMostVoxels)
        throw Error(ErrorCode::Memory,
                    "`box` " + boxText(box) + ": has over 2^33 voxels; give a smaller one");
}

// Calls each(i, j, k, n) for the voxels of a box in the array's order.
template <typename Each>
void forEachOf(const Index3& size, const Each& each) {
    std::size_t n = 0;
    for (int i = 0; i < size.x; ++i)
        for (int j = 0; j < size.y; ++j)
            for (int k = 0; k < size.z; ++k) each(i, j, k, n++);
}

template <typename GridType>
py::array scalarsOf(const GridType& grid, const IndexBox& box) {
    using Number = typename GridType::ValueType;
    const Index3 size = box.size();
    py::array_t<Number> array({size.x, size.y, size.z});
    Number* to = array.mutable_data();
    const py::gil_scoped_release released;
    auto accessor = grid.getConstAccessor();
    forEachOf(size, [&](int i, int j, int k, std::size_t n) {
        to[n] = accessor.getValue(openvdb::Coord(box.min.x + i, box.min.y + j, box.min.z + k));
    });
    return std::move(array);
}

template <typename GridType>
py::array vectorsOf(const GridType& grid, const IndexBox& box) {
    using Number = typename GridType::ValueType::value_type;
    const Index3 size = box.size();
    py::array_t<Number> array({size.x, size.y, size.z, 3});
    Number* to = array.mutable_data();
    const py::gil_scoped_release released;
    auto accessor = grid.getConstAccessor();
    forEachOf(size, [&](int i, int j, int k, std::size_t n) {
        const auto value = accessor.getValue(openvdb::Coord(box.min.x + i, box.min.y + j, box.min.z + k));
        for (int c = 0; c < 3; ++c) to[3 * n + std::size_t(c)] = value[c];
    });
    return std::move(array);
}

using Scalars = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                  openvdb::Int64Grid, openvdb::BoolGrid>;
using Vectors = openvdb::TypeList<openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;
using AllGrids = Scalars::Append<Vectors>::Append<openvdb::MaskGrid>;

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
    const auto grid = GridType::create(background);
    const openvdb::Coord corner = placed(*grid, place);
    const Index3 size = sizeOf(array);
    const py::gil_scoped_release released;
    auto accessor = grid->getAccessor();
    forEachOf(size, [&](int i, int j, int k, std::size_t n) {
        const auto value = read(n);
        if (!(value == background)) accessor.setValue(corner.offsetBy(i, j, k), value);
    });
    grid->tree().prune();
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

std::string typeOf(const openvdb::GridBase& grid) {
    return grid.valueType();
}

Affine transformOfGrid(const openvdb::GridBase& grid) {
    const auto at = [&](double x, double y, double z) { return grid.indexToWorld(openvdb::Vec3d(x, y, z)); };
    const openvdb::Vec3d origin = at(0, 0, 0);
    Affine matrix = kIdentity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const openvdb::Vec3d step = at(axis == 0, axis == 1, axis == 2) - origin;
        for (std::size_t row = 0; row < 3; ++row) matrix[axis * 4 + row] = step[int(row)];
    }
    for (std::size_t row = 0; row < 3; ++row) matrix[12 + row] = origin[int(row)];
    return matrix;
}

Vec3d placeOfVoxel(const openvdb::FloatGrid& grid, const Index3& voxel) {
    const openvdb::Vec3d place = grid.indexToWorld(openvdb::Vec3d(voxel.x, voxel.y, voxel.z));
    return {place.x(), place.y(), place.z()};
}

std::uint64_t activeVoxelsOf(const openvdb::GridBase& grid) {
    return grid.activeVoxelCount();
}

IndexBox activeBoxOf(const openvdb::GridBase& grid) {
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) return {};
    return {fromCoord(box.min()), fromCoord(box.max())};
}

IndexBox activeBoxOfModel(const openvdb::FloatGrid& grid) {
    return activeBoxOf(grid);
}

py::array distancesOf(const openvdb::FloatGrid& grid, const IndexBox& box) {
    return valuesOf(grid, box);
}

GridPtr asGrid(const FloatGridPtr& grid) {
    return grid;
}

py::array valuesOf(const openvdb::GridBase& grid, const IndexBox& box) {
    requireArrayBox(box);
    py::array array;
    const bool known = grid.apply<Scalars>([&](const auto& typed) { array = scalarsOf(typed, box); }) ||
                       grid.apply<Vectors>([&](const auto& typed) { array = vectorsOf(typed, box); });
    if (!known) throw py::type_error("a grid of type " + typeOf(grid) + " has no numbers to give");
    return array;
}

py::array activeOf(const openvdb::GridBase& grid, const IndexBox& box) {
    requireArrayBox(box);
    const Index3 size = box.size();
    py::array_t<bool> array({size.x, size.y, size.z});
    bool* to = array.mutable_data();
    const bool known = grid.apply<AllGrids>([&](const auto& typed) {
        const py::gil_scoped_release released;
        auto accessor = typed.getConstAccessor();
        forEachOf(size, [&](int i, int j, int k, std::size_t n) {
            to[n] = accessor.isValueOn(openvdb::Coord(box.min.x + i, box.min.y + j, box.min.z + k));
        });
    });
    if (!known) throw py::type_error("a grid of type " + typeOf(grid) + " has no voxels to give");
    return std::move(array);
}

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
    const auto grid = openvdb::FloatGrid::create(limit);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::Coord corner = placed(*grid, place);
    const Index3 size = sizeOf(distances);
    const float* values = distances.data();
    const py::gil_scoped_release released;
    auto accessor = grid->getAccessor();
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
