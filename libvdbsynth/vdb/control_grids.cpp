#include "libvdbsynth/vdb/control_grids.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/grid_reader.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/mask.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>

namespace vdbsynth {
namespace {

// Velocities and rotation vectors are both vectors; only what is said of a grid tells them apart.
void refuseVelocity(const openvdb::GridBase& grid) {
    std::string name = grid.getName();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    const bool named = name == "v" || name == "vel" || name.find("velocity") != std::string::npos;
    if (!named && grid.getGridClass() != openvdb::GRID_STAGGERED &&
        grid.getVectorType() != openvdb::VEC_CONTRAVARIANT_RELATIVE &&
        grid.getVectorType() != openvdb::VEC_CONTRAVARIANT_ABSOLUTE)
        return;
    throw Error(ErrorCode::BadData,
                "`rotationMap`: grid \"" + grid.getName() +
                    "\" is a velocity or another vector of space; it must hold rotation vectors (the axis "
                    "times the angle in radians, vector type invariant), or angles about z");
}

GridReader rotationReader(const openvdb::GridBase& grid) {
    if (GridReader vectors = vectorReader(grid, GridSampling::Nearest)) {
        refuseVelocity(grid);
        return vectors;
    }
    return scalarReader(grid, GridSampling::Nearest, "`rotationMap`");
}

// From a frame's voxels to the world.
using Place = std::function<Vec3d(const Index3& voxel)>;

Place placesOf(const ControlFrame& frame) {
    return [frame, transform = frame.like->transformPtr()](Index3 voxel) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!frame.tiles[std::size_t(axis)]) continue;
            const int period = frame.period.size()[axis], from = voxel[axis] - frame.period.min[axis];
            voxel[axis] = frame.period.min[axis] + (from % period + period) % period;
        }
        return fromVec(transform->indexToWorld(openvdb::Vec3d(voxel.x, voxel.y, voxel.z)));
    };
}

[[noreturn]] void refuse(const char* option, double value, const Index3& voxel, const std::string& range) {
    throw Error(ErrorCode::Unusable, std::string("`") + option + "`: " + std::to_string(value) +
                                         " at voxel " + std::to_string(voxel.x) + "," +
                                         std::to_string(voxel.y) + "," + std::to_string(voxel.z) +
                                         " of the result; give " + range);
}

// Any of the readers may be empty.
struct Readers {
    GridReader exemplarNumber, rotationVector, scale;
    bool insideIsSecond = false;
    int exemplars = 1;

    WantedVariant at(const Vec3d& world, const Index3& voxel) const {
        WantedVariant want;
        if (exemplarNumber) {
            const double value = exemplarNumber(world).value.z;
            const double number = insideIsSecond ? (value < 0 ? 1 : 0) : std::round(value);
            if (!(number >= 0 && number < exemplars))
                refuse("exemplarMap", value, voxel,
                       "numbers of exemplars, 0 to " + std::to_string(exemplars - 1));
            want.exemplar = std::int32_t(number);
        }
        if (rotationVector) {
            want.rotation = rotationVector(world).value;
            const double angle = length(want.rotation);
            if (!(angle <= 100)) refuse("rotationMap", angle, voxel, "angles up to 100 radians");
        }
        if (scale) {
            const GridReading reading = scale(world);
            want.scale = !reading.active && reading.value.z == 0 ? 1 : reading.value.z;
            if (!(want.scale >= 0.25 && want.scale <= 4))
                refuse("scaleMap", want.scale, voxel, "scales from 0.25 to 4");
        }
        return want;
    }
};

}  // namespace

GridConstPtr asControl(const FloatGridConstPtr& grid) {
    return grid;
}

BrickField sampledScalar(const openvdb::GridBase& grid, const ControlFrame& frame, const std::string& what,
                         const RunContext& ctx) {
    scalarReader(grid, GridSampling::Linear,
                 what);  // a grid of a wrong kind is refused here, not in a worker
    const Place worldOf = placesOf(frame);
    return BrickField::generate(IndexBox::fromSize(frame.box.size()), ctx,
                                [&](const IndexBox& brick, float* samples) {
                                    const GridReader reader = scalarReader(grid, GridSampling::Linear, what);
                                    forEachVoxel(brick, [&](const Index3& p) {
                                        *samples++ = float(reader(worldOf(frame.box.min + p)).value.z);
                                    });
                                });
}

namespace {

constexpr float kFade = 3;  // [voxels] of the frame, inside a solid mask

// A mask that is a solid, as a level set with distances on the lattice of its frame; null: it holds numbers.
FloatGridConstPtr solidMask(const openvdb::GridBase& grid, const ControlFrame& frame, const std::string& what,
                            const RunContext& ctx) {
    const FloatGridConstPtr solid = solidOfMask(grid, what, ctx);
    if (!solid) return nullptr;
    return resampleLevelSet(*solid, *frame.like, kFade + 2, what, ctx);
}

}  // namespace

BrickField sampledWeight(const openvdb::GridBase& grid, const ControlFrame& frame, float strength,
                         const std::string& what, const RunContext& ctx) {
    const FloatGridConstPtr solid = solidMask(grid, frame, what, ctx);
    const BrickField scalar = sampledScalar(grid, frame, what, ctx);
    const BrickField depth = solid ? sampledScalar(*solid, frame, what, ctx) : BrickField();
    const float fade = kFade * float(frame.like->voxelSize()[0]);
    return BrickField::generate(scalar.box(), ctx, [&](const IndexBox& brick, float* samples) {
        std::array<float, BrickField::kSamples> distance{};
        scalar.readBox(brick.min, brick.size(), samples);
        if (solid) depth.readBox(brick.min, brick.size(), distance.data());
        for (std::size_t i = 0; i < distance.size(); ++i) {
            // Outside the mask's own surface nothing may change, whatever the resampling made of it.
            const float share = !solid ? samples[i] : samples[i] < 0 ? -distance[i] / fade : 0;
            samples[i] = share > 0 ? strength * std::min(share, 1.f) : 0;
        }
    });
}

namespace {

// The middle voxel of every cell, within the box.
std::vector<Index3> variantVoxels(const IndexBox& box) {
    const Index3 cells = variantCells(box);
    std::vector<Index3> voxels(latticeCount(cells));
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        Index3 voxel = latticeVoxel(i, cells);
        for (int axis = 0; axis < 3; ++axis)
            voxel[axis] =
                std::min(box.min[axis] + voxel[axis] * kVariantCell + kVariantCell / 2, box.max[axis]);
        voxels[i] = voxel;
    }
    return voxels;
}

}  // namespace

std::vector<Vec3d> variantPlaces(const ControlFrame& frame) {
    const Place worldOf = placesOf(frame);
    std::vector<Vec3d> places;
    for (const Index3& voxel : variantVoxels(frame.box)) places.push_back(worldOf(voxel));
    return places;
}

std::vector<WantedVariant> wantedVariants(const openvdb::GridBase* exemplarMap,
                                          const openvdb::GridBase* rotation, const openvdb::GridBase* scale,
                                          int exemplars, const ControlFrame& frame, const RunContext& ctx) {
    const auto readers = [&] {
        Readers made;
        if (exemplarMap)
            made.exemplarNumber = scalarReader(*exemplarMap, GridSampling::Nearest, "`exemplarMap`");
        if (rotation) made.rotationVector = rotationReader(*rotation);
        if (scale) made.scale = scalarReader(*scale, GridSampling::Nearest, "`scaleMap`");
        made.insideIsSecond = exemplarMap && exemplarMap->getGridClass() == openvdb::GRID_LEVEL_SET;
        made.exemplars = exemplars;
        return made;
    };
    readers();  // grids of a wrong kind are refused here, not in a worker
    const std::vector<Index3> voxels = variantVoxels(frame.box);
    const std::vector<Vec3d> places = variantPlaces(frame);
    std::vector<WantedVariant> wanted(voxels.size());
    parallelFor(ctx, wanted.size(), 4096, [&](std::size_t begin, std::size_t end) {
        const Readers own = readers();
        for (std::size_t i = begin; i < end; ++i) wanted[i] = own.at(places[i], voxels[i]);
    });
    double most = 0;
    for (const WantedVariant& want : wanted) most = std::max(most, length(want.rotation));
    if (most > 2 * kPi)
        message(ctx, MessageLevel::Warning,
                "`rotationMap`: angles up to " + roundedText(most, 3) +
                    " radians, over a full turn; it must hold rotation vectors, the axis times the angle in "
                    "radians, or angles about z");
    return wanted;
}

}  // namespace vdbsynth
