#include "libvdbsynth/pipeline/control.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <functional>
#include <type_traits>

namespace vdbsynth {
namespace {

constexpr int kCell = 4;  // [voxels] from one place of a control to the next

using Scalars = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                  openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid>;
using Vectors = openvdb::TypeList<openvdb::Vec3SGrid, openvdb::Vec3DGrid>;

struct Reading {
    Vec3d value;
    bool active = false;
};

using Reader = std::function<Reading(const openvdb::Vec3d& world)>;

// Reads one grid at places of the world; a scalar is the z of what it gives. From one thread.
template <typename Grid>
Reader readerOf(const Grid& grid, bool smooth) {
    auto accessor = std::make_shared<typename Grid::ConstAccessor>(grid.getConstAccessor());
    return [&grid, accessor, smooth](const openvdb::Vec3d& world) {
        using Value = typename Grid::ValueType;
        const openvdb::Vec3d at = grid.transform().worldToIndex(world);
        Reading reading;
        reading.active = accessor->isValueOn(openvdb::Coord::round(at));
        if constexpr (std::is_same_v<Grid, openvdb::MaskGrid>) {
            reading.value.z = reading.active;
        } else if constexpr (openvdb::VecTraits<Value>::IsVec) {
            const Value value = openvdb::tools::PointSampler::sample(*accessor, at);
            reading.value = {double(value.x()), double(value.y()), double(value.z())};
        } else if constexpr (std::is_floating_point_v<Value>) {
            reading.value.z = smooth ? double(openvdb::tools::BoxSampler::sample(*accessor, at))
                                     : double(openvdb::tools::PointSampler::sample(*accessor, at));
        } else {
            reading.value.z = double(openvdb::tools::PointSampler::sample(*accessor, at));
        }
        return reading;
    };
}

Reader scalarReader(const openvdb::GridBase& grid, bool smooth, const std::string& what) {
    Reader reader;
    if (!grid.apply<Scalars>([&](const auto& typed) { reader = readerOf(typed, smooth); }))
        throw Error(ErrorCode::BadData,
                    what + ": grid \"" + grid.getName() + "\" (" + grid.valueType() + ") holds no scalars");
    return reader;
}

Reader rotationReader(const openvdb::GridBase& grid) {
    Reader reader;
    if (grid.apply<Vectors>([&](const auto& typed) { reader = readerOf(typed, false); })) return reader;
    return scalarReader(grid, false, "`rotationMap`");
}

openvdb::Vec3d worldOf(const ControlFrame& frame, Index3 voxel) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!frame.tiles[std::size_t(axis)]) continue;
        const int period = frame.period.size()[axis], from = voxel[axis] - frame.period.min[axis];
        voxel[axis] = frame.period.min[axis] + (from % period + period) % period;
    }
    return frame.like->transform().indexToWorld(openvdb::Vec3d(voxel.x, voxel.y, voxel.z));
}

Index3 cellsOf(const IndexBox& box) {
    const Index3 size = box.size();
    return {(size.x + kCell - 1) / kCell, (size.y + kCell - 1) / kCell, (size.z + kCell - 1) / kCell};
}

[[noreturn]] void refuse(const char* option, double value, const Index3& voxel, const std::string& range) {
    throw Error(ErrorCode::Unusable, std::string("`") + option + "`: " + std::to_string(value) +
                                         " at voxel " + std::to_string(voxel.x) + "," +
                                         std::to_string(voxel.y) + "," + std::to_string(voxel.z) +
                                         " of the result; give " + range);
}

// Any of the readers may be empty.
struct Readers {
    Reader which, rotation, scale;
    bool insideIsSecond = false;
    int exemplars = 1;

    WantedVariant at(const openvdb::Vec3d& world, const Index3& voxel) const {
        WantedVariant want;
        if (which) {
            const double value = which(world).value.z;
            const double number = insideIsSecond ? (value < 0 ? 1 : 0) : std::round(value);
            if (!(number >= 0 && number < exemplars))
                refuse("exemplarMap", value, voxel,
                       "numbers of exemplars, 0 to " + std::to_string(exemplars - 1));
            want.exemplar = std::int32_t(number);
        }
        if (rotation) {
            want.rotation = rotation(world).value;
            const double angle = length(want.rotation);
            if (!(angle <= 100)) refuse("rotationMap", angle, voxel, "angles up to 100 radians");
        }
        if (scale) {
            const Reading reading = scale(world);
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
    scalarReader(grid, true, what);  // a grid of a wrong kind is refused here, not in a worker
    return BrickField::generate(
        IndexBox::fromSize(frame.box.size()), ctx, [&](const IndexBox& brick, float* samples) {
            const Reader reader = scalarReader(grid, true, what);
            for (int x = brick.min.x; x <= brick.max.x; ++x)
                for (int y = brick.min.y; y <= brick.max.y; ++y)
                    for (int z = brick.min.z; z <= brick.max.z; ++z)
                        *samples++ = float(reader(worldOf(frame, frame.box.min + Index3{x, y, z})).value.z);
        });
}

std::vector<WantedVariant> wantedVariants(const openvdb::GridBase* which, const openvdb::GridBase* rotation,
                                          const openvdb::GridBase* scale, int exemplars,
                                          const ControlFrame& frame, const RunContext& ctx) {
    const auto readers = [&] {
        Readers made;
        if (which) made.which = scalarReader(*which, false, "`exemplarMap`");
        if (rotation) made.rotation = rotationReader(*rotation);
        if (scale) made.scale = scalarReader(*scale, false, "`scaleMap`");
        made.insideIsSecond = which && which->getGridClass() == openvdb::GRID_LEVEL_SET;
        made.exemplars = exemplars;
        return made;
    };
    readers();  // grids of a wrong kind are refused here, not in a worker
    const Index3 cells = cellsOf(frame.box);
    std::vector<WantedVariant> wanted(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z));
    parallelFor(ctx, wanted.size(), 4096, [&](std::size_t begin, std::size_t end) {
        const Readers own = readers();
        for (std::size_t i = begin; i < end; ++i) {
            Index3 voxel{int(i / std::size_t(cells.z) / std::size_t(cells.y)),
                         int(i / std::size_t(cells.z) % std::size_t(cells.y)), int(i % std::size_t(cells.z))};
            for (int axis = 0; axis < 3; ++axis)
                voxel[axis] =
                    std::min(frame.box.min[axis] + voxel[axis] * kCell + kCell / 2, frame.box.max[axis]);
            wanted[i] = own.at(worldOf(frame, voxel), voxel);
        }
    });
    return wanted;
}

BrickField fieldOfNumbers(const std::vector<std::int32_t>& numbers, const IndexBox& box,
                          const RunContext& ctx) {
    const Index3 cells = cellsOf(box);
    return BrickField::generate(
        IndexBox::fromSize(box.size()), ctx, [&](const IndexBox& brick, float* samples) {
            for (int x = brick.min.x; x <= brick.max.x; ++x)
                for (int y = brick.min.y; y <= brick.max.y; ++y)
                    for (int z = brick.min.z; z <= brick.max.z; ++z) {
                        const Index3 cell{std::min(x / kCell, cells.x - 1), std::min(y / kCell, cells.y - 1),
                                          std::min(z / kCell, cells.z - 1)};
                        *samples++ =
                            float(numbers[(std::size_t(cell.x) * std::size_t(cells.y) + std::size_t(cell.y)) *
                                              std::size_t(cells.z) +
                                          std::size_t(cell.z)]);
                    }
        });
}

}  // namespace vdbsynth
