// A source map as grids.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "libvdbsynth/vdb/source_map_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using namespace mapfile;

constexpr double kExactFloat = 1 << 24;

void putText(openvdb::GridBase& grid, const std::string& name, const std::string& value) {
    grid.insertMeta(key(name), openvdb::StringMetadata(value));
}

std::string facesText(const std::array<bool, 6>& faces) {
    std::string text;
    for (bool face : faces) text += face ? '1' : '0';
    return text;
}

std::string numbersText(const Affine& numbers) {
    std::string text;
    for (double number : numbers) text += (text.empty() ? "" : ",") + exactText(number);
    return text;
}

std::string variantsText(const std::vector<ExemplarVariant>& variants) {
    std::string text;
    for (const ExemplarVariant& v : variants) {
        text += std::to_string(v.exemplar);
        for (double number : {v.rotation.x, v.rotation.y, v.rotation.z, v.scale})
            text += "," + exactText(number);
        text += "," + std::to_string(v.size.x) + "," + std::to_string(v.size.y) + "," +
                std::to_string(v.size.z) + ";";
    }
    return text;
}

std::string depthsText(const std::vector<DepthRun>& depths) {
    std::string text;
    for (const DepthRun& run : depths)
        text += (text.empty() ? "" : ";") + std::to_string(run.from) + (run.full ? ",1" : ",0");
    return text;
}

// Grids of one kind or the other behind the same functions.
class Writer {
public:
    Writer(MapTypes types, const openvdb::math::Transform& transform)
        : mTypes(types), mTransform(transform) {}

    /// A grid of integer vectors.
    GridPtr places(const char* name, const std::vector<std::pair<openvdb::Coord, Vec3d>>& values) const {
        if (mTypes == MapTypes::Integer)
            return filled(emptyGrid<openvdb::Vec3IGrid>(), name, values,
                          [](const Vec3d& v) { return openvdb::Vec3i(int(v.x), int(v.y), int(v.z)); });
        for (const auto& [at, v] : values)
            if (std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) > kExactFloat)
                throw Error(ErrorCode::Unusable,
                            "`mapTypes` float holds coordinates up to 2^24 exactly, and the exemplar's are "
                            "larger; use integer");
        return vectors(name, values);
    }
    GridPtr vectors(const char* name, const std::vector<std::pair<openvdb::Coord, Vec3d>>& values) const {
        return filled(openvdb::Vec3SGrid::create(openvdb::Vec3f(0)), name, values,
                      [](const Vec3d& v) { return openvdb::Vec3f(float(v.x), float(v.y), float(v.z)); });
    }
    GridPtr numbers(const char* name,
                    const std::vector<std::pair<openvdb::Coord, std::int32_t>>& values) const {
        if (mTypes == MapTypes::Integer)
            return filled(openvdb::Int32Grid::create(0), name, values, [](std::int32_t n) { return n; });
        return filled(openvdb::FloatGrid::create(0.f), name, values, [](std::int32_t n) { return float(n); });
    }
    GridPtr scalars(const char* name, const std::vector<std::pair<openvdb::Coord, float>>& values,
                    float background) const {
        return filled(openvdb::FloatGrid::create(background), name, values, [](float v) { return v; });
    }

private:
    template <typename Grid, typename Values, typename To>
    GridPtr filled(const std::shared_ptr<Grid>& grid, const char* name, const Values& values,
                   const To& to) const {
        grid->setName(name);
        grid->setTransform(mTransform.copy());
        auto accessor = grid->getAccessor();
        for (const auto& [at, value] : values) accessor.setValueOn(at, to(value));
        return grid;
    }

    MapTypes mTypes;
    const openvdb::math::Transform& mTransform;
};

// Sources unchanged, at the result's voxels.
std::vector<GridPtr> voxelGrids(const std::vector<MappedVoxel>& voxels, const Writer& writer) {
    std::vector<std::pair<openvdb::Coord, Vec3d>> places, offsets, rotations;
    std::vector<std::pair<openvdb::Coord, std::int32_t>> exemplars;
    std::vector<std::pair<openvdb::Coord, float>> scales;
    bool between = false, rotated = false, scaled = false;
    for (const auto& [to, from] : voxels) {
        const Index3 nearest = nearestVoxel(from);
        const Vec3d place{double(nearest.x), double(nearest.y), double(nearest.z)};
        const Vec3d offset = from.position - place, rotation = cast<double>(from.rotation);
        places.emplace_back(toCoord(to), place);
        exemplars.emplace_back(toCoord(to), from.exemplar);
        offsets.emplace_back(toCoord(to), offset);
        rotations.emplace_back(toCoord(to), rotation);
        scales.emplace_back(toCoord(to), from.scale);
        between = between || length(offset) > 0;
        rotated = rotated || length(rotation) > 0;
        scaled = scaled || from.scale != 1;
    }
    std::vector<GridPtr> grids{writer.places("source", places), writer.numbers("exemplar", exemplars)};
    if (between) grids.push_back(writer.vectors("source_offset", offsets));
    if (rotated) grids.push_back(writer.vectors("source_rotation", rotations));
    if (scaled) grids.push_back(writer.scalars("source_scale", scales, 1.f));
    return grids;
}

// The blocks on their lattice; the grid of their positions first.
std::vector<GridPtr> blockGrids(const SourceMap& map, MapTypes types) {
    const openvdb::math::Transform::Ptr unit = openvdb::math::Transform::createLinearTransform();
    const Writer writer(types, *unit);
    std::vector<std::pair<openvdb::Coord, Vec3d>> places;
    std::vector<std::pair<openvdb::Coord, float>> weights;
    std::vector<std::pair<openvdb::Coord, std::int32_t>> numbers;
    for (std::size_t i = 0; i < map.patches.source.size(); ++i) {
        const openvdb::Coord at = toCoord(map.patches.place(i));
        const std::int32_t number = map.patches.exemplar[i];
        Index3 source = map.patches.source[i];
        if (map.variants.empty()) source = source + map.exemplars[std::size_t(number)].box.min;
        places.emplace_back(at, Vec3d{double(source.x), double(source.y), double(source.z)});
        weights.emplace_back(at, map.patches.weight.empty() ? 1.f : map.patches.weight[i]);
        numbers.emplace_back(at, number);
    }
    std::vector<GridPtr> grids{writer.places("vote_source", places),
                               writer.scalars("vote_weight", weights, 0.f)};
    if (map.exemplars.size() > 1 || !map.variants.empty())
        grids.push_back(writer.numbers("vote_exemplar", numbers));
    return grids;
}

void describeBlocks(const SourceMap& map, openvdb::GridBase& grid) {
    const PatchMap& patches = map.patches;
    putText(grid, "patch", std::to_string(patches.block));
    putText(grid, "stride", std::to_string(patches.stride));
    putText(grid, "matched", std::to_string(map.matched));
    putText(grid, "overhang",
            std::to_string(patches.overhang.x) + "," + std::to_string(patches.overhang.y) + "," +
                std::to_string(patches.overhang.z));
    putText(grid, "kernel", patches.vote == PatchVote::First ? kFirstKernel : kVoteKernel);
    putText(grid, "draft", map.draft ? "1" : "0");
    if (!map.variants.empty()) putText(grid, "variants", variantsText(map.variants));
}

void describeTarget(const SourceMap& map, openvdb::GridBase& grid) {
    putText(grid, "target_hash", map.target.hash);
    putText(grid, "target_voxel_size", exactText(map.target.voxelSize));
    putText(grid, "target_domain_recorded", map.target.domainRecorded ? "1" : "0");
    if (map.method == MapMethod::Fill) {
        putText(grid, "method", "fill");
        putText(grid, "from_self", map.hole.fromSelf ? "1" : "0");
        putText(grid, "guessed", map.hole.guessed ? "1" : "0");
    } else {
        putText(grid, "method", "analogy");
        putText(grid, "kernel", kNeighbourKernel);
        putText(grid, "scale", exactText(map.analogy.scale));
        putText(grid, "strength", exactText(map.analogy.strength));
        putText(grid, "depths", depthsText(map.analogy.depths));
    }
}

void describe(const SourceMap& map, openvdb::GridBase& grid) {
    putText(grid, "format", kFormat);
    putText(grid, "cut", facesText(map.cut));
    putText(grid, "target_box", boxText(map.targetBox));
    putText(grid, "target_domain", boxText(map.targetDomain));
    putText(grid, "band", exactText(map.band));
    putText(grid, "half_width", exactText(map.halfWidth));
    putText(grid, "voxel_size", exactText(map.voxelSize));
    if (dot(map.moved, map.moved) > 0)
        putText(grid, "moved",
                exactText(map.moved.x) + "," + exactText(map.moved.y) + "," + exactText(map.moved.z));
    if (map.exemplars.size() > 1) putText(grid, "exemplars", std::to_string(map.exemplars.size()));
    for (std::size_t e = 0; e < map.exemplars.size(); ++e) {
        putText(grid, numbered("exemplar_box", e), boxText(map.exemplars[e].box));
        putText(grid, numbered("exemplar_domain", e), boxText(map.exemplars[e].domain));
        putText(grid, numbered("exemplar_hash", e), map.exemplars[e].hash);
        putText(grid, numbered("exemplar_transform", e), numbersText(map.exemplars[e].transform));
        if (map.method != MapMethod::Synthesis)
            putText(grid, numbered("exemplar_cut", e), facesText(map.exemplars[e].cut));
    }
    if (map.method != MapMethod::Analogy) describeBlocks(map, grid);
    if (map.method != MapMethod::Synthesis) describeTarget(map, grid);
}

// True if a map by blocks has sources for a voxel of its result.
bool covers(const SourceMap& map, const Index3& voxel) {
    if (map.method == MapMethod::Synthesis) return map.targetDomain.contains(voxel);
    const Index3 local = voxel - map.hole.corner;
    return map.targetBox.contains(voxel) && map.hole.distance.box().contains(local) &&
           map.hole.distance.inside(local) < 0;
}

std::vector<MappedVoxel> elementVoxels(const SourceMap& map, const openvdb::FloatGrid& result) {
    std::vector<MappedVoxel> voxels;
    if (map.elements.size() == 0) return voxels;
    IndexBox box{map.elements.voxels().front(), map.elements.voxels().front()};
    for (const Index3& voxel : map.elements.voxels())
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], voxel[axis]);
            box.max[axis] = std::max(box.max[axis], voxel[axis]);
        }
    const VoxelTable table = VoxelTable::of(box, map.elements.voxels());
    for (auto it = result.cbeginValueOn(); it; ++it) {
        const Index3 voxel = fromCoord(it.getCoord());
        const std::int32_t i = table.find(coarserVoxel(voxel, map.finer));
        if (i < 0) continue;
        voxels.push_back({voxel, map.finer == 1 ? *map.elements.strongest(std::size_t(i))
                                                : finerSource(map, std::size_t(i), voxel)});
    }
    return voxels;
}

// Values unchanged, active over the field's box.
GridPtr fieldGrid(const char* name, const BrickField& field, const Index3& corner,
                  const openvdb::math::Transform& transform) {
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.f);
    const IndexBox box = field.box();
    std::vector<float> row(std::size_t(box.size().z));
    auto accessor = grid->getAccessor();
    for (int x = 0; x <= box.max.x; ++x)
        for (int y = 0; y <= box.max.y; ++y) {
            field.readBox({x, y, 0}, {1, 1, box.size().z}, row.data());
            for (int z = 0; z <= box.max.z; ++z)
                accessor.setValueOn(toCoord(corner + Index3{x, y, z}), row[std::size_t(z)]);
        }
    grid->pruneGrid();
    grid->setName(name);
    grid->setTransform(transform.copy());
    return grid;
}

}  // namespace

std::vector<MappedVoxel> mappedVoxels(const SourceMap& map, const openvdb::FloatGrid& result,
                                      const RunContext& ctx) {
    if (map.method == MapMethod::Analogy) return elementVoxels(map, result);
    std::vector<MappedVoxel> voxels;
    for (auto it = result.cbeginValueOn(); it; ++it) {
        const Index3 voxel = fromCoord(it.getCoord());
        if (covers(map, voxel)) voxels.push_back({voxel, {}});
    }
    parallelFor(ctx, voxels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) voxels[i].from = strongestSource(map, voxels[i].to);
    });
    return voxels;
}

std::vector<MappedVoxel> mappedVoxelsIn(const SourceMap& map, const IndexBox& box,
                                        const openvdb::FloatGrid& except, const RunContext& ctx) {
    if (map.method == MapMethod::Analogy) throw Error(ErrorCode::InvalidOption, "a map without blocks");
    std::vector<MappedVoxel> voxels;
    const auto active = except.getConstAccessor();
    forEachVoxel(box, [&](const Index3& voxel) {
        if (covers(map, voxel) && !active.isValueOn(toCoord(voxel))) voxels.push_back({voxel, {}});
    });
    parallelFor(ctx, voxels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) voxels[i].from = strongestSource(map, voxels[i].to);
    });
    return voxels;
}

std::vector<GridPtr> sourceMapGrids(const SourceMap& map, const openvdb::FloatGrid& result,
                                    const RunContext& ctx, MapTypes types) {
    Stage stage(ctx, "source map", 1);
    std::vector<MappedVoxel> voxels;
    if (map.method != MapMethod::Analogy) voxels = mappedVoxels(map, result, ctx);
    // Beyond the result's band too: another texture's surface may be there.
    for (std::size_t i = 0; i < map.elements.size(); ++i)
        voxels.push_back({map.elements.voxels()[i], *map.elements.strongest(i)});
    std::vector<GridPtr> grids = voxelGrids(voxels, Writer(types, result.transform()));
    if (map.method == MapMethod::Analogy) {
        describe(map, *grids.front());
        if (!map.analogy.weight.box().empty())
            grids.push_back(
                fieldGrid("source_strength", map.analogy.weight, map.targetBox.min, result.transform()));
    } else {
        const std::vector<GridPtr> blocks = blockGrids(map, types);
        describe(map, *blocks.front());
        grids.insert(grids.begin() + 2, blocks.begin(), blocks.end());
        if (map.method == MapMethod::Fill)
            grids.push_back(fieldGrid("source_hole", map.hole.distance, map.hole.corner, result.transform()));
    }
    stage.advance();
    return grids;
}

bool isOfSourceMap(const std::string& name) {
    for (const char* known :
         {"source", "exemplar", "source_offset", "source_rotation", "source_scale", "source_hole",
          "source_strength", "vote_source", "vote_weight", "vote_exemplar"})
        if (name == known) return true;
    return false;
}

}  // namespace vdbsynth
