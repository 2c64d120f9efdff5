#include "libvdbsynth/distance/zero_level.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace vdbsynth {
namespace {

// Corner c of a cell lies at (c >> 2, c >> 1 & 1, c & 1).
constexpr int kCorners = 8, kEdges = 12;

constexpr int coordinateOf(int corner, int axis) {
    return corner >> (2 - axis) & 1;
}

// An edge of a cell runs along an axis from a corner. In the order in which crossings are summed.
struct CellEdge {
    int axis, from;
    constexpr int to() const { return from | 4 >> axis; }
};
constexpr CellEdge kCellEdges[kEdges] = {{0, 0}, {2, 4}, {0, 1}, {2, 0}, {0, 2}, {2, 6},
                                         {0, 3}, {2, 2}, {1, 0}, {1, 4}, {1, 5}, {1, 1}};

constexpr int edgeAt(int axis, int from) {
    for (int e = 0; e < kEdges; ++e)
        if (kCellEdges[e].axis == axis && kCellEdges[e].from == from) return e;
    return -1;
}

// A face of a cell: 2 * axis + side.
constexpr bool isOnFace(int corner, int face) {
    return coordinateOf(corner, face / 2) == face % 2;
}

// How the surface goes through a cell whose corners have these signs (a bit each, set inside).
struct CellCase {
    std::array<std::uint8_t, kEdges> loop{};  // 1, 2 ... of each edge that is crossed, 0 of the others
    int loops = 0;
    int openFace = -1;  // the one face with four crossings of a cell of one loop; -1: none
};

class CaseBuilder {
public:
    explicit CaseBuilder(int signs) : mSigns(signs) {
        for (int e = 0; e < kEdges; ++e) mParent[std::size_t(e)] = e;
    }

    CellCase build() {
        int fourCrossings = 0, last = -1;
        for (int face = 0; face < 6; ++face)
            if (connectAcross(face)) {
                ++fourCrossings;
                last = face;
            }
        CellCase made;
        std::array<int, kEdges> number{};
        for (int e = 0; e < kEdges; ++e) {
            if (!isCrossed(e)) continue;
            int& of = number[std::size_t(rootOf(e))];
            if (of == 0) of = ++made.loops;
            made.loop[std::size_t(e)] = std::uint8_t(of);
        }
        if (fourCrossings == 1 && made.loops == 1) made.openFace = last;
        return made;
    }

private:
    bool isInside(int corner) const { return mSigns >> corner & 1; }
    bool isCrossed(int e) const { return isInside(kCellEdges[e].from) != isInside(kCellEdges[e].to()); }
    int rootOf(int e) const {
        while (mParent[std::size_t(e)] != e) e = mParent[std::size_t(e)];
        return e;
    }
    void join(int a, int b) { mParent[std::size_t(rootOf(a))] = rootOf(b); }

    // Joins the crossings on a face that one line of the surface connects. @return true if there are four
    bool connectAcross(int face) {
        std::array<int, 4> crossed{};
        int count = 0;
        for (int e = 0; e < kEdges; ++e)
            if (isCrossed(e) && isOnFace(kCellEdges[e].from, face) && isOnFace(kCellEdges[e].to(), face))
                crossed[std::size_t(count++)] = e;
        if (count == 2) join(crossed[0], crossed[1]);
        if (count < 4) return false;
        // Each outside corner is cut off, so that the inside is connected.
        for (int corner = 0; corner < kCorners; ++corner) {
            if (!isOnFace(corner, face) || isInside(corner)) continue;
            int first = -1;
            for (const int e : crossed) {
                if (kCellEdges[e].from != corner && kCellEdges[e].to() != corner) continue;
                if (first >= 0) join(first, e);
                first = e;
            }
        }
        return true;
    }

    int mSigns;
    std::array<int, kEdges> mParent{};
};

const std::array<CellCase, 256>& cellCases() {
    static const std::array<CellCase, 256> cases = [] {
        std::array<CellCase, 256> made;
        for (int signs = 0; signs < 256; ++signs) made[std::size_t(signs)] = CaseBuilder(signs).build();
        return made;
    }();
    return cases;
}

constexpr int kSide = 8;  // of a cube of cells
constexpr int kCells = kSide * kSide * kSide;
constexpr int kBelow = 1, kAbove = 2;  // samples that cells and Newton steps need beside the cube
constexpr int kPadded = kBelow + kSide + kAbove;
constexpr int kInside = 256;  // of a cell's flags, beside its signs: its first corner is inside

constexpr int cellIndex(const Index3& p) {
    return (p.x * kSide + p.y) * kSide + p.z;
}

// What the surface is in one cube of cells.
struct Cube {
    std::array<std::uint16_t, kCells> flags{};  // 0 where the surface does not go
    std::array<std::uint16_t, kCells> first{};  // of each cell, its first vertex
    std::vector<Vec3f> vertices;
    std::size_t base = 0;  // number of the first vertex in the mesh
    std::vector<Quad> quads;
};

// The samples of one cube and around it, and what is made of them.
class CubeMesher {
public:
    CubeMesher(const BrickField& field, const Index3& corner) : mCorner(corner - Index3{1, 1, 1} * kBelow) {
        field.readBox(mCorner, {kPadded, kPadded, kPadded}, mSamples);
    }

    std::unique_ptr<Cube> mesh() const {
        std::unique_ptr<Cube> cube;
        forEachVoxel(IndexBox::cube({0, 0, 0}, kSide), [&](const Index3& cell) {
            const int signs = signsOf(cell);
            if (signs == 0 || signs == 255) return;
            if (!cube) cube = std::make_unique<Cube>();
            addCell(cell, signs, *cube);
        });
        return cube;
    }

private:
    float sample(const Index3& p) const {  // p counts from the cube's corner
        return mSamples[((p.x + kBelow) * kPadded + p.y + kBelow) * kPadded + p.z + kBelow];
    }
    static Index3 cornerOf(const Index3& cell, int corner) {
        return cell + Index3{coordinateOf(corner, 0), coordinateOf(corner, 1), coordinateOf(corner, 2)};
    }
    int signsOf(const Index3& cell) const {
        int signs = 0;
        for (int c = 0; c < kCorners; ++c)
            if (sample(cornerOf(cell, c)) < 0) signs |= 1 << c;
        return signs;
    }

    void addCell(const Index3& cell, int signs, Cube& cube) const {
        const bool inside = signs & 1;
        const int open = cellCases()[std::size_t(signs)].openFace;
        if (open >= 0) {
            Index3 beside = cell;
            beside[open / 2] += open % 2 ? 1 : -1;
            if (cellCases()[std::size_t(signsOf(beside))].openFace == (open ^ 1)) signs = ~signs & 255;
        }
        const std::size_t i = std::size_t(cellIndex(cell));
        cube.flags[i] = std::uint16_t(signs | (inside ? kInside : 0));
        cube.first[i] = std::uint16_t(cube.vertices.size());
        const CellCase& way = cellCases()[std::size_t(signs)];
        for (int loop = 1; loop <= way.loops; ++loop)
            cube.vertices.push_back(projected(meanCrossing(cell, way, loop)));
    }

    Vec3f meanCrossing(const Index3& cell, const CellCase& way, int loop) const {
        Vec3d sum{0, 0, 0};
        int crossings = 0;
        for (int e = 0; e < kEdges; ++e) {
            if (way.loop[std::size_t(e)] != loop) continue;
            const CellEdge edge = kCellEdges[e];
            const double from = double(sample(cornerOf(cell, edge.from))),
                         to = double(sample(cornerOf(cell, edge.to())));
            for (int axis = 0; axis < 3; ++axis)
                sum[axis] += axis == edge.axis ? -from / (to - from) : double(coordinateOf(edge.from, axis));
            ++crossings;
        }
        sum = sum * (1.0 / crossings);
        const Index3 corner = cell + mCorner + Index3{1, 1, 1} * kBelow;
        return {float(sum.x + corner.x), float(sum.y + corner.y), float(sum.z + corner.z)};
    }

    // Two Newton steps along the gradient of the trilinear field.
    Vec3f projected(Vec3f vertex) const {
        for (int step = 0; step < 2; ++step) {
            Vec3d gradient;
            const Vec3d p = cast<double>(vertex);
            const double value = trilinear(p, gradient), squared = dot(gradient, gradient);
            if (squared < 1e-12) break;
            Vec3d move = gradient * (-value / squared);
            const double reach = length(move);
            if (reach > 0.5) move = move * (0.5 / reach);
            vertex = cast<float>(p + move);
        }
        return vertex;
    }

    double trilinear(const Vec3d& p, Vec3d& gradient) const {
        const Index3 base{int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
        const double fx = p.x - base.x, fy = p.y - base.y, fz = p.z - base.z;
        const Index3 local = base - mCorner - Index3{1, 1, 1} * kBelow;
        double v[kCorners];
        for (int c = 0; c < kCorners; ++c) v[c] = double(sample(cornerOf(local, c)));
        const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
        const double c00 = mix(v[0], v[1], fz), c01 = mix(v[2], v[3], fz), c10 = mix(v[4], v[5], fz),
                     c11 = mix(v[6], v[7], fz), c0 = mix(c00, c01, fy), c1 = mix(c10, c11, fy);
        gradient.x = c1 - c0;
        gradient.y = mix(c01 - c00, c11 - c10, fx);
        gradient.z = mix(mix(v[1] - v[0], v[3] - v[2], fy), mix(v[5] - v[4], v[7] - v[6], fy), fx);
        return mix(c0, c1, fx);
    }

    Index3 mCorner;  // of the samples
    float mSamples[kPadded * kPadded * kPadded];
};

// The cells around an edge along an axis from a voxel, and which of their edges it is, once around.
struct AroundEdge {
    Index3 cell[4];
    int edge[4];
};

constexpr AroundEdge kAround[3] = {{{{0, 0, 0}, {0, -1, 0}, {0, -1, -1}, {0, 0, -1}},
                                    {edgeAt(0, 0), edgeAt(0, 2), edgeAt(0, 3), edgeAt(0, 1)}},
                                   {{{0, 0, 0}, {0, 0, -1}, {-1, 0, -1}, {-1, 0, 0}},
                                    {edgeAt(1, 0), edgeAt(1, 1), edgeAt(1, 5), edgeAt(1, 4)}},
                                   {{{0, 0, 0}, {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}},
                                    {edgeAt(2, 0), edgeAt(2, 2), edgeAt(2, 6), edgeAt(2, 4)}}};

// All cubes of a region, in the order of a tree of 4096^3, 128^3 and 8^3 voxels.
class Cubes {
public:
    Cubes(const BrickField& field, const IndexBox& region, const RunContext& ctx) : mField(field) {
        for (int axis = 0; axis < 3; ++axis) {
            mFirst[axis] = region.min[axis] & ~7;
            mCount[axis] = (region.max[axis] - mFirst[axis]) / kSide + 1;
        }
        mCubes.resize(latticeCount(mCount));
        parallelFor(ctx, mCubes.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) mCubes[i] = meshed(cornerOf(i));
        });
        for (std::size_t i = 0; i < mCubes.size(); ++i)
            if (mCubes[i]) mOrder.push_back(i);
        std::sort(mOrder.begin(), mOrder.end(),
                  [&](std::size_t a, std::size_t b) { return comesBefore(cornerOf(a), cornerOf(b)); });
    }

    Mesh mesh(Facing facing, const RunContext& ctx) {
        Mesh mesh;
        std::size_t vertices = 0;
        for (const std::size_t i : mOrder) {
            mCubes[i]->base = vertices;
            vertices += mCubes[i]->vertices.size();
        }
        parallelFor(ctx, mOrder.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) addQuads(mOrder[i], facing);
        });
        std::size_t quads = 0;
        for (const std::size_t i : mOrder) quads += mCubes[i]->quads.size();
        mesh.points.reserve(vertices);
        mesh.quads.reserve(quads);
        for (const std::size_t i : mOrder) {
            const Cube& cube = *mCubes[i];
            mesh.points.insert(mesh.points.end(), cube.vertices.begin(), cube.vertices.end());
            mesh.quads.insert(mesh.quads.end(), cube.quads.begin(), cube.quads.end());
        }
        return mesh;
    }

private:
    Index3 cornerOf(std::size_t i) const { return mFirst + latticeVoxel(i, mCount) * kSide; }
    static bool comesBefore(const Index3& a, const Index3& b) {
        for (const int level : {12, 7}) {
            const Index3 nodeA{a.x >> level, a.y >> level, a.z >> level},
                nodeB{b.x >> level, b.y >> level, b.z >> level};
            if (nodeA != nodeB) return nodeA < nodeB;
        }
        return a < b;
    }

    std::unique_ptr<Cube> meshed(const Index3& corner) const {
        float value = 0;
        if (mField.constantIn(IndexBox::cube(corner, kSide + 1), value)) return nullptr;
        return CubeMesher(mField, corner).mesh();
    }

    // The cube that a cell lies in, null where the surface does not go; `cell` becomes local to it.
    const Cube* cubeOf(Index3& cell) const {
        const Index3 from = cell - mFirst, cube{from.x >> 3, from.y >> 3, from.z >> 3};
        if (!IndexBox::fromSize(mCount).contains(cube)) return nullptr;
        cell = {from.x & 7, from.y & 7, from.z & 7};
        return mCubes[latticeIndex(cube, mCount)].get();
    }

    void addQuads(std::size_t i, Facing facing) {
        Cube& cube = *mCubes[i];
        const Index3 corner = cornerOf(i);
        for (int c = 0; c < kCells; ++c) {
            const int flags = cube.flags[std::size_t(c)];
            if (flags == 0) continue;
            const Index3 voxel = corner + Index3{c >> 6, c >> 3 & 7, c & 7};
            const int signs = flags & 255;
            const bool inside = (flags & kInside) != 0;
            for (int axis = 0; axis < 3; ++axis) {
                if ((signs & 1) == (signs >> (4 >> axis) & 1)) continue;
                Quad quad;
                if (!quadAround(voxel, axis, quad)) continue;
                // Once around x or y is counter-clockwise seen from its end, around z clockwise.
                const bool outward = inside == (axis != 2);
                if (outward != (facing == Facing::Outward)) std::reverse(quad.begin(), quad.end());
                cube.quads.push_back(quad);
            }
        }
    }

    bool quadAround(const Index3& voxel, int axis, Quad& quad) const {
        for (int n = 0; n < 4; ++n) {
            Index3 cell = voxel + kAround[axis].cell[n];
            const Cube* cube = cubeOf(cell);
            if (!cube) return false;
            const std::size_t c = std::size_t(cellIndex(cell));
            const int flags = cube->flags[c];
            if (flags == 0) return false;
            const CellCase& way = cellCases()[std::size_t(flags & 255)];
            const std::size_t loop = way.loop[std::size_t(kAround[axis].edge[n])];
            quad[std::size_t(n)] = std::uint32_t(cube->base + cube->first[c] + loop - 1);
        }
        return true;
    }

    const BrickField& mField;
    Index3 mFirst, mCount;
    std::vector<std::unique_ptr<Cube>> mCubes;
    std::vector<std::size_t> mOrder;
};

}  // namespace

Mesh zeroLevel(const BrickField& field, const IndexBox& region, Facing facing, const RunContext& ctx) {
    return Cubes(field, region, ctx).mesh(facing, ctx);
}

}  // namespace vdbsynth
