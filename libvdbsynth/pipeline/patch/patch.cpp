#include "libvdbsynth/pipeline/patch/patch.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kBorder = 10;  // [spacings] that a level set's distances at the sides read

double wholeSteps(double side, double step) {
    return std::max(1.0, std::round(side / step)) * step;
}

}  // namespace

PatchSheet makePatchSheet(const PatchSource& source, const PatchOptions& given, const RunContext& ctx) {
    validate(given);
    PatchOptions options = given;
    options.border = kBorder * source.exemplar.spacing;
    if (options.tile) {
        const double step = fieldStep(source.exemplar, options);
        options.width = wholeSteps(given.width, step);
        options.depth = wholeSteps(given.depth, step);
        if (std::abs(options.width - given.width) > 1e-6 * step ||
            std::abs(options.depth - given.depth) > 1e-6 * step)
            message(ctx, MessageLevel::Note,
                    "to tile, the sheet is " + roundedText(options.width, 6) + "," +
                        roundedText(options.depth, 6) + " (world), whole steps of " + roundedText(step, 4));
    }
    PatchSheet sheet;
    sheet.width = options.width;
    sheet.depth = options.depth;
    sheet.border = options.border;
    sheet.result = withThreads(ctx, [&] { return synthesizePatches(source.exemplar, options, ctx); });
    return sheet;
}

}  // namespace vdbsynth
