#include "libvdbsynth/vdb/grid_reader.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Interpolation.h>

#include <memory>
#include <type_traits>

namespace vdbsynth {
namespace {

template <typename Accessor>
auto sampled(const Accessor& accessor, const openvdb::Vec3d& at, GridSampling sampling) {
    return sampling == GridSampling::Linear ? openvdb::tools::BoxSampler::sample(accessor, at)
                                            : openvdb::tools::PointSampler::sample(accessor, at);
}

template <typename Grid>
GridReader readerOf(const Grid& grid, GridSampling sampling) {
    auto accessor = std::make_shared<typename Grid::ConstAccessor>(grid.getConstAccessor());
    return [&grid, accessor, sampling](const Vec3d& world) {
        using Value = typename Grid::ValueType;
        const openvdb::Vec3d at = grid.transform().worldToIndex(toVec(world));
        GridReading reading;
        reading.active = accessor->isValueOn(openvdb::Coord::round(at));
        if constexpr (std::is_same_v<Grid, openvdb::MaskGrid>) {
            reading.value.z = reading.active;
        } else if constexpr (openvdb::VecTraits<Value>::IsVec) {
            const Value value = sampled(*accessor, at, sampling);
            reading.value = {double(value.x()), double(value.y()), double(value.z())};
        } else if constexpr (std::is_floating_point_v<Value>) {
            reading.value.z = double(sampled(*accessor, at, sampling));
        } else {
            reading.value.z = double(openvdb::tools::PointSampler::sample(*accessor, at));
        }
        return reading;
    };
}

}  // namespace

GridReader scalarReader(const openvdb::GridBase& grid, GridSampling sampling, const std::string& what) {
    GridReader reader;
    if (!grid.apply<ScalarGrids>([&](const auto& typed) { reader = readerOf(typed, sampling); }))
        throw Error(ErrorCode::BadData,
                    what + ": grid \"" + grid.getName() + "\" (" + grid.valueType() + ") holds no scalars");
    return reader;
}

GridReader vectorReader(const openvdb::GridBase& grid, GridSampling sampling) {
    GridReader reader;
    grid.apply<VectorGrids>([&](const auto& typed) { reader = readerOf(typed, sampling); });
    return reader;
}

GridReader gradientReader(const openvdb::GridBase& grid) {
    GridReader scalar;
    if (!grid.apply<RealScalarGrids>(
            [&](const auto& typed) { scalar = readerOf(typed, GridSampling::Linear); }))
        return {};
    return [scalar, step = grid.voxelSize()[0]](const Vec3d& world) {
        GridReading gradient = scalar(world);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d low = world, high = world;
            low[axis] -= step;
            high[axis] += step;
            gradient.value[axis] = (scalar(high).value.z - scalar(low).value.z) / (2 * step);
        }
        return gradient;
    };
}

}  // namespace vdbsynth
