#include "libvdbsynth/vdb/level_set.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

std::vector<const Leaf*> leavesOf(const openvdb::FloatGrid& grid) {
    std::vector<const Leaf*> leaves;
    leaves.reserve(grid.tree().leafCount());
    grid.tree().getNodes(leaves);
    return leaves;
}

}  // namespace

namespace {

constexpr int kFarthest = 1 << 28;  // so that sums and differences of indices fit an int too

bool isNear(const IndexBox& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.min[axis] < -kFarthest || box.max[axis] > kFarthest) return false;
    return true;
}

// Rotation, reflection and uniform scale keep distances; nothing else does.
bool hasCubicVoxels(const openvdb::FloatGrid& grid) {
    if (!grid.transform().isLinear()) return false;
    const openvdb::Mat3d linear = grid.transform().baseMap()->getAffineMap()->getMat4().getMat3();
    const openvdb::Mat3d product = linear * linear.transpose();
    const double s = product(0, 0);
    if (!(s > 0 && std::isfinite(s))) return false;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(product(i, j) - (i == j ? s : 0)) <= 1e-6 * s)) return false;
    return true;
}

bool hasFiniteValues(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    const std::vector<const Leaf*> leaves = leavesOf(grid);
    std::vector<char> finite((leaves.size() + 255) / 256, 1);
    parallelFor(ctx, leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
        bool fine = true;
        for (std::size_t i = begin; i < end; ++i)
            for (openvdb::Index n = 0; n < Leaf::SIZE; ++n)
                fine = fine && std::isfinite(leaves[i]->getValue(n));
        finite[begin / 256] = fine;
    });
    openvdb::FloatTree::ValueAllCIter tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    bool fine = std::isfinite(grid.background());
    for (; tile; ++tile) fine = fine && std::isfinite(*tile);
    return fine && std::find(finite.begin(), finite.end(), 0) == finite.end();
}

}  // namespace

void requireModel(const LevelSet* model, const std::string& what, const RunContext& ctx) {
    if (!model || !model->grid)
        throw Error(ErrorCode::InvalidOption,
                    what + (model ? ": its `grid`" : "") + " is null; a level set is needed");
    for (const GridPtr& attribute : model->attributes)
        if (!attribute)
            throw Error(ErrorCode::InvalidOption, what + ": one of its `attributes` grids is null");
    const openvdb::FloatGrid& grid = *model->grid;
    if (grid.getGridClass() == openvdb::GRID_FOG_VOLUME || !(grid.background() > 0))
        throw Error(
            ErrorCode::Unusable,
            what +
                ": is not a level set (negative inside, positive outside); convert it with modelFromGrids");
    if (!hasCubicVoxels(grid))
        throw Error(ErrorCode::Unusable,
                    what + ": its voxels are not cubes; resample it, as modelFromGrids does");
    if (grid.activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, what + ": has no active voxels");
    if (model->domain.empty() || !isNear(model->domain))
        throw Error(ErrorCode::InvalidOption, what + ": its `domain` " + boxText(model->domain) +
                                                  (model->domain.empty() ? " is empty" : " is too far away") +
                                                  "; solidBox gives the box of the solid");
    if (!hasFiniteValues(grid, ctx)) throw Error(ErrorCode::BadData, what + ": holds NaN or infinite values");
    const double halfWidth = halfWidthOf(grid);
    if (!(halfWidth >= 1.4999))
        throw Error(ErrorCode::Unusable, what + ": its band of " + roundedText(halfWidth, 4) +
                                             " voxels a side is under 1.5; rebuild it with a wider one");
}

void requireBox(const IndexBox& box, const std::string& field) {
    requireOption(!box.empty() && isNear(box), field, boxText(box),
                  "i,j,k,I,J,K with every minimum at most its maximum, within 268435456 voxels of 0");
}

void requireHalfWidth(double halfWidth, const std::string& field) {
    requireOption(halfWidth >= 1.5 && halfWidth <= 100, field, roundedText(halfWidth, 6),
                  "from 1.5 to 100 voxels");
}

LevelSet withOwnGrids(const LevelSet& model) {
    LevelSet copy = model;
    if (copy.grid) copy.grid = model.grid->deepCopy();
    for (GridPtr& grid : copy.attributes) grid = grid->deepCopyGrid();
    return copy;
}

std::string boxText(const IndexBox& box) {
    std::string text;
    for (const Index3& corner : {box.min, box.max})
        for (int axis = 0; axis < 3; ++axis) text += (text.empty() ? "" : ",") + std::to_string(corner[axis]);
    return text;
}

bool parseBox(const std::string& text, IndexBox& box) {
    constexpr int kLimit = 1 << 28;
    IndexBox parsed;
    std::size_t at = 0;
    for (int i = 0; i < 6; ++i) {
        const std::size_t end = i < 5 ? text.find(',', at) : text.size();
        int& number = i < 3 ? parsed.min[i] : parsed.max[i - 3];
        if (end == std::string::npos || !parseWhole(std::string_view(text).substr(at, end - at), number))
            return false;
        if (number < -kLimit || number > kLimit) return false;
        at = end + 1;
    }
    if (parsed.empty()) return false;
    box = parsed;
    return true;
}

double voxelSizeOf(const openvdb::FloatGrid& grid) {
    return grid.voxelSize()[0];
}

Affine transformOf(const openvdb::FloatGrid& grid) {
    const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    Affine transform;
    std::copy_n(matrix.asPointer(), transform.size(), transform.begin());
    return transform;
}

IndexBox solidBox(const openvdb::FloatGrid& grid, const std::string& what) {
    openvdb::CoordBBox box;
    for (const Leaf* leaf : leavesOf(grid))
        for (openvdb::Index n = 0; n < Leaf::SIZE; ++n)
            if (leaf->getValue(n) < 0) box.expand(leaf->offsetToGlobalCoord(n));
    openvdb::FloatTree::ValueAllCIter tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (*tile < 0) box.expand(tile.getBoundingBox());
    if (box.empty()) throw Error(ErrorCode::EmptyInput, what + ": has no inside; a solid is needed");
    return fromBBox(box);
}

double solidVoxels(const openvdb::FloatGrid& grid) {
    double count = 0;
    for (const Leaf* leaf : leavesOf(grid))
        for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) count += leaf->getValue(n) < 0 ? 1 : 0;
    openvdb::FloatTree::ValueAllCIter tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (*tile < 0) count += double(tile.getBoundingBox().volume());
    return count;
}

FloatGridPtr inIndexSpace(const openvdb::FloatGrid& grid) {
    openvdb::FloatGrid::Ptr copy = openvdb::ConstPtrCast<openvdb::FloatGrid>(grid.copyWithNewTree());
    copy->setTree(openvdb::ConstPtrCast<openvdb::FloatTree>(grid.treePtr()));
    copy->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
    return copy;
}

double halfWidthOf(const openvdb::FloatGrid& grid) {
    return double(grid.background()) / voxelSizeOf(grid);
}

std::size_t activeVoxels(const openvdb::FloatGrid& grid) {
    return grid.activeVoxelCount();
}

void stampLevelSet(LevelSet& levelSet) {
    levelSet.grid->setName(kSurfaceName);
    levelSet.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    levelSet.grid->setSaveFloatAsHalf(false);  // a file read at half precision is not written at half
    levelSet.grid->removeMeta(kDomainKey);
    if (levelSet.domainRecorded)
        levelSet.grid->insertMeta(kDomainKey, openvdb::StringMetadata(boxText(levelSet.domain)));
}

std::string levelSetHash(const openvdb::FloatGrid& grid) {
    std::uint64_t hash[2] = {1, 2};
    for (const Leaf* leaf : leavesOf(grid)) {
        const openvdb::Coord origin = leaf->origin();
        std::uint64_t active[Leaf::SIZE / 64];
        for (openvdb::Index word = 0; word < Leaf::SIZE / 64; ++word)
            active[word] = leaf->getValueMask().getWord<std::uint64_t>(word);
        for (std::uint64_t& h : hash) {
            h = hash64(&origin, sizeof origin, h);
            h = hash64(leaf->buffer().data(), Leaf::SIZE * sizeof(float), h);
            h = hash64(active, sizeof active, h);
        }
    }
    const float background = grid.background();
    openvdb::FloatTree::ValueAllCIter tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        // Inactive background is skipped: a tree may or may not have tiles for it.
        if (!tile.isValueOn() && *tile == background) continue;
        const openvdb::CoordBBox box = tile.getBoundingBox();
        const std::int32_t place[7] = {box.min().x(), box.min().y(), box.min().z(),   box.max().x(),
                                       box.max().y(), box.max().z(), tile.isValueOn()};
        const float value = *tile;
        for (std::uint64_t& h : hash) h = hash64(&value, sizeof value, hash64(place, sizeof place, h));
    }
    for (std::uint64_t& h : hash) h = hash64(&background, sizeof background, h);
    const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    for (std::uint64_t& h : hash) h = hash64(matrix.asPointer(), 16 * sizeof(double), h);
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash[0]),
                  static_cast<unsigned long long>(hash[1]));
    return text;
}

BandQuality measureBand(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    const std::vector<const Leaf*> leaves = leavesOf(grid);
    const float voxel = float(voxelSizeOf(grid));
    std::vector<std::vector<float>> errors(leaves.size());
    std::vector<std::size_t> missing(leaves.size(), 0);
    std::vector<char> finite(leaves.size(), 1);
    parallelFor(ctx, leaves.size(), 32, [&](std::size_t begin, std::size_t end) {
        const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
        for (std::size_t i = begin; i < end; ++i)
            for (auto it = leaves[i]->cbeginValueOn(); it; ++it) {
                if (!std::isfinite(*it)) finite[i] = 0;
                if (std::abs(*it) >= voxel) continue;
                float central = 0, upwind = 0;
                bool complete = true;
                const float sign = *it < 0 ? -1.f : 1.f;
                for (int axis = 0; axis < 3; ++axis) {
                    openvdb::Coord low = it.getCoord(), high = it.getCoord();
                    --low[axis];
                    ++high[axis];
                    complete = complete && accessor.isValueOn(low) && accessor.isValueOn(high);
                    const float before = accessor.getValue(low), after = accessor.getValue(high);
                    const float d = (after - before) / (2 * voxel);
                    central += d * d;
                    const float drop = std::max({0.f, sign * (*it - before), sign * (*it - after)}) / voxel;
                    upwind += drop * drop;
                }
                if (complete)
                    errors[i].push_back(
                        std::min(std::abs(std::sqrt(central) - 1), std::abs(std::sqrt(upwind) - 1)));
                else
                    ++missing[i];
            }
    });
    BandQuality quality;
    std::vector<float> all;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        all.insert(all.end(), errors[i].begin(), errors[i].end());
        quality.missingNeighbours += missing[i];
        quality.finite = quality.finite && finite[i];
    }
    quality.measured = all.size();
    if (all.empty()) return quality;
    for (float error : all) quality.gradientErrorMean += double(error);
    quality.gradientErrorMean /= double(all.size());
    const auto p99 = all.begin() + std::ptrdiff_t((all.size() - 1) * 99 / 100);
    std::nth_element(all.begin(), p99, all.end());
    quality.gradientErrorP99 = double(*p99);
    return quality;
}

ValueRange rangeOf(const openvdb::FloatGrid& grid) {
    ValueRange range;
    range.finite = std::isfinite(grid.background());
    bool first = true;
    const auto add = [&](float value) {
        if (!std::isfinite(value)) {
            range.finite = false;
            return;
        }
        range.minimum = first ? double(value) : std::min(range.minimum, double(value));
        range.maximum = first ? double(value) : std::max(range.maximum, double(value));
        first = false;
    };
    for (const Leaf* leaf : leavesOf(grid))
        for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
            const float value = leaf->getValue(n);
            if (leaf->isValueOn(n))
                add(value);
            else if (!std::isfinite(value))
                range.finite = false;
        }
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (tile.isValueOn())
            add(*tile);
        else if (!std::isfinite(*tile))
            range.finite = false;
    }
    return range;
}

FloatGridPtr asFloat(const GridPtr& grid) {
    if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return floats;
    const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
    if (!doubles) return nullptr;
    auto copy = openvdb::FloatGrid::create(*doubles);  // metadata and transform
    copy->setTree(std::make_shared<openvdb::FloatTree>(doubles->tree()));
    return copy;
}

}  // namespace vdbsynth
