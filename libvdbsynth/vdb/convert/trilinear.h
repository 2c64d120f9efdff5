#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>

namespace vdbsynth {

/// Trilinear value and gradient of a grid in index space. It has one accessor: use one object per thread.
class TrilinearSampler {
public:
    explicit TrilinearSampler(const openvdb::FloatGrid& grid) : mAccessor(grid.getConstAccessor()) {}

    /// @param p  index space   @param gradient  [value / voxel]
    double sample(const Vec3d& p, Vec3d& gradient) {
        const openvdb::Coord base(int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z)));
        const double fx = p.x - base.x(), fy = p.y - base.y(), fz = p.z - base.z();
        double v[2][2][2];
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                for (int k = 0; k < 2; ++k) v[i][j][k] = double(mAccessor.getValue(base.offsetBy(i, j, k)));
        const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
        const double c00 = mix(v[0][0][0], v[0][0][1], fz), c01 = mix(v[0][1][0], v[0][1][1], fz);
        const double c10 = mix(v[1][0][0], v[1][0][1], fz), c11 = mix(v[1][1][0], v[1][1][1], fz);
        const double c0 = mix(c00, c01, fy), c1 = mix(c10, c11, fy);
        gradient.x = c1 - c0;
        gradient.y = mix(c01 - c00, c11 - c10, fx);
        const auto dz = [&](int i, int j) { return v[i][j][1] - v[i][j][0]; };
        gradient.z = mix(mix(dz(0, 0), dz(0, 1), fy), mix(dz(1, 0), dz(1, 1), fy), fx);
        return mix(c0, c1, fx);
    }

    openvdb::FloatGrid::ConstAccessor& accessor() { return mAccessor; }

private:
    openvdb::FloatGrid::ConstAccessor mAccessor;
};

}  // namespace vdbsynth
