// No output may be a file that is still to be read: a mistyped command line would destroy the input.
#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/option_set.h"
#include "tools/vdb_synth/options.h"

#include <string>
#include <vector>

#include <sys/stat.h>

namespace vdbsynth::cli {
namespace {

struct NamedPath {
    std::string option, path;  ///< option: empty for a plain input
};

struct Paths {
    std::vector<NamedPath> read, written;
};

Paths pathsOf(const Arguments& arguments, bool inputsAreOutputs) {
    Paths paths;
    for (const std::string& input : arguments.inputs)
        (inputsAreOutputs ? paths.written : paths.read).push_back({"", input});
    for (const Option& option : optionsOf(arguments.command()))
        for (const std::string& value : arguments.all(option.name)) {
            const std::string path = pathIn(option, value);
            if (path.empty() || path == kNoValue) continue;
            (readsPath(option) ? paths.read : paths.written).push_back({option.name, path});
        }
    return paths;
}

// "-" and "-.obj" are standard streams, even if the folder has files of these names.
bool isStream(const std::string& path) {
    return path == "-" || path.compare(0, 2, "-.") == 0;
}

bool sameFile(const std::string& a, const std::string& b) {
    struct stat first {
    }, second{};
    return !isStream(a) && !isStream(b) && ::stat(a.c_str(), &first) == 0 &&
           ::stat(b.c_str(), &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino && S_ISREG(first.st_mode);
}

std::string named(const NamedPath& path) {
    return path.option.empty() ? path.path : "--" + path.option + " " + path.path;
}

}  // namespace

void refuseOverwriting(const Arguments& arguments, bool inputsAreOutputs) {
    if (arguments.has("force")) return;
    const Paths paths = pathsOf(arguments, inputsAreOutputs);
    for (const NamedPath& written : paths.written)
        for (const NamedPath& read : paths.read)
            if (sameFile(written.path, read.path))
                throw Error(ErrorCode::InvalidOption, named(written) + ": is the file of the input " +
                                                          named(read) +
                                                          "; give another name, or --force to replace it");
}

}  // namespace vdbsynth::cli
