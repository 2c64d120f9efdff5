#include "python/vdbsynth/model_arrays.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/model_steps.h"
#include "libvdbsynth/raster/volume_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vdbsynth::python {
namespace {

constexpr const char* kName = "the array";

std::size_t offsetIn(const ArrayView& view, const Index3& p) {
    return (std::size_t(p.x) * std::size_t(view.size.y) + std::size_t(p.y)) * std::size_t(view.size.z) +
           std::size_t(p.z);
}

float nearestValue(const ArrayView& view, Index3 p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::clamp(p[axis], 0, view.size[axis] - 1);
    return view.values[offsetIn(view, p)];
}

void requireFinite(const ArrayView& view) {
    const std::size_t count = std::size_t(view.size.x) * std::size_t(view.size.y) * std::size_t(view.size.z);
    if (!std::all_of(view.values, view.values + count, [](float v) { return std::isfinite(v); }))
        throw Error(ErrorCode::BadData, std::string(kName) + ": holds NaN or infinite values");
}

void move(LevelSet& model, const Vec3d& by) {
    if (by.x != 0 || by.y != 0 || by.z != 0) translate(*model.grid, by);
}

}  // namespace

LevelSet textureOfArray(const ArrayView& distances, const ArrayPlace& place, double halfWidth,
                        const RunContext& ctx) {
    requirePlace(place);
    requireHalfWidth(halfWidth);
    requireFinite(distances);
    const auto [first, moved] = cornerOf(place);
    const Index3 corner = first;
    const IndexBox domain{corner, corner + distances.size - Index3{1, 1, 1}};
    const float scale = float(1 / place.voxelSize);
    const BrickField field =
        BrickField::fromVoxels(domain.expanded(kRasterFieldMargin), ctx, [&](const Index3& p) {
            return std::clamp(nearestValue(distances, p - corner) * scale, -kRasterFieldLimit,
                              kRasterFieldLimit);
        });
    LevelSet model = modelFromField(field, kRasterFieldLimit, /* exact= */ false, 0, domain, place.voxelSize,
                                    kName, "no part of it is negative", ctx);
    move(model, moved);
    return withHalfWidth(model, halfWidth, ctx);
}

LevelSet solidOfVolume(const ArrayView& values, const ArrayPlace& place, const VolumeOptions& options,
                       double halfWidth, const RunContext& ctx) {
    requirePlace(place);
    requireHalfWidth(halfWidth);
    Raster raster;
    raster.size = values.size;
    raster.stack = raster.knownSpacing = true;
    raster.spacing = {place.voxelSize, place.voxelSize, place.voxelSize};
    raster.origin = place.origin;
    raster.values.resize(raster.sampleCount());
    for (int x = 0; x < values.size.x; ++x)
        for (int y = 0; y < values.size.y; ++y)
            for (int z = 0; z < values.size.z; ++z)
                raster.values[raster.index(x, y, z)] = values.values[offsetIn(values, {x, y, z})];
    const RasterField field = volumeField(kName, raster, options, ctx);
    if (!field.description.empty()) message(ctx, MessageLevel::Note, kName + (": " + field.description));
    LevelSet model = modelFromField(field.field, kRasterFieldLimit, /* exact= */ false, field.distanceBand,
                                    field.domain, field.voxelSize, kName, "no part of it is solid", ctx);
    sayLostSamples(kName, field, *model.grid, ctx);
    move(model, field.origin);
    return withHalfWidth(model, halfWidth, ctx);
}

IndexBox boxOf(const LevelSet& model) {
    const IndexBox band = activeBoxOfModel(*model.grid), domain = model.domain;
    if (domain.empty()) return band;
    if (band.empty()) return domain;
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::min(band.min[axis], domain.min[axis]);
        box.max[axis] = std::max(band.max[axis], domain.max[axis]);
    }
    return box;
}

LevelSet withDomain(const LevelSet& model, const IndexBox& domain, bool recorded) {
    requireBox(domain, "domain");
    LevelSet result = model;
    result.grid = sharedCopy(*model.grid);
    result.domain = domain;
    result.domainRecorded = recorded;
    stampLevelSet(result);
    return result;
}

}  // namespace vdbsynth::python
