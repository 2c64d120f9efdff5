#include "tools/vdb_synth/carry_options.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/pipeline/carry.h"

namespace vdbsynth::cli {

std::vector<Option> carryOptions() {
    return {{"carry", "NAMES",
             "which attributes and grids of the exemplar come along: all (default), or names with commas"},
            {"carry-blend", "",
             "numbers and vectors that come along are means over all that had a say, not copies"}};
}

void keepCarried(const Arguments& arguments, std::vector<LevelSet>& exemplars) {
    const std::string text = arguments.text("carry", "all");
    if (text == "all") return;
    for (const std::string& name : splitAtCommas(text)) {
        bool found = false;
        for (const LevelSet& exemplar : exemplars) found = found || carries(exemplar, name);
        requireOption(found, "carry", name, "all, or names of what comes with the exemplar");
    }
    for (LevelSet& exemplar : exemplars) keepCarriedNames(exemplar, splitAtCommas(text));
}

CarriedValues carriedValues(const Arguments& arguments) {
    return arguments.has("carry-blend") ? CarriedValues::Blended : CarriedValues::Copied;
}

}  // namespace vdbsynth::cli
