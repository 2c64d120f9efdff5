#include "libvdbsynth/vdb/winding_field_steps.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/level_set.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int kSide = 8;
constexpr int kNode = 64;
constexpr float kOpeningScale = 8;  // [voxels] that a change of the winding number by 1 counts as

struct Regions {
    std::vector<Index3> leaves;
    std::vector<IndexBox> inside;
};

class Builder {
public:
    Builder(const WindingFieldSource& source, const RunContext& ctx) : mSource(source), mContext(ctx) {}

    FloatGridPtr run(const IndexBox& box) {
        mField = openvdb::FloatGrid::create(kHalfWidth);
        collect(box);
        std::vector<std::unique_ptr<Leaf>> made(mLeaves.size());
        parallelFor(mContext, mLeaves.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                made[i] = std::make_unique<Leaf>(toCoord(mLeaves[i]), kHalfWidth, true);
                mSource.fill(mLeaves[i], made[i]->buffer().data());
            }
        });
        for (std::unique_ptr<Leaf>& leaf : made) mField->tree().addLeaf(leaf.release());
        return mField;
    }

private:
    void collect(const IndexBox& box) {
        const auto floor = [](int v) { return v >= 0 ? v / kNode : -((-v + kNode - 1) / kNode); };
        std::vector<Index3> nodes;
        for (int x = floor(box.min.x); x <= floor(box.max.x); ++x)
            for (int y = floor(box.min.y); y <= floor(box.max.y); ++y)
                for (int z = floor(box.min.z); z <= floor(box.max.z); ++z)
                    nodes.push_back(Index3{x, y, z} * kNode);
        std::vector<Regions> found(nodes.size());
        parallelFor(mContext, nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) split(nodes[i], kNode, found[i]);
        });
        for (const Regions& regions : found) {
            mLeaves.insert(mLeaves.end(), regions.leaves.begin(), regions.leaves.end());
            for (const IndexBox& inside : regions.inside)
                mField->sparseFill(toBBox(inside), -kHalfWidth, /* active= */ false);
        }
    }

    void split(const Index3& corner, int side, Regions& regions) const {
        if (!mSource.hasSurface(corner, side)) {
            double low = 0, high = 0;
            cornerRange(corner, side, low, high);
            if (high < 0.5 - kWindingMargin / 2) return;
            if (low > 0.5 + kWindingMargin / 2) {
                regions.inside.push_back(IndexBox::cube(corner, side));
                return;
            }
        }
        if (side == kSide) {
            regions.leaves.push_back(corner);
            return;
        }
        const int half = side / 2;
        for (int c = 0; c < 8; ++c)
            split(corner + Index3{c & 4 ? half : 0, c & 2 ? half : 0, c & 1 ? half : 0}, half, regions);
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

    const WindingFieldSource& mSource;
    const RunContext& mContext;
    FloatGridPtr mField;
    std::vector<Index3> mLeaves;
};

}  // namespace

float openingDistance(double winding) {
    return std::min(kHalfWidth, std::max(1e-3f, kOpeningScale * float(std::abs(winding - 0.5))));
}

FloatGridPtr buildWindingField(const IndexBox& box, const WindingFieldSource& source, const RunContext& ctx) {
    return Builder(source, ctx).run(box);
}

}  // namespace vdbsynth
