// Attributes of meshes and points as grids, and grids as attributes.
#include "libvdbsynth/vdb/convert/attribute_grids.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/geometry/triangle.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include "libvdbsynth/vdb/vdb_file.h"

#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <unordered_map>

namespace vdbsynth {
namespace {

// Some vertices and their weights, which sum to 1: the sources of a voxel's values.
struct Blend {
    std::uint32_t vertices[3] = {0, 0, 0};
    float weights[3] = {1, 0, 0};
};

// The blends of all voxels of the leaves of a level set's band, leaf by leaf.
using Leaves = std::vector<openvdb::Coord>;

struct Band {
    Leaves origins;
    std::vector<Blend> blends;  // [leaves x 512]
};

Band emptyBand(const openvdb::FloatGrid& levelSet) {
    Band band;
    for (auto leaf = levelSet.tree().cbeginLeaf(); leaf; ++leaf) band.origins.push_back(leaf->origin());
    band.blends.resize(band.origins.size() * BrickField::kSamples);
    return band;
}

std::vector<Vec3f> inIndexSpaceOf(const openvdb::FloatGrid& levelSet, const std::vector<Vec3f>& points,
                                  const Vec3d& origin) {
    std::vector<Vec3f> result;
    result.reserve(points.size());
    for (const Vec3f& p : points)
        result.push_back(cast<float>(fromVec(levelSet.worldToIndex(toVec(cast<double>(p) + origin)))));
    return result;
}

// Voxels without a near face, as where an opening was closed, take the nearest vertex.
void fillFromNearest(Band& band, const std::vector<char>& missing, const std::vector<Vec3f>& points,
                     const RunContext& ctx) {
    const PointNeighbours tree(points);
    parallelFor(ctx, band.origins.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t leaf = begin; leaf < end; ++leaf)
            for (std::size_t i = 0; i < BrickField::kSamples; ++i) {
                if (!missing[leaf * BrickField::kSamples + i]) continue;
                const Index3 p =
                    fromCoord(band.origins[leaf]) + Index3{int(i >> 6), int(i >> 3 & 7), int(i & 7)};
                float squared = 0;
                tree.nearest({float(p.x), float(p.y), float(p.z)}, 1,
                             band.blends[leaf * BrickField::kSamples + i].vertices, &squared);
            }
    });
}

Band blendFaces(const openvdb::FloatGrid& levelSet, const Mesh& mesh, const RunContext& ctx) {
    Band band = emptyBand(levelSet);
    Mesh index = mesh;
    index.points = inIndexSpaceOf(levelSet, mesh.points, mesh.origin);
    const std::vector<Triangle> triangles = triangulated(index);
    std::unordered_map<openvdb::Coord, std::size_t> leafAt;
    for (std::size_t i = 0; i < band.origins.size(); ++i) leafAt[band.origins[i]] = i;
    std::vector<char> missing(band.blends.size(), 1);
    IndexBox box = fromBBox(levelSet.evalActiveVoxelBoundingBox());
    for (int axis = 0; axis < 3; ++axis) box.min[axis] &= ~7;
    const float reach = float(std::ceil(halfWidthOf(levelSet))) + 1;
    forNearestFaces(index, box, reach, ctx, [&](const Index3& corner, const std::uint32_t* faces) {
        const auto leaf = leafAt.find(toCoord(corner));
        if (leaf == leafAt.end()) return;
        for (std::size_t i = 0; i < BrickField::kSamples; ++i) {
            if (faces[i] == kNoFace) continue;
            const Triangle& t = triangles[faces[i]];
            const Vec3d p{double(corner.x + int(i >> 6)), double(corner.y + int(i >> 3 & 7)),
                          double(corner.z + int(i & 7))};
            const Vec3d weights =
                nearestInTriangle(p, cast<double>(index.points[t[0]]), cast<double>(index.points[t[1]]),
                                  cast<double>(index.points[t[2]]));
            const std::size_t at = leaf->second * BrickField::kSamples + i;
            for (int k = 0; k < 3; ++k) {
                band.blends[at].vertices[k] = t[std::size_t(k)];
                band.blends[at].weights[k] = float(weights[k]);
            }
            missing[at] = 0;
        }
    });
    fillFromNearest(band, missing, index.points, ctx);
    return band;
}

// The three nearest points, weighted by their inverse squared distances.
Band blendPoints(const openvdb::FloatGrid& levelSet, const PointCloud& cloud, const RunContext& ctx) {
    Band band = emptyBand(levelSet);
    const std::vector<Vec3f> points = inIndexSpaceOf(levelSet, cloud.points, cloud.origin);
    const PointNeighbours tree(points);
    parallelFor(ctx, band.origins.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin * BrickField::kSamples; n < end * BrickField::kSamples; ++n) {
            const std::size_t i = n % BrickField::kSamples;
            const Index3 p = fromCoord(band.origins[n / BrickField::kSamples]) +
                             Index3{int(i >> 6), int(i >> 3 & 7), int(i & 7)};
            Blend& blend = band.blends[n];
            float squared[3] = {}, sum = 0;
            const std::size_t found =
                tree.nearest({float(p.x), float(p.y), float(p.z)}, 3, blend.vertices, squared);
            for (std::size_t k = 0; k < 3; ++k)
                sum += blend.weights[k] = k < found ? 1 / (squared[k] + 1e-4f) : 0;
            for (float& weight : blend.weights) weight /= sum;
        }
    });
    return band;
}

openvdb::Vec3s valueAt(const Attribute& attribute, const Blend& blend) {
    openvdb::Vec3s value(0);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < attribute.width; ++c)
            value[int(c)] += blend.weights[k] * attribute.values[blend.vertices[k] * attribute.width + c];
    return value;
}

template <typename GridType>
GridPtr makeGrid(const openvdb::FloatGrid& levelSet, const Attribute& attribute, const Band& band,
                 const RunContext& ctx) {
    using Value = typename GridType::ValueType;
    using Tree = typename GridType::TreeType;
    const auto grid = GridType::create(openvdb::zeroVal<Value>());
    grid->setTree(std::make_shared<Tree>(levelSet.tree(), openvdb::zeroVal<Value>(),
                                         openvdb::zeroVal<Value>(), openvdb::TopologyCopy()));
    openvdb::tree::LeafManager<Tree> leaves(grid->tree());
    std::unordered_map<openvdb::Coord, std::size_t> leafAt;
    for (std::size_t i = 0; i < band.origins.size(); ++i) leafAt[band.origins[i]] = i;
    parallelFor(ctx, leaves.leafCount(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            auto& leaf = leaves.leaf(n);
            const Blend* blends = &band.blends[leafAt.at(leaf.origin()) * BrickField::kSamples];
            for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
                const openvdb::Vec3s value = valueAt(attribute, blends[voxel.pos()]);
                if constexpr (std::is_same_v<Value, float>)
                    voxel.setValue(value[0]);
                else
                    voxel.setValue(value);
            }
        }
    });
    grid->setTransform(levelSet.transform().copy());
    grid->setName(attribute.name);
    grid->setVectorType(openvdb::VEC_INVARIANT);
    return grid;
}

std::vector<GridPtr> makeGrids(const openvdb::FloatGrid& levelSet, const Attributes& attributes,
                               const Band& band, const RunContext& ctx) {
    std::vector<GridPtr> grids;
    for (const Attribute& attribute : attributes)
        grids.push_back(attribute.width == 1 ? makeGrid<openvdb::FloatGrid>(levelSet, attribute, band, ctx)
                                             : makeGrid<openvdb::Vec3SGrid>(levelSet, attribute, band, ctx));
    return grids;
}

// A value's numbers.
template <typename Value>
openvdb::Vec3d asVec(const Value& value) {
    if constexpr (openvdb::VecTraits<Value>::IsVec)
        return openvdb::Vec3d(double(value[0]), double(value[1]), double(value[2]));
    else
        return openvdb::Vec3d(double(value), 0, 0);
}

// Trilinear over the active voxels around a position; the background where none is active.
template <typename GridType>
Attribute sampleOne(const GridType& grid, std::size_t width, const std::vector<Vec3f>& places,
                    const Vec3d& origin, const RunContext& ctx) {
    Attribute attribute{grid.getName(), width, {}};
    attribute.values.resize(places.size() * width);
    parallelFor(ctx, places.size(), 4096, [&](std::size_t begin, std::size_t end) {
        const auto accessor = grid.getConstAccessor();
        for (std::size_t n = begin; n < end; ++n) {
            const openvdb::Vec3d at = grid.worldToIndex(toVec(cast<double>(places[n]) + origin));
            const openvdb::Coord base = openvdb::Coord::floor(at);
            openvdb::Vec3d sum(0.0);
            double weights = 0;
            for (int i = 0; i < 8; ++i) {
                const openvdb::Coord voxel = base.offsetBy(i >> 2, i >> 1 & 1, i & 1);
                typename GridType::ValueType value;
                if (!accessor.probeValue(voxel, value)) continue;
                double weight = 1e-9;
                weight += (1 - std::abs(at.x() - voxel.x())) * (1 - std::abs(at.y() - voxel.y())) *
                          (1 - std::abs(at.z() - voxel.z()));
                sum += asVec(value) * weight;
                weights += weight;
            }
            const openvdb::Vec3d mean = weights > 0 ? sum / weights : asVec(grid.background());
            for (std::size_t c = 0; c < width; ++c)
                attribute.values[n * width + c] = std::isfinite(mean[int(c)]) ? float(mean[int(c)]) : 0.f;
        }
    });
    return attribute;
}

}  // namespace

std::vector<GridPtr> attributesToGrids(const Mesh& mesh, const openvdb::FloatGrid& levelSet,
                                       const RunContext& ctx) {
    if (mesh.attributes.empty()) return {};
    Stage stage(ctx, "attributes to grids", 1);
    const std::vector<GridPtr> grids =
        makeGrids(levelSet, mesh.attributes, blendFaces(levelSet, mesh, ctx), ctx);
    stage.advance();
    return grids;
}

std::vector<GridPtr> attributesToGrids(const PointCloud& cloud, const openvdb::FloatGrid& levelSet,
                                       const RunContext& ctx) {
    if (cloud.attributes.empty()) return {};
    Stage stage(ctx, "attributes to grids", 1);
    const std::vector<GridPtr> grids =
        makeGrids(levelSet, cloud.attributes, blendPoints(levelSet, cloud, ctx), ctx);
    stage.advance();
    return grids;
}

Attributes gridsToAttributes(const std::vector<GridPtr>& grids, const std::vector<Vec3f>& places,
                             const Vec3d& origin, const RunContext& ctx) {
    requireGrids(grids);
    Attributes attributes;
    for (const GridPtr& grid : grids) {
        if (grid->getGridClass() == openvdb::GRID_LEVEL_SET || grid->getName().empty()) continue;
        const bool sampled =
            grid->transform().isLinear() && grid->apply<AttributeGrids>([&](const auto& typed) {
                using Value = typename std::decay_t<decltype(typed)>::ValueType;
                const bool vector = openvdb::VecTraits<Value>::IsVec;
                const std::size_t width = !vector ? 1 : typed.getName() == "uv" ? 2 : 3;
                attributes.push_back(sampleOne(typed, width, places, origin, ctx));
            });
        if (!sampled)
            message(
                ctx, MessageLevel::Detail,
                "grid \"" + grid->getName() + "\" (" + grid->valueType() + ") cannot be sampled at vertices");
    }
    return attributes;
}

}  // namespace vdbsynth
