// ${NAME} in the texts of a job file.
#include "tools/vdb_synth/batch/job_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli::batch {
namespace {

std::string stemOf(const std::string& path) {
    std::string name = fileNameOf(path);
    if (name.size() > 3 && name.compare(name.size() - 3, 3, ".gz") == 0) name.resize(name.size() - 3);
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

std::string valueOf(const std::string& reference, const std::map<std::string, Json>& values) {
    const std::size_t dot = reference.find('.');
    const std::string name = reference.substr(0, dot),
                      part = dot == std::string::npos ? "" : reference.substr(dot + 1);
    const auto value = values.find(name);
    if (value == values.end()) {
        std::vector<std::string> names;
        for (const auto& entry : values) names.push_back(entry.first);
        const std::string near = nearestName(name, names);
        throw Error(ErrorCode::InvalidOption,
                    "${" + reference + "}: unknown variable" +
                        (near.empty() ? "; name it under \"variables\" or \"matrix\"; $${ stands for ${"
                                      : "; did you mean ${" + near + "}?"));
    }
    if (value->second.is_array())
        throw Error(ErrorCode::InvalidOption,
                    "${" + reference + "}: is a list; write it under \"matrix\" to run once for each");
    const std::string text = textOf(value->second);
    if (part.empty()) return text;
    if (part == "stem") return stemOf(text);
    if (part == "file") return fileNameOf(text);
    if (part == "folder") return folderOf(text);
    throw Error(ErrorCode::InvalidOption,
                "${" + reference + "}: must end in .stem, .file or .folder, the parts of a path");
}

}  // namespace

std::string filledIn(const std::string& text, const std::map<std::string, Json>& values) {
    // It would end the text where the system reads it.
    if (text.find('\0') != std::string::npos)
        throw Error(
            ErrorCode::InvalidOption,
            std::string(text.c_str()) + ": holds a zero byte (\\u0000), which no path or value can have");
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        if (text.compare(at, 3, "$${") == 0) {
            result += "${";
            at += 3;
        } else if (text.compare(at, 2, "${") == 0) {
            const std::size_t end = text.find('}', at);
            if (end == std::string::npos)
                throw Error(ErrorCode::InvalidOption, text + ": ${ has no }; $${ stands for ${");
            result += valueOf(text.substr(at + 2, end - at - 2), values);
            at = end + 1;
        } else {
            result += text[at++];
        }
    }
    return result;
}

}  // namespace vdbsynth::cli::batch
