// Which part lies in which.
#include "libvdbsynth/distance/winding_number.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/solid/mesh_parts_steps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr std::size_t kSamples = 64;  // faces that decide where a part lies

// The boxes around a place, by the cells of a coarse lattice.
class BoxesAt {
public:
    explicit BoxesAt(const std::vector<MeshPart>& parts) : mParts(parts), mCells(latticeCount(kSize)) {
        if (parts.empty()) return;
        mMin = parts[0].boxMin;
        mMax = parts[0].boxMax;
        for (const MeshPart& part : parts)
            for (int axis = 0; axis < 3; ++axis) {
                mMin[axis] = std::min(mMin[axis], part.boxMin[axis]);
                mMax[axis] = std::max(mMax[axis], part.boxMax[axis]);
            }
    }
    void add(std::uint32_t part) {
        forEachVoxel({cellOf(mParts[part].boxMin), cellOf(mParts[part].boxMax)},
                     [&](const Index3& cell) { mCells[latticeIndex(cell, kSize)].push_back(part); });
    }
    /// Parts that were added and whose boxes may contain a place, in the order they were added.
    const std::vector<std::uint32_t>& at(const Vec3d& place) const {
        return mCells[latticeIndex(cellOf(place), kSize)];
    }

private:
    static constexpr int kCells = 16;
    static constexpr Index3 kSize{kCells, kCells, kCells};
    Index3 cellOf(const Vec3d& p) const {
        Index3 cell;
        for (int axis = 0; axis < 3; ++axis) {
            const double side = mMax[axis] - mMin[axis];
            cell[axis] = side > 0 ? std::min(kCells - 1, int((p[axis] - mMin[axis]) / side * kCells)) : 0;
        }
        return cell;
    }
    const std::vector<MeshPart>& mParts;
    std::vector<std::vector<std::uint32_t>> mCells;
    Vec3d mMin, mMax;
};

class Nesting {
public:
    Nesting(const Mesh& mesh, const std::vector<Triangle>& triangles, MeshParts& parts, const RunContext& ctx)
        : mMesh(mesh), mTriangles(triangles), mParts(parts), mContext(ctx) {
        for (std::uint32_t i = 0; i < mParts.parts.size(); ++i)
            if (mParts.parts[i].role != PartRole::Open) mOrder.push_back(i);
        // The largest first: a part is only ever inside one before it.
        std::stable_sort(mOrder.begin(), mOrder.end(),
                         [this](std::uint32_t a, std::uint32_t b) { return volumeOf(a) > volumeOf(b); });
        mFirst.assign(mParts.parts.size() + 1, 0);
        for (std::uint32_t part : mParts.partOf) ++mFirst[part + 1];
        std::partial_sum(mFirst.begin(), mFirst.end(), mFirst.begin());
        mFaces.resize(mTriangles.size());
        std::vector<std::size_t> next(mFirst.begin(), mFirst.end() - 1);
        for (std::uint32_t f = 0; f < mTriangles.size(); ++f) mFaces[next[mParts.partOf[f]]++] = f;
    }

    void run() {
        BoxesAt larger(mParts.parts);
        for (const std::uint32_t number : mOrder) {
            throwIfCancelled(mContext);
            MeshPart& part = mParts.parts[number];
            // Of the parts before it the smallest that it lies in.
            const std::vector<std::uint32_t>& around = larger.at(part.boxMin);
            for (std::size_t i = around.size(); i-- > 0 && part.around < 0;)
                if (liesIn(number, around[i])) part.around = int(around[i]);
            part.role = roleOf(part);
            larger.add(number);
        }
    }

private:
    double volumeOf(std::uint32_t i) const { return std::abs(mParts.parts[i].signedVolume); }

    PartRole roleOf(const MeshPart& part) const {
        if (part.around < 0) return PartRole::Solid;
        const MeshPart& around = mParts.parts[std::size_t(part.around)];
        const bool opposed = (part.signedVolume < 0) != (around.signedVolume < 0);
        if (!opposed) return PartRole::United;
        return insideIsSolid(around) ? PartRole::Cavity : PartRole::Solid;
    }

    bool insideIsSolid(const MeshPart& part) const {
        if (part.role != PartRole::United) return part.role == PartRole::Solid;
        return insideIsSolid(mParts.parts[std::size_t(part.around)]);
    }

    bool liesIn(std::uint32_t inner, std::uint32_t outer) {
        const MeshPart &a = mParts.parts[inner], &b = mParts.parts[outer];
        for (int axis = 0; axis < 3; ++axis)
            if (a.boxMin[axis] < b.boxMin[axis] || a.boxMax[axis] > b.boxMax[axis]) return false;
        const WindingNumber& winding = windingOf(outer);
        const std::size_t count = mFirst[inner + 1] - mFirst[inner];
        const std::size_t step = std::max<std::size_t>(1, count / kSamples);
        std::size_t inside = 0, tried = 0;
        for (std::size_t i = mFirst[inner]; i < mFirst[inner + 1]; i += step) {
            const double w = std::abs(winding.at(cornersOf(mMesh, mTriangles[mFaces[i]]).middle()));
            if (w < 0.25) return false;
            ++tried;
            inside += w > 0.75 ? 1 : 0;
        }
        // Faces that touch the outer part from inside see a half, as do all of a part that coincides with it.
        return 4 * inside >= 3 * tried;
    }

    const WindingNumber& windingOf(std::uint32_t part) {
        std::unique_ptr<WindingNumber>& winding = mWinding[part];
        if (!winding) {
            Mesh alone;
            for (std::size_t i = mFirst[part]; i < mFirst[part + 1]; ++i) {
                const std::uint32_t first = std::uint32_t(alone.points.size());
                for (std::uint32_t corner : mTriangles[mFaces[i]])
                    alone.points.push_back(mMesh.points[corner]);
                alone.triangles.push_back({first, first + 1, first + 2});
            }
            winding = std::make_unique<WindingNumber>(alone, mContext);
        }
        return *winding;
    }

    const Mesh& mMesh;
    const std::vector<Triangle>& mTriangles;
    MeshParts& mParts;
    const RunContext& mContext;
    std::vector<std::uint32_t> mOrder, mFaces;
    std::vector<std::size_t> mFirst;
    std::map<std::uint32_t, std::unique_ptr<WindingNumber>> mWinding;
};

}  // namespace

void findNesting(const Mesh& mesh, const std::vector<Triangle>& triangles, MeshParts& parts,
                 const RunContext& ctx) {
    Nesting(mesh, triangles, parts, ctx).run();
}

}  // namespace vdbsynth
