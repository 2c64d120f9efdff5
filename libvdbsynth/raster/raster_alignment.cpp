#include "libvdbsynth/raster/raster_alignment.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using Axes = std::array<Vec3d, 3>;

double volumeOf(const Axes& a) {
    return dot(a[0], cross(a[1], a[2]));
}

// For each world axis the axis of the lattice closest to it, without repetition.
std::array<std::size_t, 3> nearestOrder(const Axes& directions) {
    std::array<std::size_t, 3> best{0, 1, 2}, order{0, 1, 2};
    double most = -1;
    do {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += std::abs(directions[order[i]][int(i)]);
        // Diagonal directions are nearest to several axes: rounding must not choose.
        if (sum > most + 1e-9) {
            most = sum;
            best = order;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

double largestDifference(const Axes& a, const Axes& b) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, length(a[i] - b[i]));
    return most;
}

Axes cleaned(const Axes& axes) {
    constexpr double kSameAsWorld = 1e-5, kRightAngled = 1e-4;
    if (largestDifference(axes, kWorldAxes) < kSameAsWorld) return kWorldAxes;
    const Axes frame = nearestFrame(axes);
    return largestDifference(axes, frame) < kRightAngled ? frame : axes;
}

void reorder(const Raster& stored, const std::array<std::size_t, 3>& order, const bool (&reversed)[3],
             Raster& raster) {
    const std::size_t channels = std::size_t(stored.channels);
    auto out = raster.values.begin();
    Index3 from;
    for (int z = 0; z < raster.size.z; ++z)
        for (int y = 0; y < raster.size.y; ++y)
            for (int x = 0; x < raster.size.x; ++x) {
                const Index3 to{x, y, z};
                for (int axis = 0; axis < 3; ++axis)
                    from[int(order[std::size_t(axis)])] =
                        reversed[axis] ? raster.size[axis] - 1 - to[axis] : to[axis];
                out = std::copy_n(
                    stored.values.begin() + std::ptrdiff_t(stored.index(from.x, from.y, from.z) * channels),
                    channels, out);
            }
}

}  // namespace

bool runAlongWorld(const std::array<Vec3d, 3>& axes) {
    return !(largestDifference(axes, kWorldAxes) > 0);
}

AxesTurn turnOf(const std::array<Vec3d, 3>& axes) {
    AxesTurn turn;
    for (std::size_t i = 0; i < 3; ++i)
        turn.shear = std::max(turn.shear, std::abs(dot(axes[i], axes[(i + 1) % 3])));
    Axes frame = nearestFrame(axes);
    if (volumeOf(frame) < 0)
        for (Vec3d& axis : frame) axis = -axis;
    // The trace is 1 + 2 cos, the antisymmetric part holds 2 sin.
    const double twiceCosine = frame[0].x + frame[1].y + frame[2].z - 1;
    const double twiceSine =
        length(Vec3d{frame[1].z - frame[2].y, frame[2].x - frame[0].z, frame[0].y - frame[1].x});
    turn.degrees = arcTangent(twiceSine, twiceCosine) * 180 / kPi;
    return turn;
}

Raster alignedToWorld(const std::string& name, Raster stored, const Affine& toWorld, const RunContext& ctx) {
    const Vec3d origin = transformed(toWorld, {0, 0, 0});
    Axes directions;
    double lengths[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d step{toWorld[4 * i], toWorld[4 * i + 1], toWorld[4 * i + 2]};
        lengths[i] = length(step);
        directions[i] = normalized(step);
    }
    const double volume = std::abs(volumeOf(directions));
    if (!(volume > 1e-3) || !std::isfinite(origin.x + origin.y + origin.z))
        throw Error(ErrorCode::BadData,
                    name + ": the transform that places it is singular or holds no usable numbers");
    const std::array<std::size_t, 3> order = nearestOrder(directions);
    bool reversed[3];
    Axes axes;
    Index3 size;
    Vec3d first = origin;
    for (std::size_t i = 0; i < 3; ++i) {
        size[int(i)] = stored.size[int(order[i])];
        stored.spacing[int(i)] = lengths[order[i]];
        reversed[i] = directions[order[i]][int(i)] < 0;
        axes[i] = reversed[i] ? -directions[order[i]] : directions[order[i]];
        if (reversed[i]) first = first - axes[i] * (lengths[order[i]] * (size[int(i)] - 1));
    }
    stored.origin = first;
    stored.axes = cleaned(axes);
    stored.knownSpacing = true;
    if (order == std::array<std::size_t, 3>{0, 1, 2} && !reversed[0] && !reversed[1] && !reversed[2])
        return stored;
    requireMemory(ctx, double(stored.values.size()) * 8, name, "crop or shrink it first");
    Raster raster = stored;
    raster.size = size;
    reorder(stored, order, reversed, raster);
    return raster;
}

}  // namespace vdbsynth
