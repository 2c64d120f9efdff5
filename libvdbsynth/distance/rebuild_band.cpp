#include "libvdbsynth/distance/rebuild_band.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/distance/signed_distance.h"
#include "libvdbsynth/distance/zero_level.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vdbsynth {
namespace {

std::vector<IndexBox> partsOf(const IndexBox& box) {
    constexpr int kLongest = 224, kSide = 176;  // [voxels] of a whole that is not parted, of a part
    IndexBox whole;
    Index3 side;
    for (int axis = 0; axis < 3; ++axis) {
        whole.min[axis] = box.min[axis] & ~7;
        const int length = (box.max[axis] | 7) + 1 - whole.min[axis];
        const int parts = length <= kLongest ? 1 : (length + kSide - 1) / kSide;
        side[axis] = ((length + parts - 1) / parts + 7) & ~7;
        whole.max[axis] = whole.min[axis] + length - 1;
    }
    std::vector<IndexBox> parts;
    for (int x = whole.min.x; x <= whole.max.x; x += side.x)
        for (int y = whole.min.y; y <= whole.max.y; y += side.y)
            for (int z = whole.min.z; z <= whole.max.z; z += side.z)
                parts.push_back(
                    IndexBox{{x, y, z}, Index3{x, y, z} + side - Index3{1, 1, 1}}.intersection(whole));
    return parts;
}

// The field's values as distances [voxels] within its band, over a box.
BrickField inVoxels(const BrickField& field, const IndexBox& box, const RebuildOptions& options,
                    const RunContext& ctx) {
    const float scale = 1 / options.voxelSize, limit = options.band;
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = std::clamp(samples[i] * scale, -limit, limit);
    });
}

// Whole cubes of cells around a box, and the cubes around those, which their vertices need.
IndexBox samplesFor(const IndexBox& region) {
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = (region.min[axis] & ~7) - 8;
        box.max[axis] = (region.max[axis] | 7) + 8;
    }
    return box;
}

// The same bits whatever the part: faces that could be nearest to any of its voxels, and what they are found
// through, lie within the reach.
BrickField rebuiltPart(const FieldReader& read, const IndexBox& part, const RebuildOptions& options,
                       const RunContext& ctx) {
    const int rounds = int(std::ceil(options.halfWidth));
    const IndexBox reach = part.expanded(rounds + 3);
    const std::shared_ptr<const BrickField> field = read(samplesFor(reach));
    const Mesh mesh = zeroLevel(*field, reach, options.facing, ctx);
    if (mesh.faceCount() == 0)
        return BrickField(part, field->at(part.min) < 0 ? -options.halfWidth : options.halfWidth);
    const BrickField distance = meshDistance(mesh, part.expanded(rounds + 1), options.halfWidth, ctx);
    const BrickField own = inVoxels(*field, part.expanded(1), options, ctx);
    BrickField values =
        options.keepDistances
            ? keepingDistances({distance, part.min}, {own, part.min}, part.size(), options.band, ctx)
            : withSigns({distance, part.min}, {own, part.min}, part.size(), ctx);
    values.translate(part.min);
    return values;
}

}  // namespace

void rebuildBand(const FieldReader& read, const IndexBox& box, const RebuildOptions& given,
                 const PartTaker& take, const RunContext& ctx) {
    const std::vector<IndexBox> parts = partsOf(box);
    RebuildOptions options = given;
    if (parts.size() > 1) options.facing = Facing::Inward;
    Stage stage(ctx, "rebuilding the narrow band", parts.size());
    constexpr std::size_t kBatch = 8;  // parts between two looks at the clock
    for (std::size_t first = 0; first < parts.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, parts.size() - first);
        std::vector<BrickField> made(count);
        parallelFor(ctx, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                made[i] = rebuiltPart(read, parts[first + i], options, ctx);
        });
        for (const BrickField& part : made) take(part);
        stage.advance(count);
    }
    stage.advance();
}

BrickField rebuiltBand(const BrickField& field, const RebuildOptions& options, const RunContext& ctx) {
    const FieldReader whole = [&field](const IndexBox&) {
        return std::shared_ptr<const BrickField>(std::shared_ptr<void>(), &field);
    };
    std::vector<BrickField> parts;
    rebuildBand(
        whole, field.box().expanded(int(std::ceil(options.halfWidth)) + 1), options,
        [&](const BrickField& part) { parts.push_back(part); }, ctx);
    if (parts.size() == 1) return std::move(parts.front());
    IndexBox box = parts.front().box();
    for (const BrickField& part : parts)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], part.box().min[axis]);
            box.max[axis] = std::max(box.max[axis], part.box().max[axis]);
        }
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        const auto part = std::find_if(parts.begin(), parts.end(),
                                       [&](const BrickField& p) { return p.box().contains(brick.min); });
        part->readBox(brick.min, brick.size(), samples);
    });
}

}  // namespace vdbsynth
