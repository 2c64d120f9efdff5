#include "libvdbsynth/pipeline/pose/pose.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/geometry/rest_map.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/surface/frame_field.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

namespace vdbsynth {
namespace {

// Where a voxel of the posed model is at rest; nothing where that is not known. Safe from many threads.
using Placing = std::function<std::optional<RestPlace>(const Index3& voxel)>;

// Cubes of eight voxels, each with the nearest faces of its voxels.
class NearestFaces {
public:
    NearestFaces(const Mesh& posed, const openvdb::FloatGrid& like, const IndexBox& box, float reach,
                 const RunContext& ctx) {
        Mesh index = posed;
        for (Vec3f& p : index.points) {
            const Vec3d world = cast<double>(p) + posed.origin;
            p = cast<float>(fromVec(like.transform().worldToIndex(toVec(world))));
        }
        index.origin = {};
        std::mutex mutex;
        forNearestFaces(index, box, reach, ctx, [&](const Index3& corner, const std::uint32_t* faces) {
            if (std::all_of(faces, faces + BrickField::kSamples,
                            [](std::uint32_t face) { return face == kNoFace; }))
                return;
            std::vector<std::uint32_t> kept(faces, faces + BrickField::kSamples);
            const std::lock_guard<std::mutex> lock(mutex);
            mCubes.emplace(key(corner), std::move(kept));
        });
    }

    std::uint32_t at(const Index3& voxel) const {
        const auto cube = mCubes.find(key({voxel.x & ~7, voxel.y & ~7, voxel.z & ~7}));
        if (cube == mCubes.end()) return kNoFace;
        return cube->second[std::size_t((voxel.x & 7) << 6 | (voxel.y & 7) << 3 | (voxel.z & 7))];
    }

private:
    static std::tuple<int, int, int> key(const Index3& p) { return {p.x, p.y, p.z}; }

    std::map<std::tuple<int, int, int>, std::vector<std::uint32_t>> mCubes;
};

Placing placedByMesh(const LevelSet& rest, const LevelSet& posed, const IndexBox& box, float reach,
                     const RunContext& ctx) {
    const auto map = std::make_shared<const RestMap>(*rest.source, *posed.source);
    const auto faces = std::make_shared<const NearestFaces>(map->posed(), *posed.grid, box, reach, ctx);
    const auto transform = posed.grid->transformPtr();
    return [=](const Index3& voxel) -> std::optional<RestPlace> {
        const std::uint32_t face = faces->at(voxel);
        if (face == kNoFace) return {};
        return map->at(fromVec(transform->indexToWorld(toCoord(voxel))), face);
    };
}

constexpr std::array<Vec3d, 3> kUnturned{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};

Placing placedByGrid(const openvdb::Vec3SGrid::ConstPtr& grid, const LevelSet& posed) {
    const auto transform = posed.grid->transformPtr();
    return [=](const Index3& voxel) -> std::optional<RestPlace> {
        const openvdb::Vec3d at = grid->transform().worldToIndex(transform->indexToWorld(toCoord(voxel)));
        // All that a trilinear value is made of has to be known.
        const auto accessor = grid->getConstUnsafeAccessor();
        const openvdb::Coord low = openvdb::Coord::floor(at + openvdb::Vec3d(1e-6));
        const openvdb::Vec3d part = at - low.asVec3d();
        openvdb::Vec3d sum(0);
        for (int corner = 0; corner < 8; ++corner) {
            const int step[3] = {corner >> 2, corner >> 1 & 1, corner & 1};
            double weight = 1;
            for (int axis = 0; axis < 3; ++axis) weight *= step[axis] ? part[axis] : 1 - part[axis];
            if (std::abs(weight) < 1e-5) continue;
            openvdb::Vec3s value;
            if (!accessor.probeValue(low.offsetBy(step[0], step[1], step[2]), value)) return {};
            sum += openvdb::Vec3d(value) * weight;
        }
        return RestPlace{fromVec(sum), kUnturned};
    };
}

openvdb::Vec3SGrid::ConstPtr restGridOf(const LevelSet& posed, const std::string& name) {
    for (const GridPtr& grid : posed.attributes)
        if (grid->getName() == name)
            if (const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid)) return vectors;
    return nullptr;
}

// The box of all that the result may touch, in whole cubes of eight voxels.
IndexBox posedBox(const LevelSet& posed, int reach) {
    IndexBox box = solidBox(*posed.grid, "the posed model");
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = (box.min[axis] - reach) & ~7;
        box.max[axis] = (box.max[axis] + reach) | 7;
    }
    return box;
}

// The made model's distances around all of it, in its own voxels.
struct MadeField {
    BrickField field;
    Index3 corner;
};

MadeField fieldOf(const LevelSet& made, int band, const RunContext& ctx) {
    IndexBox box = solidBox(*made.grid, "the result at rest");
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] -= band + 2;
        box.max[axis] += band + 2;
    }
    return {gatherWideBand(*made.grid, box, {}, float(band), ctx), box.min};
}

std::vector<MappedVoxel> mappedBand(const LevelSet& result, const LevelSet& made, const Placing& placing) {
    std::vector<MappedVoxel> voxels;
    for (auto value = result.grid->cbeginValueOn(); value; ++value) {
        const Index3 voxel = fromCoord(value.getCoord());
        const auto rest = placing(voxel);
        if (!rest) continue;
        Source source;
        source.position = fromVec(made.grid->transform().worldToIndex(toVec(rest->place)));
        source.rotation = rotationBetween(
            {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {cast<float>(rest->turn[0]), cast<float>(rest->turn[1]), cast<float>(rest->turn[2])});
        voxels.push_back({voxel, source});
    }
    return voxels;
}

Placing placingOf(const LevelSet& rest, const LevelSet& posed, const PoseOptions& options,
                  const IndexBox& box, float reach, const RunContext& ctx) {
    if (rest.source && posed.source) return placedByMesh(rest, posed, box, reach, ctx);
    if (const auto grid = restGridOf(posed, options.restGrid)) return placedByGrid(grid, posed);
    throw Error(ErrorCode::Unusable,
                "the model at rest and the posed one are not both meshes, and the posed one has no grid of "
                "vectors \"" +
                    options.restGrid + "\" with the places of its voxels at rest");
}

void sayUnknown(std::size_t unknown, std::size_t all, const PoseOptions& options, bool byMesh,
                const RunContext& ctx) {
    if (unknown == 0) return;
    message(
        ctx, MessageLevel::Warning,
        roundedText(100 * double(unknown) / double(std::max<std::size_t>(all, 1)), 3) +
            " % of the voxels that the texture may reach have no place at rest, and keep the plain "
            "surface; " +
            (byMesh ? "no face is near them: the mesh is open there; close its holes"
                    : "a grid \"" + options.restGrid + "\" with a wider band, " +
                          roundedText(double(options.reach) + 2, 3) + " voxels a side, carries it there"));
}

LevelSet posedLevelSet(const LevelSet& made, const LevelSet& rest, const LevelSet& posed,
                       const PoseOptions& options, const RunContext& ctx) {
    const double ratio = voxelSizeOf(*made.grid) / voxelSizeOf(*posed.grid);
    const float reach = float(double(options.reach) * ratio), wide = reach + options.halfWidth + 1;
    const int band = int(std::ceil(wide)) + 1;
    const IndexBox box = posedBox(posed, band);
    requireMemory(ctx, double(box.volume()) * 6 + double(activeVoxels(*posed.grid)) / 6 * 2 * band * 20,
                  "carrying the result to another pose", "use larger voxels");
    Stage stage(ctx, "carrying the result to the pose", 2);
    const Placing placing = placingOf(rest, posed, options, box, wide, ctx);
    const BrickField plain = gatherWideBand(*posed.grid, box, {}, wide, ctx);
    const float kept = options.halfWidth + 1;  // [voxels of the pose] distances beyond are not read
    const MadeField source = fieldOf(made, int(std::ceil(double(kept) / ratio)) + 2, ctx);
    stage.advance();
    std::atomic<std::size_t> unknown{0}, all{0};
    const BrickField field = BrickField::fromVoxels(plain.box(), ctx, [&](const Index3& p) {
        const float own = plain.at(p);
        if (!(std::abs(own) < wide)) return own;
        const auto rested = placing(p + box.min);
        const bool counts = std::abs(own) < reach + 1;
        if (counts) ++all;
        if (!rested) {
            if (counts) ++unknown;
            return own;
        }
        const openvdb::Vec3d at = made.grid->transform().worldToIndex(toVec(rested->place));
        const Vec3d inField =
            fromVec(at) - Vec3d{double(source.corner.x), double(source.corner.y), double(source.corner.z)};
        return float(ratio) * sampleCubic(source.field, cast<float>(inField));
    });
    sayUnknown(unknown, all, options, rest.source && posed.source, ctx);
    LevelSet result;
    const CloseOptions close{{}, options.halfWidth, kept, voxelSizeOf(*posed.grid), false};
    result.grid = levelSetFrom(closedBand(field, box.min, close, ctx), options.halfWidth, *posed.grid,
                               "the posed result", ctx);
    result.domain = solidBox(*result.grid, "the posed result");
    stampLevelSet(result);
    if (!made.attributes.empty())
        result.attributes =
            transferToVoxels(mappedBand(result, made, placing), {&made}, *result.grid, {}, ctx);
    stage.advance();
    return result;
}

}  // namespace

void validate(const PoseOptions& options) {
    requireHalfWidth(double(options.halfWidth));
    requireOption(options.reach >= 0 && options.reach <= 64, "reach", roundedText(double(options.reach), 4),
                  "0 to 64");
}

LevelSet poseModel(const LevelSet& made, const LevelSet& rest, const LevelSet& posed,
                   const PoseOptions& options, const RunContext& ctx) {
    validate(options);
    requireModel(&made, "the result at rest", ctx);
    requireModel(&posed, "the posed model", ctx);
    return withThreads(ctx, [&] { return posedLevelSet(made, rest, posed, options, ctx); });
}

}  // namespace vdbsynth
