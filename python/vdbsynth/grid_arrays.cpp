#include "python/vdbsynth/grid_arrays.h"

#include "python/vdbsynth/values.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

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

template <typename GridType>
py::array scalarsOf(const GridType& grid, const IndexBox& box) {
    using Number = typename GridType::ValueType;
    const Index3 size = box.size();
    py::array_t<Number> array({size.x, size.y, size.z});
    Number* to = array.mutable_data();
    const py::gil_scoped_release released;
    const openvdb::tree::ValueAccessor<const typename GridType::TreeType, false> accessor(grid.tree());
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
    const openvdb::tree::ValueAccessor<const typename GridType::TreeType, false> accessor(grid.tree());
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
        using TreeType = typename std::decay_t<decltype(typed)>::TreeType;
        const openvdb::tree::ValueAccessor<const TreeType, false> accessor(typed.tree());
        forEachOf(size, [&](int i, int j, int k, std::size_t n) {
            to[n] = accessor.isValueOn(openvdb::Coord(box.min.x + i, box.min.y + j, box.min.z + k));
        });
    });
    if (!known) throw py::type_error("a grid of type " + typeOf(grid) + " has no voxels to give");
    return std::move(array);
}

}  // namespace vdbsynth::python
