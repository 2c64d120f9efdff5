#include "libvdbsynth/distance/winding_field.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;
constexpr int kNode = 64;
constexpr float kOpeningScale = 8;  // [voxels] that a change of the winding number by 1 counts as

enum class Region : char { Outside, Inside, Filled };

// Which cubes of 8 voxels have to be filled, found from large cubes down.
class RegionFinder {
public:
    RegionFinder(const IndexBox& box, const WindingFieldSource& source) : mBox(box), mSource(source) {
        const Index3 size = box.size();
        mBricks = {size.x / kSide, size.y / kSide, size.z / kSide};
        mRegions.resize(latticeCount(mBricks));
    }

    void run(const RunContext& ctx) {
        std::vector<Index3> nodes;
        forEachVoxel(
            mBox, [&](const Index3& corner) { nodes.push_back(corner); }, kNode);
        parallelFor(ctx, nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) split(nodes[i], kNode);
        });
    }

    Region at(const Index3& voxel) const { return mRegions[brickOf(voxel)]; }

private:
    std::size_t brickOf(const Index3& voxel) const {
        const Index3 from = voxel - mBox.min;
        return latticeIndex({from.x / kSide, from.y / kSide, from.z / kSide}, mBricks);
    }

    void mark(const Index3& corner, int side, Region region) {
        forEachVoxel(
            IndexBox::cube(corner, side), [&](const Index3& p) { mRegions[brickOf(p)] = region; }, kSide);
    }

    void split(const Index3& corner, int side) {
        if (!mSource.hasSurface(corner, side)) {
            double low = 0, high = 0;
            cornerRange(corner, side, low, high);
            if (high < 0.5 - kWindingMargin / 2) return;
            if (low > 0.5 + kWindingMargin / 2) return mark(corner, side, Region::Inside);
        }
        if (side == kSide) return mark(corner, side, Region::Filled);
        const int half = side / 2;
        for (int c = 0; c < 8; ++c)
            split(corner + Index3{c & 4 ? half : 0, c & 2 ? half : 0, c & 1 ? half : 0}, half);
    }

    // Away from a surface the winding number is harmonic: its extremes over a region are on its border, and
    // its corners and middle tell whether it comes near one half.
    void cornerRange(const Index3& corner, int side, double& low, double& high) const {
        const int far = side - 1;
        low = high = mSource.winding(corner + Index3{side / 2, side / 2, side / 2});
        for (int c = 0; c < 8; ++c) {
            const double w =
                mSource.winding(corner + Index3{c & 4 ? far : 0, c & 2 ? far : 0, c & 1 ? far : 0});
            low = std::min(low, w);
            high = std::max(high, w);
        }
    }

    IndexBox mBox;
    const WindingFieldSource& mSource;
    Index3 mBricks;
    std::vector<Region> mRegions;
};

IndexBox wholeNodes(const IndexBox& box) {
    IndexBox nodes;
    for (int axis = 0; axis < 3; ++axis) {
        nodes.min[axis] = box.min[axis] & ~(kNode - 1);
        nodes.max[axis] = box.max[axis] | (kNode - 1);
    }
    return nodes;
}

}  // namespace

float openingDistance(double winding, float limit) {
    return std::min(limit, std::max(1e-3f, kOpeningScale * float(std::abs(winding - 0.5))));
}

BrickField windingField(const IndexBox& box, float limit, const WindingFieldSource& source,
                        const RunContext& ctx) {
    RegionFinder regions(wholeNodes(box), source);
    regions.run(ctx);
    return BrickField::generate(wholeNodes(box), ctx, [&](const IndexBox& brick, float* samples) {
        const Region region = regions.at(brick.min);
        if (region == Region::Filled)
            source.fill(brick.min, samples);
        else
            std::fill_n(samples, BrickField::kSamples, region == Region::Inside ? -limit : limit);
    });
}

}  // namespace vdbsynth
