// The zero level by dual contouring.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/geometry/crease.h"
#include "libvdbsynth/geometry/triangle.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

using Tree = openvdb::FloatTree;
constexpr double kReach = 2;        // voxels from the surface from which planes are taken
constexpr float kSameFace = 0.94f;  // cosine of the angle within which normals are of one face

// A plane of the surface near a voxel; normal zero: none.
struct Plane {
    Vec3f point, normal;
    bool flat = false;  // its normal is that of a face; next to a crease it may be between two faces'
};

// The planes of all voxels of the band, leaf by leaf.
class Planes {
public:
    Planes(const openvdb::FloatGrid& grid, const Mesh* source, const RunContext& ctx)
        : mScale(1 / voxelSizeOf(grid)), mLeaves(grid.tree()), mIndex(0) {
        for (std::size_t i = 0; i < mLeaves.leafCount(); ++i)
            mIndex.setValueOnly(mLeaves.leaf(i).origin(), std::int32_t(i) + 1);
        mPlanes.resize(mLeaves.leafCount() * BrickField::kSamples);
        fromGradients(grid, ctx);
        if (source) fromFaces(grid, *source, ctx);
    }

    // Null outside the band's leaves.
    const Plane* at(openvdb::tree::ValueAccessor<const openvdb::Int32Tree>& index,
                    const openvdb::Coord& voxel) const {
        const std::int32_t leaf = index.getValue(voxel & ~7);
        if (leaf == 0) return nullptr;
        return &mPlanes[std::size_t(leaf - 1) * BrickField::kSamples +
                        Tree::LeafNodeType::coordToOffset(voxel)];
    }
    const openvdb::Int32Tree& index() const { return mIndex; }

private:
    void fromGradients(const openvdb::FloatGrid& grid, const RunContext& ctx) {
        parallelFor(ctx, mLeaves.leafCount(), 16, [&](std::size_t begin, std::size_t end) {
            const auto accessor = grid.getConstAccessor();
            for (std::size_t i = begin; i < end; ++i)
                for (auto voxel = mLeaves.leaf(i).cbeginValueOn(); voxel; ++voxel) {
                    const double distance = double(*voxel) * mScale;
                    if (std::abs(distance) > kReach) continue;
                    const openvdb::Coord c = voxel.getCoord();
                    Vec3d gradient;
                    double curvature = 0;  // the Laplacian: for distances to a crease, one over the distance
                    for (int axis = 0; axis < 3; ++axis) {
                        openvdb::Coord low = c, high = c;
                        --low[axis];
                        ++high[axis];
                        const double above = double(accessor.getValue(high)),
                                     below = double(accessor.getValue(low));
                        gradient[axis] = (above - below) * mScale / 2;
                        curvature += (above + below - 2 * double(*voxel)) * mScale;
                    }
                    const double size = length(gradient);
                    if (std::abs(size - 1) > 0.03) continue;
                    const Vec3d normal = gradient * (1 / size);
                    const Vec3d place =
                        Vec3d{double(c.x()), double(c.y()), double(c.z())} - normal * distance;
                    mPlanes[i * BrickField::kSamples + voxel.pos()] = {
                        cast<float>(place), cast<float>(normal), std::abs(curvature) < 0.2};
                }
        });
    }

    // The planes of the nearest faces, if the distances were measured to those.
    void fromFaces(const openvdb::FloatGrid& grid, const Mesh& source, const RunContext& ctx) {
        const std::vector<Triangle> triangles = triangulated(source);
        IndexBox box = fromBBox(grid.evalActiveVoxelBoundingBox());
        for (int axis = 0; axis < 3; ++axis) box.min[axis] &= ~7;
        forNearestFaces(
            source, box, float(kReach), ctx, [&](const Index3& corner, const std::uint32_t* faces) {
                const std::int32_t number = mIndex.getValue(toCoord(corner));
                if (number == 0) return;
                const auto& leaf = mLeaves.leaf(std::size_t(number - 1));
                for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
                    const std::uint32_t face = faces[voxel.pos()];
                    if (face == kNoFace) continue;
                    const Triangle& t = triangles[face];
                    const Vec3d a = cast<double>(source.points[t[0]]), b = cast<double>(source.points[t[1]]),
                                c = cast<double>(source.points[t[2]]);
                    const openvdb::Coord at = voxel.getCoord();
                    const Vec3d p{double(at.x()), double(at.y()), double(at.z())},
                        w = nearestInTriangle(p, a, b, c);
                    const Vec3d nearest = a * w.x + b * w.y + c * w.z, normal = cross(b - a, c - a);
                    const double distance = std::abs(double(*voxel)) * mScale, size = length(normal);
                    if (std::abs(length(p - nearest) - distance) > 0.2 || !(size > 1e-12)) continue;
                    mPlanes[std::size_t(number - 1) * BrickField::kSamples + voxel.pos()] = {
                        cast<float>(nearest), cast<float>(normal * (1 / size)), true};
                }
            });
    }

    double mScale;
    openvdb::tree::LeafManager<const Tree> mLeaves;
    openvdb::Int32Tree mIndex;  // leaf's number + 1 at its origin
    std::vector<Plane> mPlanes;
};

// An edge of the lattice that the level crosses: from a voxel along an axis.
struct Crossing {
    openvdb::Coord voxel;
    int axis;
    bool outward;  // inside at the voxel, outside at its neighbour
};

std::vector<Crossing> findCrossings(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    const openvdb::tree::LeafManager<const Tree> leaves(grid.tree());
    std::vector<std::vector<Crossing>> found(leaves.leafCount());
    parallelFor(ctx, leaves.leafCount(), 16, [&](std::size_t begin, std::size_t end) {
        const auto accessor = grid.getConstAccessor();
        for (std::size_t i = begin; i < end; ++i)
            for (auto voxel = leaves.leaf(i).cbeginValueOn(); voxel; ++voxel)
                for (int axis = 0; axis < 3; ++axis) {
                    openvdb::Coord next = voxel.getCoord();
                    ++next[axis];
                    float value = 0;
                    if (accessor.probeValue(next, value) && (*voxel < 0) != (value < 0))
                        found[i].push_back({voxel.getCoord(), axis, *voxel < 0});
                }
    });
    std::vector<Crossing> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

// A cell is identified by its lowest voxel. These are the four around an edge, counter-clockwise seen from
// the edge's end.
std::array<openvdb::Coord, 4> cellsAround(const Crossing& crossing) {
    const int u = (crossing.axis + 1) % 3, v = (crossing.axis + 2) % 3;
    std::array<openvdb::Coord, 4> cells{crossing.voxel, crossing.voxel, crossing.voxel, crossing.voxel};
    --cells[0][u];
    --cells[0][v];
    --cells[1][v];
    --cells[3][u];
    return cells;
}

class CellSolver {
public:
    CellSolver(const openvdb::FloatGrid& grid, const Planes& planes)
        : mValues(grid.getConstAccessor()), mPlanes(planes), mIndex(planes.index()) {}

    // A cell's vertex and the surface data there.
    Vec3d solve(const openvdb::Coord& cell, VertexSurface& surface) {
        const Vec3d start = gather(cell);
        Quadric::Minimum best;
        if (normalsDiffer()) {
            for (const Plane* plane : mNear)
                surface.planes.add(cast<double>(plane->normal), cast<double>(plane->point));
            if (meetIn(cell, surface.planes, start, best)) {
                surface.rank = best.rank;
                return best.point;
            }
        }
        surface.rank = 1;
        surface.planes = mainPlane(start);
        best = surface.planes.minimum(start, 1, 1);
        surface.normal = outward(cell, surface.planes.empty() ? Vec3d{} : surface.planes.mainNormal());
        return clamped(cell, best.point, 0.3);  // rather somewhat beyond the cell than off the surface
    }

private:
    // Error of a plane at a point of the surface.
    static double misfit(const Plane& plane, const Vec3d& place) {
        const Vec3d away = place - cast<double>(plane.point);
        return std::abs(dot(cast<double>(plane.normal), away)) + 0.6 * length(away);
    }

    // The planes of the surface in a cell: for each crossing of the level with the cell's edges the
    // best-fitting one, and all that touch the surface in the cell. @return the mean of the crossings
    Vec3d gather(const openvdb::Coord& cell) {
        mAround.clear();
        mNear.clear();
        constexpr double kMargin = 0.1;
        forEachVoxel({{-2, -2, -2}, {3, 3, 3}}, [&](const Index3& step) {
            const Plane* plane = mPlanes.at(mIndex, cell + toCoord(step));
            if (!plane || (plane->normal.x == 0 && plane->normal.y == 0 && plane->normal.z == 0)) return;
            mAround.push_back(plane);
            bool inside = true;
            for (int axis = 0; axis < 3; ++axis)
                inside = inside && double(plane->point[axis]) > cell[axis] - kMargin &&
                         double(plane->point[axis]) < cell[axis] + 1 + kMargin;
            if (inside) mNear.push_back(plane);
        });
        const std::vector<Vec3d> crossings = crossingsOf(cell);
        Vec3d sum;
        for (const Vec3d& place : crossings) {
            if (const Plane* plane = bestFit(mAround, place)) mNear.push_back(plane);
            sum = sum + place * (1.0 / double(crossings.size()));
        }
        return sum;
    }

    static const Plane* bestFit(const std::vector<const Plane*>& planes, const Vec3d& place) {
        const Plane* best = nullptr;
        double least = 2;
        for (const Plane* plane : planes) {
            const double here = misfit(*plane, place);
            if (here >= least) continue;
            least = here;
            best = plane;
        }
        return best;
    }

    // Crossings of the level with the cell's edges.
    std::vector<Vec3d> crossingsOf(const openvdb::Coord& cell) {
        std::vector<Vec3d> places;
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 4; ++i) {
                openvdb::Coord low = cell;
                low[(axis + 1) % 3] += i & 1;
                low[(axis + 2) % 3] += i >> 1;
                openvdb::Coord high = low;
                ++high[axis];
                const double a = double(mValues.getValue(low)), b = double(mValues.getValue(high));
                if ((a < 0) == (b < 0)) continue;
                Vec3d place{double(low.x()), double(low.y()), double(low.z())};
                place[axis] += a / (a - b);
                places.push_back(place);
            }
        return places;
    }

    bool normalsDiffer() const {
        for (std::size_t i = 0; i < mNear.size(); ++i)
            for (std::size_t k = i + 1; k < mNear.size(); ++k)
                if (std::abs(dot(mNear[i]->normal, mNear[k]->normal)) < kSameFace) return true;
        return false;
    }

    // The planes that agree with the best-fitting one at a point; of faces, if there are any.
    Quadric mainPlane(const Vec3d& place) const {
        std::vector<const Plane*> faces;
        for (const Plane* plane : mAround)
            if (plane->flat) faces.push_back(plane);
        const Plane* main = bestFit(faces, place);
        const bool flat = main != nullptr;
        if (!main) main = bestFit(mNear, place);
        Quadric sum;
        if (main) sum.add(cast<double>(main->normal), cast<double>(main->point));
        for (const Plane* plane : mNear)
            if (main && plane->flat == flat && std::abs(dot(plane->normal, main->normal)) >= kSameFace)
                sum.add(cast<double>(plane->normal), cast<double>(plane->point));
        return sum;
    }

    // The direction of a normal in which the field grows.
    Vec3d outward(const openvdb::Coord& cell, const Vec3d& normal) {
        Vec3d gradient;
        for (int i = 0; i < 8; ++i) {
            const double value = double(mValues.getValue(cell.offsetBy(i >> 2, i >> 1 & 1, i & 1)));
            gradient = gradient +
                       Vec3d{i >> 2 ? value : -value, i >> 1 & 1 ? value : -value, i & 1 ? value : -value};
        }
        if (length(normal) == 0) return normalized(gradient);
        return dot(normal, gradient) < 0 ? -normal : normal;
    }

    static Vec3d clamped(const openvdb::Coord& cell, Vec3d p, double tolerance = 0) {
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = std::clamp(p[axis], double(cell[axis]) - tolerance, double(cell[axis]) + 1 + tolerance);
        return p;
    }

    // The common point of planes within a cell: alternating projections onto the edge and into the cell
    // converge to it.
    static bool meetIn(const openvdb::Coord& cell, const Quadric& sum, const Vec3d& start,
                       Quadric::Minimum& best) {
        Vec3d from = start;
        for (int i = 0; i < 12; ++i) {
            best = sum.minimum(from, 0.003, 0.02);
            from = clamped(cell, best.point);
            if (best.rank < 2) return false;
            if (length(from - best.point) > 0.01) continue;
            best.point = from;
            return true;
        }
        return false;
    }

    std::vector<const Plane*> mAround, mNear;
    openvdb::FloatGrid::ConstAccessor mValues;
    const Planes& mPlanes;
    openvdb::tree::ValueAccessor<const openvdb::Int32Tree> mIndex;
};

// The quads around all crossings; a quad with opposite corners on an edge becomes
// two triangles that share it.
void appendFaces(const std::vector<Crossing>& crossings, const openvdb::Int32Tree& numbers,
                 const std::vector<VertexSurface>& surfaces, Mesh& mesh) {
    openvdb::tree::ValueAccessor<const openvdb::Int32Tree> accessor(numbers);
    for (const Crossing& crossing : crossings) {
        const auto cells = cellsAround(crossing);
        Quad q;
        for (std::size_t i = 0; i < 4; ++i) q[i] = std::uint32_t(accessor.getValue(cells[i]) - 1);
        if (!crossing.outward) std::swap(q[1], q[3]);
        const bool first = surfaces[q[0]].rank > 1 && surfaces[q[2]].rank > 1,
                   second = surfaces[q[1]].rank > 1 && surfaces[q[3]].rank > 1;
        if (first == second) {
            mesh.quads.push_back(q);
        } else if (first) {
            mesh.triangles.push_back({q[0], q[1], q[2]});
            mesh.triangles.push_back({q[0], q[2], q[3]});
        } else {
            mesh.triangles.push_back({q[0], q[1], q[3]});
            mesh.triangles.push_back({q[1], q[2], q[3]});
        }
    }
}

}  // namespace

Mesh sharpZeroLevel(const openvdb::FloatGrid& grid, const Mesh* source, const RunContext& ctx) {
    const std::vector<Crossing> crossings = findCrossings(grid, ctx);
    openvdb::Int32Tree numbers(0);
    std::vector<openvdb::Coord> cells;
    openvdb::tree::ValueAccessor<openvdb::Int32Tree> accessor(numbers);
    for (const Crossing& crossing : crossings)
        for (const openvdb::Coord& cell : cellsAround(crossing))
            if (accessor.getValue(cell) == 0) {
                cells.push_back(cell);
                accessor.setValue(cell, std::int32_t(cells.size()));
            }
    const Planes planes(grid, source, ctx);
    Mesh mesh;
    mesh.points.resize(cells.size());
    std::vector<VertexSurface> surfaces(cells.size());
    parallelFor(ctx, cells.size(), 512, [&](std::size_t begin, std::size_t end) {
        CellSolver solver(grid, planes);
        for (std::size_t i = begin; i < end; ++i)
            mesh.points[i] = cast<float>(solver.solve(cells[i], surfaces[i]));
    });
    appendFaces(crossings, numbers, surfaces, mesh);
    restoreCreases(mesh, surfaces, 1.2);
    return mesh;
}

}  // namespace vdbsynth
