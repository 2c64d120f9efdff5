#include "libvdbsynth/vdb/read/metadata_format.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"

namespace vdbsynth {

std::string unknownMetadata(const std::vector<std::pair<std::string, std::string>>& metadata) {
    std::string format, version;
    for (const auto& [name, value] : metadata) {
        if (name == kMetadataFormatKey) format = value;
        if (name == "vdbsynth:version") version = value;
    }
    int number = 0;
    if (format.empty() || (parseWhole(format, number) && number >= 1 && number <= kMetadataFormat)) return "";
    return "its metadata are of format " + printableText(format, 20) +
           (version.empty() ? "" : ", written by vdb_synth " + printableText(version, 20)) +
           "; this version knows format " + std::to_string(kMetadataFormat) +
           ", so its domain and other entries may be misread: update vdb_synth";
}

}  // namespace vdbsynth
