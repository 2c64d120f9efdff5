#include "tools/vdb_synth/batch/job_expansion.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "tools/vdb_synth/batch/job_plan.h"
#include "tools/vdb_synth/option_value.h"

#include <algorithm>
#include <cctype>

#include <glob.h>

namespace vdbsynth::cli::batch {
namespace {

constexpr std::size_t kMostJobs = 100000;

// Letters that file names and shells take as they are.
std::string asName(std::string text) {
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) &&
            std::string("._-+=,@").find(c) == std::string::npos)
            c = '_';
    if (!text.empty() && (text[0] == '.' || text[0] == '-')) text[0] = '_';
    return text;
}

// Of a path its name alone.
std::string shortName(const std::string& value) {
    const bool path = value.find('/') != std::string::npos || isKnownExtension(readExtensionOf(value));
    return asName(path ? filledIn("${path.stem}", {{"path", value}}) : value);
}

// The one list that a text stands for: "${seeds}".
const Json* listNamed(const std::string& text, const std::map<std::string, Json>& variables) {
    if (text.size() < 4 || text.compare(0, 2, "${") != 0 || text.find('}') != text.size() - 1) return nullptr;
    const auto it = variables.find(text.substr(2, text.size() - 3));
    return it != variables.end() && it->second.is_array() ? &it->second : nullptr;
}

class MatrixValues {
public:
    MatrixValues(const std::map<std::string, Json>& variables, const std::string& folder,
                 std::vector<std::string>& patterns)
        : mVariables(variables), mFolder(folder), mPatterns(patterns) {}

    std::vector<std::string> of(const std::string& key, const Json& given) {
        std::vector<std::string> values;
        if (given.is_array()) {
            for (const Json& item : given) add(textOf(item), values);
        } else {
            const std::string text = textOf(given);
            std::vector<int> numbers;
            const Json* list = listNamed(text, mVariables);
            if (list)
                for (const Json& item : *list) add(textOf(item), values);
            else if (const std::string filled = filledIn(text, mVariables); readFrames(filled, numbers))
                for (const int number : numbers) values.push_back(std::to_string(number));
            else
                add(text, values);
        }
        if (values.empty())
            throw Error(ErrorCode::InvalidOption, "\"matrix\": \"" + key + "\": has no values");
        return values;
    }

private:
    void add(const std::string& text, std::vector<std::string>& values) {
        if (const Json* list = listNamed(text, mVariables)) {
            for (const Json& item : *list) add(textOf(item), values);
            return;
        }
        const std::string value = filledIn(text, mVariables);
        if (!isPattern(value)) return values.push_back(value);
        const std::vector<std::string> files = filesOf(value, mFolder);
        if (files.empty())
            throw Error(ErrorCode::InvalidOption, "\"matrix\": " + value + ": matches no file in " + mFolder);
        mPatterns.push_back(value);
        values.insert(values.end(), files.begin(), files.end());
    }

    const std::map<std::string, Json>& mVariables;
    const std::string& mFolder;
    std::vector<std::string>& mPatterns;
};

// The entry's name with the values of one combination.
std::string nameOf(const JobEntry& entry, const Variant& variant) {
    std::map<std::string, Json> values = variant.values;
    for (auto& [key, value] : values)
        if (value.is_string()) value = asName(value.get<std::string>());
    // Parts of paths must be taken before their slashes go.
    std::string name = entry.name.find('.') == std::string::npos
                           ? filledIn(entry.name, values)
                           : asName(filledIn(entry.name, variant.values));
    for (const auto& [key, ignored] : entry.matrix.items())
        if (entry.name.find("${" + key) == std::string::npos)
            name += "-" + shortName(textOf(variant.values.at(key)));
    if (variant.frame >= 0 && entry.name.find("${frame") == std::string::npos) {
        const std::string digits = std::to_string(variant.frame);
        name += "." + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
    }
    return name;
}

void requireFew(std::size_t jobs) {
    if (jobs > kMostJobs)
        throw Error(ErrorCode::InvalidOption,
                    "makes more than 100000 jobs; use a smaller matrix or fewer frames");
}

}  // namespace

bool isPattern(const std::string& path) {
    return path.find_first_of("*?[") != std::string::npos;
}

std::vector<std::string> filesOf(const std::string& pattern, const std::string& folder) {
    const bool absolute = pattern[0] == '/';
    // The folder's own name is no pattern.
    std::string escaped;
    for (const char c : folder + "/")
        escaped +=
            std::string("*?[\\").find(c) == std::string::npos ? std::string(1, c) : std::string("\\") + c;
    glob_t found{};
    std::vector<std::string> files;
    if (::glob(((absolute ? "" : escaped) + pattern).c_str(), 0, nullptr, &found) == 0)
        for (std::size_t i = 0; i < found.gl_pathc; ++i)
            files.push_back(std::string(found.gl_pathv[i]).substr(absolute ? 0 : folder.size() + 1));
    ::globfree(&found);
    std::sort(files.begin(), files.end());  // glob's own order depends on the locale
    return files;
}

std::vector<Variant> variantsOf(const JobEntry& entry, const std::map<std::string, Json>& variables,
                                const std::string& folder, std::vector<std::string>& patterns) {
    std::vector<Variant> variants{{"", variables, -1}};
    MatrixValues matrix(variables, folder, patterns);
    for (const auto& [key, given] : entry.matrix.items()) {
        const std::vector<std::string> values = matrix.of(key, given);
        requireFew(variants.size() * values.size());
        std::vector<Variant> grown;
        for (const Variant& variant : variants)
            for (const std::string& value : values) {
                grown.push_back(variant);
                grown.back().values[key] = value;
            }
        variants = std::move(grown);
    }
    if (!entry.frames.empty()) {
        std::vector<int> frames;
        const std::string text = filledIn(entry.frames, variables);
        if (!readFrames(text, frames))
            throw Error(ErrorCode::InvalidOption,
                        "\"frames\": " + text +
                            ": must be numbers of frames, for example 1-20, 1-20x2 or "
                            "1,4,10-12");
        requireFew(variants.size() * frames.size());
        std::vector<Variant> grown;
        for (const Variant& variant : variants)
            for (const int frame : frames) {
                grown.push_back(variant);
                grown.back().frame = frame;
                grown.back().values["frame"] = std::to_string(frame);
            }
        variants = std::move(grown);
    }
    for (Variant& variant : variants) variant.name = nameOf(entry, variant);
    return variants;
}

}  // namespace vdbsynth::cli::batch
