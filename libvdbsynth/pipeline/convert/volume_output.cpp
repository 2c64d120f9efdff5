#include "libvdbsynth/pipeline/convert/volume_output.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/pipeline/convert/model_unit.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

const char* nameOf(VolumeValues values) {
    return values == VolumeValues::Inside     ? "inside"
           : values == VolumeValues::Distance ? "distance"
                                              : "density";
}

const char* meaningOf(VolumeValues values) {
    return values == VolumeValues::Inside     ? "uint8, 1 in the solid"
           : values == VolumeValues::Distance ? "float32, negative inside"
                                              : "float32, 0.5 at the surface, 1 in the solid";
}

std::string placeText(const VolumeHead& head) {
    return roundedText(head.toWorld[12], 9) + ", " + roundedText(head.toWorld[13], 9) + ", " +
           roundedText(head.toWorld[14], 9);
}

void say(const LevelSet& model, const std::string& path, VolumeFormat format, const VolumeHead& head,
         VolumeValues values, double solid, const RunContext& ctx) {
    const std::string unit = head.unit.empty() ? "" : ", in " + head.unit;
    const bool npy = format == VolumeFormat::Npy;
    message(ctx, npy ? MessageLevel::Note : MessageLevel::Detail,
            path + ": " + (npy ? "[z][y][x] of " : "") + std::to_string(head.size[npy ? 2 : 0]) + " x " +
                std::to_string(head.size.y) + " x " + std::to_string(head.size[npy ? 0 : 2]) + " samples, `" +
                head.name + "` (" + meaningOf(values) + "); its first voxel lies at " + placeText(head) +
                ", voxels of " + roundedText(cellOf(head), 9) + " (world" + unit + ")");
    // What .npy has no place for was just said, except for a rotation.
    VolumeHead rest = head;
    if (npy) {
        rest.unit.clear();
        for (std::size_t i = 0; i < 3; ++i) {
            rest.toWorld[12 + i] = 0;
            for (std::size_t j = 0; j < 3; ++j) rest.toWorld[4 * i + j] /= cellOf(head);
        }
    }
    const std::string lost = lostInVolume(format, rest);
    if (!lost.empty())
        message(ctx, MessageLevel::Note,
                path + ": has " + lost + "; its first voxel lies at " + placeText(head) + ", voxels of " +
                    roundedText(cellOf(head), 9) + " (world" + unit + ")");
    const double outside = solidVoxels(*model.grid) - solid;
    if (outside > 0)
        message(ctx, MessageLevel::Note,
                path + ": " + countText(std::size_t(outside), "solid voxel") +
                    " outside the model's domain left out");
}

}  // namespace

IndexBox volumeBox(const LevelSet& model) {
    if (model.domainRecorded) return model.domain;
    return solidBox(*model.grid, "the model").expanded(int(std::ceil(halfWidthOf(*model.grid))));
}

VolumeHead volumeHeadOf(const LevelSet& model, VolumeValues values) {
    const IndexBox box = volumeBox(model);
    VolumeHead head;
    head.name = nameOf(values);
    head.size = box.size();
    head.bytes = values == VolumeValues::Inside;
    head.toWorld = transformOf(*model.grid);
    const Vec3d first = transformed(head.toWorld, {double(box.min.x), double(box.min.y), double(box.min.z)});
    for (int axis = 0; axis < 3; ++axis) head.toWorld[std::size_t(12 + axis)] = first[axis];
    if (values == VolumeValues::Distance) {
        head.high = std::abs(double(model.grid->background()));
        head.low = -head.high;
    }
    head.unit = unitOf(*model.grid);
    return head;
}

void writeModelVolume(const LevelSet& model, const std::string& path, const std::string& temporary,
                      VolumeValues values, const RunContext& ctx) {
    VolumeFormat format{};
    if (!volumeFormatOf(path, format))
        throw Error(ErrorCode::InvalidOption, path + ": unknown extension; volumes are " + kVolumeOutputs);
    const IndexBox box = volumeBox(model);
    const VolumeHead head = volumeHeadOf(model, values);
    const float limit = std::abs(model.grid->background());
    const float ramp = float(0.5 / cellOf(head));
    double solid = 0;
    std::vector<float> slab;
    const auto fill = [&](int first, int count, char* out) {
        const std::size_t samples = std::size_t(head.size.x) * std::size_t(head.size.y) * std::size_t(count);
        slab.resize(samples);
        openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(
            {{box.min.x, box.min.y, box.min.z + first},
             {box.max.x, box.max.y, box.min.z + first + count - 1}},
            slab.data());
        openvdb::tools::copyToDense(*model.grid, dense);
        for (const float value : slab) solid += value < 0;
        if (values == VolumeValues::Inside) {
            for (std::size_t i = 0; i < samples; ++i) out[i] = char(slab[i] < 0);
            return;
        }
        for (float& value : slab)
            value = values == VolumeValues::Distance ? std::clamp(value, -limit, limit)
                                                     : std::clamp(0.5f - ramp * value, 0.f, 1.f);
        std::copy_n(reinterpret_cast<const char*>(slab.data()), samples * sizeof(float), out);
    };
    writeVolume(temporary, path, format, head, fill, ctx);
    say(model, path, format, head, values, solid, ctx);
}

}  // namespace vdbsynth
