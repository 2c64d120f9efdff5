#include "libvdbsynth/procedural/primitives.h"

#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace vdbsynth {
namespace {

constexpr int kCell = 32;  // bins of the look-up, in voxels

// Primitives by the coarse cells that their enlarged bounds touch.
class Bins {
public:
    Bins(const std::vector<Primitive>& primitives, const IndexBox& box, double reach) : mBox(box) {
        const Index3 size = box.size();
        mCells = {(size.x + kCell - 1) / kCell, (size.y + kCell - 1) / kCell, (size.z + kCell - 1) / kCell};
        mLists.resize(latticeCount(mCells));
        for (std::uint32_t i = 0; i < primitives.size(); ++i) {
            Vec3d centre;
            double radius;
            primitives[i].bound(centre, radius);
            IndexBox cells;
            for (int axis = 0; axis < 3; ++axis) {
                cells.min[axis] =
                    std::max(0, int(std::floor((centre[axis] - radius - reach - box.min[axis]) / kCell)));
                cells.max[axis] =
                    std::min(mCells[axis] - 1,
                             int(std::floor((centre[axis] + radius + reach - box.min[axis]) / kCell)));
            }
            forEachVoxel(cells, [&](const Index3& c) { mLists[latticeIndex(c, mCells)].push_back(i); });
        }
    }
    // kCell is a multiple of the brick's side, so a brick lies in one cell. Outside the box: the nearest
    // cell.
    const std::vector<std::uint32_t>& near(const Index3& corner) const {
        Index3 cell = corner - mBox.min;
        for (int axis = 0; axis < 3; ++axis) cell[axis] = std::clamp(cell[axis] / kCell, 0, mCells[axis] - 1);
        return mLists[latticeIndex(cell, mCells)];
    }

private:
    IndexBox mBox;
    Index3 mCells;
    std::vector<std::vector<std::uint32_t>> mLists;
};

}  // namespace

double Primitive::distance(const Vec3d& p) const {
    if (kind == Kind::Torus) {
        const Vec3d offset = p - a;
        const double along = dot(offset, b);
        const double across = length(offset - b * along) - ring;
        return std::sqrt(across * across + along * along) - radius;
    }
    const Vec3d ab = b - a;
    const double squared = dot(ab, ab);
    const double t = squared > 0 ? std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) : 0.0;
    return length(p - (a + ab * t)) - radius;
}

void Primitive::bound(Vec3d& centre, double& boundRadius) const {
    if (kind == Kind::Torus) {
        centre = a;
        boundRadius = ring + radius;
    } else {
        centre = (a + b) * 0.5;
        boundRadius = length(b - a) * 0.5 + radius;
    }
}

Primitive ball(const Vec3d& centre, double radius) {
    return {Primitive::Kind::Capsule, centre, centre, radius, 0};
}
Primitive capsule(const Vec3d& a, const Vec3d& b, double radius) {
    return {Primitive::Kind::Capsule, a, b, radius, 0};
}
Primitive torus(const Vec3d& centre, const Vec3d& axis, double ring, double tube) {
    return {Primitive::Kind::Torus, centre, normalized(axis), tube, ring};
}
Primitive scaled(Primitive shape, double by) {
    shape.a = shape.a * by;
    if (shape.kind == Primitive::Kind::Capsule) shape.b = shape.b * by;
    shape.radius *= by;
    shape.ring *= by;
    return shape;
}

std::function<double(const Vec3d&)> unionDistance(const std::vector<Primitive>& primitives,
                                                  const IndexBox& box, double reach) {
    struct Shapes {
        std::vector<Primitive> primitives;
        Bins bins;
    };
    // Half a voxel for places between voxels, one for those around the box.
    const auto shapes =
        std::make_shared<const Shapes>(Shapes{primitives, Bins(primitives, box, 2 * reach + 1)});
    return [shapes, reach](const Vec3d& p) {
        const Index3 voxel{int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
        double nearest = reach;
        for (std::uint32_t i : shapes->bins.near(voxel))
            nearest = std::min(nearest, shapes->primitives[i].distance(p));
        return nearest;
    };
}

BrickField unionField(const std::vector<Primitive>& primitives, const IndexBox& box, float limit,
                      const RunContext& ctx) {
    const Bins bins(primitives, box, double(limit));
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        const Vec3d middle{brick.min.x + 3.5, brick.min.y + 3.5, brick.min.z + 3.5};
        const double reach = 3.5 * 1.7320508075688772 + double(limit);
        std::vector<const Primitive*> near;
        for (std::uint32_t i : bins.near(brick.min))
            if (primitives[i].distance(middle) < reach) near.push_back(&primitives[i]);
        forEachVoxel(brick, [&](const Index3& voxel) {
            const Vec3d p{double(voxel.x), double(voxel.y), double(voxel.z)};
            double nearest = double(limit);
            for (const Primitive* primitive : near) nearest = std::min(nearest, primitive->distance(p));
            *samples++ = float(std::max(nearest, -double(limit)));
        });
    });
}

}  // namespace vdbsynth
