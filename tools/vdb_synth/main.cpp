#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/version.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/whole_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <new>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vdbsynth::cli {
namespace {

// The only registry of commands.
const std::vector<const Command*>& commands() {
    static const std::vector<const Command*> all{&kConvert, &kInfo,   &kCrop,    &kMask,   &kMatch, &kSynth,
                                                 &kAnalogy, &kRepeat, &kCompare, &kRender, &kMake};
    return all;
}

std::string overview() {
    std::string text =
        "vdb_synth makes new geometry from examples.\n\nUsage: vdb_synth COMMAND INPUTS -o OUTPUT "
        "[options]\n\n";
    for (const Command* command : commands()) {
        std::string name = command->name;
        name.resize(10, ' ');
        text += "  " + name + command->summary + "\n";
    }
    return text +
           "\nvdb_synth COMMAND --help tells more. Exit codes: 0 done, 1 unusable input, 2 bad option, 3 bad "
           "file, 130 and 143 stopped.\n";
}

int fail(const Error& error, const std::string& command) {
    std::string text = error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    std::fprintf(stderr, "vdb_synth%s%s: error: %s\n", command.empty() ? "" : " ", command.c_str(),
                 text.c_str());
    if (error.code() == ErrorCode::Cancelled && stopSignal()) return 128 + stopSignal();
    return exitCode(error.code());
}

// Values of --config that the command line does not give.
void mergeConfig(const Command& command, Arguments& arguments) {
    const std::string path = arguments.text("config");
    if (path.empty()) return;
    nlohmann::json json = nlohmann::json::parse(readWholeFile(path), nullptr, /* allow_exceptions= */ false);
    if (json.is_object() && json.contains("options")) json = json["options"];
    if (!json.is_object())
        throw Error(ErrorCode::BadData,
                    path + ": not a JSON object of options, such as the \"options\" of a --report");
    std::vector<Option> options = commonOptions();
    options.insert(options.end(), command.options.begin(), command.options.end());
    for (const auto& [name, value] : json.items()) {
        std::vector<std::string> values;
        const auto add = [&values](const nlohmann::json& item) {
            values.push_back(item.is_string() ? item.get<std::string>() : item.dump());
        };
        if (value.is_array())
            for (const auto& item : value) add(item);
        else
            add(value);
        if (name == "inputs") {
            if (arguments.inputs.empty()) arguments.inputs = values;
            continue;
        }
        const auto option = std::find_if(options.begin(), options.end(),
                                         [&, key = name](const Option& o) { return o.name == key; });
        if (option == options.end() || name == "help" || name == "version" || name == "config")
            throw Error(ErrorCode::InvalidOption,
                        path + ": \"" + name + "\" is not an option of " + command.name);
        if (values.size() > 1 && !option->repeats)
            throw Error(ErrorCode::InvalidOption, path + ": \"" + name + "\" has several values");
        if (arguments.has(name) || values.empty() || value.is_null()) continue;
        if (option->argument.empty()) {
            if (values[0] == "false") continue;
            requireOption(values[0] == "true", name, values[0], "true or false in " + path);
        }
        arguments.values[name] = values;
    }
}

// Past this the system refuses memory, which becomes an error, instead of ending the process later.
void limitMemory(std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const rlimit limit{rlim_t(bytes + 512000000), rlim_t(bytes + 512000000)};
    ::setrlimit(RLIMIT_DATA, &limit);
#else
    (void)bytes;
#endif
}

// True if all that was printed arrived. More than a buffer is written, and fails, before the flush.
bool arrived() {
    return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

int printed() {
    if (arrived()) return 0;
    return fail(Error(ErrorCode::Io, "standard output cannot be written"), "");
}

int execute(const Command& command, const Arguments& arguments, const SupervisorLine& line) {
    try {
        Run run(command, arguments, line);
        limitMemory(run.context.maxMemory);
        try {
            command.run(run);
        } catch (const Error& error) {
            // Errors speak of outputs, not of their temporary names.
            throw Error(error.code(), run.withoutTemporaries(error.what()));
        }
        if (!arrived()) throw Error(ErrorCode::Io, "standard output cannot be written");
        return 0;
    } catch (const Error& error) {
        return fail(error, command.name);
    } catch (const std::bad_alloc&) {
        return fail(Error(ErrorCode::Memory,
                          "out of memory; use larger voxels, a smaller size or a larger --max-memory"),
                    command.name);
    } catch (const std::exception& error) {
        return fail(Error(ErrorCode::Solver, std::string("internal error: ") + error.what()), command.name);
    }
}

int dispatch(char** argv, const std::string& name, const std::vector<std::string>& words) {
    if (name.empty()) {
        std::fprintf(stderr, "%s", overview().c_str());
        return 2;
    }
    if (name == "--help" || name == "-help" || name == "-h" || name == "help") {
        std::printf("%s", overview().c_str());
        return printed();
    }
    if (name == "--version" || name == "-version") {
        std::printf("vdb_synth %s (OpenVDB %s)\n", kVersion, kOpenVdbVersion);
        return printed();
    }
    const Command* command = nullptr;
    std::vector<std::string> names;
    for (const Command* known : commands()) {
        names.push_back(known->name);
        if (known->name == name) command = known;
    }
    if (!command) {
        const std::string near = nearestName(name, names);
        return fail(Error(ErrorCode::InvalidOption,
                          name + ": unknown command" +
                              (near.empty() ? "; see vdb_synth --help" : "; did you mean " + near + "?")),
                    "");
    }
    Arguments arguments;
    try {
        std::vector<Option> options = command->options;
        options.insert(options.end(), commonOptions().begin(), commonOptions().end());
        arguments = parseArguments(options, words);
        if (arguments.has("help")) {
            std::printf("%s", helpText(*command).c_str());
            return printed();
        }
        if (arguments.has("version")) {
            std::printf("vdb_synth %s (OpenVDB %s)\n", kVersion, kOpenVdbVersion);
            return printed();
        }
        mergeConfig(*command, arguments);
    } catch (const Error& error) {
        return fail(error, command->name);
    } catch (const std::exception& error) {
        return fail(Error(ErrorCode::InvalidOption, error.what()), command->name);
    }
    const auto work = [&](const SupervisorLine& line) { return execute(*command, arguments, line); };
    if (arguments.has("no-supervisor")) {
        installStopHandlers();
        return work(SupervisorLine());
    }
    return supervise(argv, work);
}

}  // namespace

const std::vector<Option>& commonOptions() {
    static const std::vector<Option> options{
        {"output", "FILE", "where the result goes, kind by extension; may be given several times", true, 'o'},
        {"voxel-size", "W", "side of a voxel (world); a VDB is resampled"},
        {"resolution", "N", "voxels along the longest side, default 128 for meshes and points"},
        {"half-width", "V", "half-width of the narrow band (voxels), default 3"},
        {"open", "KIND", "of what is no solid: close it (default), or a shell about its faces or points"},
        {"thickness", "W", "of that shell (world)"},
        {"grid", "NAME", "which grid of a VDB file"},
        {"iso", "VALUE", "a fog volume is solid above this value"},
        {"pixel-size", "P", "side of an image's pixel, or of a volume's smallest cell (world)"},
        {"height", "H", "of an image from black to white, or from its lowest to its highest value (world)"},
        {"base", "B", "solid under an image's lowest place (world), default a 20th of its longer side"},
        {"plane", "PLANE", "where an image lies: xy (default), yz or zx; heights go along the third axis"},
        {"threshold", "VALUE", "a volume (npy, tif, vti, nii ...) is solid above this value"},
        {"labels", "LIST", "a volume is solid where it has one of these values, for example 1,4,10-20"},
        {"threads", "N", "number of threads, default one per core; results do not depend on it"},
        {"seed", "N", "seed of everything random, default 0"},
        {"max-memory", "BYTES", "most memory to use, for example 4G; default 80 % of the machine's"},
        {"progress", "STYLE", "auto, bar, json or off; on standard error"},
        {"report", "FILE.json", "options, times and peak memory by stage, counts"},
        {"config", "FILE.json", "options from a file or an earlier report; the command line wins"},
        {"no-supervisor", "", "work in this process, for debuggers"},
        {"quiet", "", "errors and warnings only", false, 'q'},
        {"verbose", "", "say what is done", false, 'v'},
        {"help", "", "this text", false, 'h'},
        {"version", "", "versions of vdb_synth and OpenVDB"},
    };
    return options;
}

std::string helpText(const Command& command) {
    std::string text = command.summary + "\n\nUsage: vdb_synth " + command.usage + "\n\n";
    const auto list = [&text](const std::vector<Option>& options) {
        for (const Option& option : options) {
            std::string left = "  " +
                               (option.letter ? std::string("-") + option.letter + ", " : std::string()) +
                               "--" + option.name + (option.argument.empty() ? "" : " " + option.argument);
            if (left.size() < 30)
                left.resize(30, ' ');
            else
                left += "\n" + std::string(30, ' ');
            text += left + option.help + "\n";
        }
    };
    if (!command.options.empty()) {
        text += "Options:\n";
        list(command.options);
        text += "\n";
    }
    text += "Common options:\n";
    list(commonOptions());
    return text + "\nExample:\n  " + command.example + "\n";
}

}  // namespace vdbsynth::cli

int main(int argc, char** argv) {
    using namespace vdbsynth;
    // With a standard stream closed, the next file opened would take its place.
    for (int file = ::open("/dev/null", O_RDWR); file >= 0 && file <= 2;) file = ::open("/dev/null", O_RDWR);
    const std::vector<std::string> words(argv + std::min(argc, 2), argv + argc);
    const std::string first = argc > 1 ? argv[1] : "";
    return cli::dispatch(argv, first, words);
}
