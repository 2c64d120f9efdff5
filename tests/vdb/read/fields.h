#pragma once
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <cmath>
#include <functional>

// Fields as other programs write them, for the tests of what reads them.
namespace vdbsynth::test {

using Field = std::function<double(const openvdb::Vec3d&)>;

/// Distances [voxels] to a ball around the origin.
inline Field ballField(double radius) {
    return [radius](const openvdb::Vec3d& p) { return p.length() - radius; };
}

/// Distances [voxels] to a box around the origin.
inline Field boxField(const openvdb::Vec3d& half) {
    return [half](const openvdb::Vec3d& p) {
        openvdb::Vec3d out;
        double deepest = -1e9;
        for (int i = 0; i < 3; ++i) {
            out[i] = std::max(0.0, std::abs(p[i]) - half[i]);
            deepest = std::max(deepest, std::abs(p[i]) - half[i]);
        }
        return deepest > 0 ? out.length() : deepest;
    };
}

/// Every voxel within `reach` of the origin along each axis, as arrays are copied into a grid.
inline openvdb::FloatGrid::Ptr denseGrid(const Field& field, int reach, double voxel, float background) {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
    auto accessor = grid->getAccessor();
    for (auto it = openvdb::CoordBBox(openvdb::Coord(-reach), openvdb::Coord(reach)).begin(); it; ++it)
        accessor.setValue(*it, float(field((*it).asVec3d()) * voxel));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    grid->setName("field");
    return grid;
}

struct Band {
    double outside = 3, inside = 3;        // [voxels]
    double background = 3, interior = -3;  // [voxels] stored
    double sign = 1;                       // of the active values
};

/// A narrow band, with what is stored around it.
inline openvdb::FloatGrid::Ptr bandGrid(const Field& field, int reach, double voxel, const Band& band = {}) {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(float(band.background * voxel));
    auto accessor = grid->getAccessor();
    for (auto it = openvdb::CoordBBox(openvdb::Coord(-reach), openvdb::Coord(reach)).begin(); it; ++it) {
        const double distance = field((*it).asVec3d());
        if (distance < band.outside && distance > -band.inside)
            accessor.setValue(*it, float(band.sign * distance * voxel));
        else if (distance < 0)
            accessor.setValueOff(*it, float(band.interior * voxel));
    }
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName("field");
    return grid;
}

}  // namespace vdbsynth::test
