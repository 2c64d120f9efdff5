#include "tools/vdb_synth/batch/job_text.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <set>
#include <vector>

namespace vdbsynth::cli::batch {
namespace {

constexpr int kDeepest = 64;

// "at line 3, column 7: ..." of "[json.exception.parse_error.101] parse error at line 3, column 7: ...".
std::string reasonOf(const std::string& what) {
    const std::size_t at = what.find(" at line ");
    return at == std::string::npos ? what : what.substr(at + 1);
}

}  // namespace

Json parseJobText(const std::string& path, const std::string& text, bool yaml) {
    if (yaml) return parseYaml(path, text);
    // The parser would keep the last of two equal keys and say nothing.
    std::vector<std::set<std::string>> keys;
    const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
        if (depth > kDeepest) throw Error(ErrorCode::BadData, path + ": is nested too deeply for a job file");
        if (event == Json::parse_event_t::object_start) keys.emplace_back();
        if (event == Json::parse_event_t::object_end) keys.pop_back();
        if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
            throw Error(ErrorCode::BadData, path + ": \"" + value.get<std::string>() +
                                                "\" stands twice in one object; keep one of them");
        return true;
    };
    try {
        return Json::parse(text, watch);
    } catch (const Json::exception& error) {
        throw Error(ErrorCode::BadData, path + ": no valid JSON: " + reasonOf(error.what()));
    }
}

Json readJobText(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    return parseJobText(path, readWholeFile(path), extension == "yaml" || extension == "yml");
}

}  // namespace vdbsynth::cli::batch
