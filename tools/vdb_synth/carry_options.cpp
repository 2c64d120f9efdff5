#include "tools/vdb_synth/carry_options.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/attribute_transfer.h"

namespace vdbsynth::cli {

void keepNamedAttributes(const Arguments& arguments, std::vector<LevelSet>& exemplars) {
    const std::string text = arguments.text("carry");
    if (text == "all") return;
    for (const std::string& name : splitAtCommas(text)) {
        bool found = false;
        for (const LevelSet& exemplar : exemplars) found = found || hasAttribute(exemplar, name);
        if (!found)
            throw Error(ErrorCode::InvalidOption,
                        "--carry " + name + ": must be all, or names of attributes or grids of the exemplar");
    }
    for (LevelSet& exemplar : exemplars) keepAttributes(exemplar, splitAtCommas(text));
}

AttributeValues attributeValues(const Arguments& arguments) {
    return arguments.has("carry-blend") ? AttributeValues::Blended : AttributeValues::Copied;
}

}  // namespace vdbsynth::cli
