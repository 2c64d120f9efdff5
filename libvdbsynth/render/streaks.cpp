#include "libvdbsynth/render/streaks.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

namespace {

constexpr int kSteps = 12;
constexpr double kStep = 0.5;  // [voxels]

double noise(const openvdb::Vec3d& p) {
    const openvdb::Coord voxel = openvdb::Coord::round(p);
    const auto part = [](int v) { return std::uint64_t(std::uint32_t(v)) & 0x1fffff; };
    return Random(1, part(voxel.x()) << 42 | part(voxel.y()) << 21 | part(voxel.z())).uniform();
}

const openvdb::Vec3SGrid* vectorsOf(const GridConstPtr& grid) {
    if (!grid) throw Error(ErrorCode::InvalidOption, "`directions`: null; a grid of vectors is needed");
    if (!grid->isType<openvdb::Vec3SGrid>())
        throw Error(ErrorCode::BadData, "`directions`: grid " + grid->getName() + " holds " +
                                            grid->valueType() + "; vectors of floats are needed");
    return static_cast<const openvdb::Vec3SGrid*>(grid.get());
}

}  // namespace

struct Streaks::Impl {
    const openvdb::Vec3SGrid* field;
    openvdb::Vec3SGrid::ConstAccessor accessor;

    // The unit vector of the field at a place, in index space.
    bool along(const openvdb::Vec3d& p, Vec3d& direction) {
        openvdb::Vec3f value;
        if (!accessor.probeValue(openvdb::Coord::round(p), value)) return false;
        direction =
            fromVec(field->worldToIndex(field->indexToWorld(openvdb::Vec3d(0)) + openvdb::Vec3d(value)));
        const double size = length(direction);
        if (!(size > 0)) return false;
        direction = direction * (1 / size);
        return true;
    }
};

Streaks::Streaks(const GridConstPtr& field) {
    const openvdb::Vec3SGrid* vectors = vectorsOf(field);
    mImpl.reset(new Impl{vectors, vectors->getConstAccessor()});
}
Streaks::~Streaks() = default;
Streaks::Streaks(const Streaks& other)
    : mImpl(new Impl{other.mImpl->field, other.mImpl->field->getConstAccessor()}) {}

double Streaks::at(const Vec3d& place) {
    const openvdb::Vec3d start = mImpl->field->worldToIndex(toVec(place));
    Vec3d first;
    if (!mImpl->along(start, first)) return -1;
    double sum = 0;
    int count = 0;
    for (const double way : {1.0, -1.0}) {
        openvdb::Vec3d p = start;
        Vec3d heading = first * way;
        for (int s = 0; s < kSteps; ++s) {
            sum += noise(p);
            ++count;
            p += toVec(heading * kStep);
            Vec3d next;
            if (!mImpl->along(p, next)) break;
            heading = dot(next, heading) < 0 ? -next : next;
        }
    }
    // The mean of many varies little; rescale it to the whole range.
    return std::clamp(0.5 + (sum / count - 0.5) * 1.4 * std::sqrt(count * kStep), 0.0, 1.0);
}

}  // namespace vdbsynth
