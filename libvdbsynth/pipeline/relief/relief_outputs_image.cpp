// The relief of a flat model as an image.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/pipeline/relief/relief_outputs.h"
#include "libvdbsynth/relief/relief_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr float kFlat = 0.5f;  // cosine of the steepest that a flat base may be

// The axis, and the direction along it, that the base faces.
struct Facing3 {
    int axis = 0;
    float direction = 1;
    double flat = 0;  // share of the vertices within kFlat
};

Facing3 facingOf(const BrickField& distance, const Mesh& mesh) {
    std::array<std::size_t, 6> count{};
    for (const Vec3f& p : mesh.points) {
        const Vec3f normal = normalized(sampleGradient(distance, p));
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(normal[axis]) > kFlat) ++count[std::size_t(2 * axis + (normal[axis] > 0))];
    }
    const auto best = std::max_element(count.begin(), count.end());
    const int side = int(best - count.begin());
    return {side / 2, side % 2 ? 1.f : -1.f,
            double(*best) / double(std::max<std::size_t>(1, mesh.points.size()))};
}

// Where a column of voxels meets the base; negative where it does not.
float baseInColumn(const BrickField& distance, Index3 at, int axis, float direction, int low, int high) {
    at[axis] = low;
    float before = distance.at(at);
    for (int i = low + 1; i <= high; ++i) {
        at[axis] = i;
        const float value = distance.at(at);
        if ((before < 0) != (value < 0) && (value > before) == (direction > 0))
            return float(i - 1) + before / (before - value);
        before = value;
    }
    return -1;
}

}  // namespace

ReliefImage reliefImage(const ReliefExtraction& extraction, const RunContext& ctx) {
    const BaseSurface& fields = extraction.fields;
    const IndexBox& box = extraction.domain;
    const Facing3 facing = facingOf(fields.distance, zeroLevel(fields.distance, box, Facing::Outward, ctx));
    if (facing.flat < 0.999)
        throw Error(ErrorCode::Unusable,
                    "no height image: the base is not flat, as only " + roundedText(100 * facing.flat, 3) +
                        " % of it faces one axis within 60 degrees; crop the model to a flat part, or write "
                        ".vdb or .ply");
    const int axis = facing.axis, across = (axis + 1) % 3, up = (axis + 2) % 3;
    const Index3 size = box.size();
    ReliefImage image;
    image.columns = size[across];
    image.rows = size[up];
    image.heights.assign(std::size_t(image.columns) * std::size_t(image.rows),
                         std::numeric_limits<float>::quiet_NaN());
    parallelFor(ctx, std::size_t(image.rows), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (int column = 0; column < image.columns; ++column) {
                Index3 at;
                at[across] = box.min[across] + column;
                at[up] = box.max[up] - int(row);
                const float place =
                    baseInColumn(fields.distance, at, axis, facing.direction, box.min[axis], box.max[axis]);
                if (place < 0) continue;
                Vec3f foot{float(at.x), float(at.y), float(at.z)};
                foot[axis] = place;
                const Vec3f normal = normalized(sampleGradient(fields.distance, foot));
                image.heights[row * std::size_t(image.columns) + std::size_t(column)] =
                    reliefAt(fields, foot, normal).height * float(extraction.voxelSize);
            }
    });
    return image;
}

}  // namespace vdbsynth
