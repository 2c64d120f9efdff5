// What images and volumes lose on the way to a level set.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/pipeline/convert/model_steps.h"
#include "libvdbsynth/vdb/convert/zero_level.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth {

void sayLostHeights(const std::string& path, const Raster& raster, const RasterField& field,
                    const RunContext& ctx) {
    if (field.lostShare < 0.001) return;
    const std::string text =
        path + ": " + roundedText(100 * field.lostShare, 2) +
        " % of its pixels lie farther than a voxel from the surface, as their details are smaller; "
        "`resolution` " +
        std::to_string(std::max(raster.size.x, raster.size.y)) + " keeps them";
    if (field.lostShare > 0.5) throw Error(ErrorCode::Unusable, text);
    message(ctx, MessageLevel::Warning, text);
}

void sayLostSamples(const std::string& path, const RasterField& field, const openvdb::FloatGrid& grid,
                    const RunContext& ctx) {
    constexpr double kSaid = 0.01, kWarned = 0.05;
    if (!(field.solidVolume > 0)) return;
    const double volume = summarize(zeroLevelInIndexSpace(grid, 0, ctx)).signedVolume;
    const double change = volume / field.solidVolume - 1;
    if (std::abs(change) < kSaid) return;
    message(ctx, std::abs(change) < kWarned ? MessageLevel::Note : MessageLevel::Warning,
            path + ": " + std::to_string(std::min(99L, std::lround(100 * std::abs(change)))) +
                " % of the volume of its solid samples is " + (change < 0 ? "lost" : "added") +
                " by smoothing, as its " + (change < 0 ? "parts" : "voids") + " are few samples thick; " +
                field.keepsMore + "samples of half the size would keep more");
}

}  // namespace vdbsynth
