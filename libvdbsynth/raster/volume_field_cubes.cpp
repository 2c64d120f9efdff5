// The voxels of a volume's field: cubes, whatever shape the cells of its samples have.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/distance/crossing_field.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/raster/raster_alignment.h"
#include "libvdbsynth/raster/volume_field_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

double interpolated(const BrickField& field, const Vec3d& at) {
    Index3 base;
    double t[3];
    for (int axis = 0; axis < 3; ++axis) {
        base[axis] = int(std::floor(at[axis]));
        t[axis] = at[axis] - base[axis];
    }
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const Index3 d{i >> 2, i >> 1 & 1, i & 1};
        const double weight = (d.x ? t[0] : 1 - t[0]) * (d.y ? t[1] : 1 - t[1]) * (d.z ? t[2] : 1 - t[2]);
        if (weight > 0) sum += weight * double(field.at(base + d));
    }
    return sum;
}

template <typename ValueAt>
BrickField onCubes(const IndexBox& domain, const RunContext& ctx, const ValueAt& valueAt) {
    return crossingField(domain.expanded(kRasterFieldMargin), kRasterFieldLimit, ctx,
                         [&](const Index3& corner, const Index3& size, float* out) {
                             forEachVoxel({corner, corner + size - Index3{1, 1, 1}},
                                          [&](const Index3& p) { *out++ = float(valueAt(p)); });
                         });
}

void describe(RasterField& result, const std::string& what) {
    result.description += (result.description.empty() ? "" : "; ") + what;
}

void requireRoom(const std::string& name, const IndexBox& domain, const RunContext& ctx) {
    requireMemory(ctx, double(domain.volume()) * 8, name + " resampled to cubes",
                  "resample it to larger ones first");
}

void requireSides(const std::string& name, const double (&sides)[3], double longest) {
    for (const double side : sides)
        if (!(side < 1e8))
            throw Error(ErrorCode::Unusable, name + ": its cells are " + roundedText(longest, 6) +
                                                 " times as long as wide; resample it first");
}

// Cells at right angles of other sides, `ratio` samples per voxel along each axis.
void resampleBoxes(const std::string& name, const Raster& raster, const Vec3d& ratio, RasterField& result,
                   const RunContext& ctx) {
    double sides[3];
    for (int axis = 0; axis < 3; ++axis) sides[axis] = raster.size[axis] / ratio[axis];
    requireSides(name, sides, 1 / std::min({ratio.x, ratio.y, ratio.z}));
    for (int axis = 0; axis < 3; ++axis)
        result.domain.max[axis] = std::max(0, int(std::lround((raster.size[axis] - 1) / ratio[axis])));
    requireRoom(name, result.domain, ctx);
    const BrickField field = std::move(result.field);
    result.field = onCubes(result.domain, ctx, [&](const Index3& p) {
        return interpolated(field, {p.x * ratio.x, p.y * ratio.y, p.z * ratio.z});
    });
    describe(result, "its cells are not cubes: resampled to their smallest side");
}

// Sheared cells in a frame at right angles. Where there are no samples is outside: the field there is the
// distance to the block of cells.
class ShearedSamples {
public:
    ShearedSamples(const Raster& raster, const std::array<Vec3d, 3>& frame, const Vec3d& cell)
        : mSize(raster.size) {
        const double smallest = std::min({cell.x, cell.y, cell.z});
        for (int i = 0; i < 3; ++i) {
            const std::size_t n = std::size_t(i);
            const Vec3d step = raster.axes[n] * (cell[i] / smallest);
            mSteps[n] = {dot(frame[0], step), dot(frame[1], step), dot(frame[2], step)};
        }
        const double volume = dot(mSteps[0], cross(mSteps[1], mSteps[2]));
        for (std::size_t i = 0; i < 3; ++i) {
            mInverse[i] = cross(mSteps[(i + 1) % 3], mSteps[(i + 2) % 3]) * (1 / volume);
            mHeights[i] = 1 / length(mInverse[i]);
        }
    }
    /// The box of all samples' centres. @return corners in voxels
    void box(Vec3d& low, Vec3d& high) const {
        low = high = {0, 0, 0};
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const double way = mSteps[std::size_t(i)][axis] * (mSize[i] - 1);
                (way < 0 ? low : high)[axis] += way;
            }
    }
    double valueAt(const BrickField& field, const Vec3d& voxel) const {
        Vec3d at;
        double beyond = -1e30;
        for (int i = 0; i < 3; ++i) {
            const std::size_t n = std::size_t(i);
            at[i] = dot(mInverse[n], voxel);
            beyond = std::max(beyond, std::max(-at[i], at[i] - (mSize[i] - 1)) * mHeights[n] -
                                          0.5 * std::min(1.0, mHeights[n]));
            at[i] = std::clamp(at[i], -1.0, double(mSize[i]));
        }
        const double limit = double(kRasterFieldLimit);
        return std::max(interpolated(field, at), std::clamp(beyond, -limit, limit));
    }

private:
    Index3 mSize;
    std::array<Vec3d, 3> mSteps;    // [voxels] from sample to sample
    std::array<Vec3d, 3> mInverse;  // dot(mInverse[i], voxel) is the place along axis i [samples]
    double mHeights[3] = {};        // [voxels] between layers of samples
};

void resampleSheared(const std::string& name, const Raster& raster, const Vec3d& cell, RasterField& result,
                     const RunContext& ctx) {
    const std::array<Vec3d, 3> frame = nearestFrame(raster.axes);
    const ShearedSamples samples(raster, frame, cell);
    Vec3d low, high;
    samples.box(low, high);
    const double sides[3] = {high.x - low.x + 1, high.y - low.y + 1, high.z - low.z + 1};
    requireSides(name, sides, std::max({cell.x, cell.y, cell.z}) / result.voxelSize);
    for (int axis = 0; axis < 3; ++axis) {
        result.domain.min[axis] = int(std::floor(low[axis]));
        result.domain.max[axis] = int(std::ceil(high[axis]));
    }
    requireRoom(name, result.domain, ctx);
    const BrickField field = std::move(result.field);
    result.field = onCubes(result.domain, ctx, [&](const Index3& p) {
        return samples.valueAt(field, {double(p.x), double(p.y), double(p.z)});
    });
    result.axes = frame;
    describe(result, "its axes are not at right angles: resampled to cubes along the nearest ones that are");
}

}  // namespace

void placeField(const std::string& name, const Raster& raster, const Vec3d& cell, bool inPlace,
                RasterField& result, const RunContext& ctx) {
    const double smallest = std::min({cell.x, cell.y, cell.z});
    result.voxelSize = smallest;
    result.origin = inPlace ? raster.origin : Vec3d{0, 0, 0};
    result.domain = IndexBox::fromSize(raster.size);
    result.axes = raster.axes;
    if (turnOf(raster.axes).shear > 1e-9) {
        resampleSheared(name, raster, cell, result, ctx);
        return;
    }
    const Vec3d ratio{smallest / cell.x, smallest / cell.y, smallest / cell.z};
    if (std::min({ratio.x, ratio.y, ratio.z}) < 1 - 1e-6) resampleBoxes(name, raster, ratio, result, ctx);
}

}  // namespace vdbsynth
