#include "tools/vdb_synth/carry_options.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/pipeline/carry.h"

namespace vdbsynth::cli {

void keepCarried(const Arguments& arguments, std::vector<LevelSet>& exemplars) {
    const std::string text = arguments.text("carry");
    if (text == "all") return;
    for (const std::string& name : splitAtCommas(text)) {
        bool found = false;
        for (const LevelSet& exemplar : exemplars) found = found || carries(exemplar, name);
        if (!found)
            throw Error(ErrorCode::InvalidOption,
                        "--carry " + name + ": must be all, or names of what comes with the exemplar");
    }
    for (LevelSet& exemplar : exemplars) keepCarriedNames(exemplar, splitAtCommas(text));
}

CarriedValues carriedValues(const Arguments& arguments) {
    return arguments.has("carry-blend") ? CarriedValues::Blended : CarriedValues::Copied;
}

}  // namespace vdbsynth::cli
