#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "tools/vdb_synth/describe/about.h"
#include "tools/vdb_synth/doctor/doctor_report.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <cstdio>
#include <new>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace vdbsynth::cli {
namespace {

int fail(const Error& error, const std::string& command) {
    const std::string text = printableText(inFlags(error.what(), command));
    std::fprintf(stderr, "vdb_synth%s%s: error: %s\n", command.empty() ? "" : " ", command.c_str(),
                 text.c_str());
    if (error.code() == ErrorCode::Cancelled && stopSignal()) return 128 + stopSignal();
    return exitCode(error.code());
}

// Beyond this limit the system refuses memory, which becomes an error; without it the process would be
// killed.
void limitMemory(std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const rlimit limit{rlim_t(bytes + 512000000), rlim_t(bytes + 512000000)};
    ::setrlimit(RLIMIT_DATA, &limit);
#else
    (void)bytes;
#endif
}

// True if all output was written. Output that exceeds the buffer fails before the flush.
bool arrived() {
    return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

int printed() {
    if (arrived()) return 0;
    return fail(Error(ErrorCode::Io, "standard output cannot be written"), "");
}

// Those of every frame; of no sequence the arguments themselves.
std::vector<Arguments> framesOf(const Arguments& arguments) {
    std::vector<int> numbers;
    if (!arguments.has("frames") || !readFrames(arguments.text("frames"), numbers)) return {arguments};
    std::vector<Arguments> all;
    for (const int number : numbers) all.push_back(atFrame(arguments, number));
    return all;
}

int execute(const Command& command, const Arguments& arguments, const SupervisorLine& line,
            FrameCache* frames = nullptr) {
    try {
        Run run(command, arguments, line, frames);
        if (!command.ofTheProgram) limitMemory(run.context.maxMemory);
        try {
            command.run(run);
        } catch (const Error& error) {
            // Errors name outputs, not their temporary files.
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

// One after the other, so that what they share is read once. The first that fails ends the sequence: frames
// before it are written.
int executeFrames(const Command& command, const Arguments& arguments, const SupervisorLine& line) {
    std::vector<int> numbers;
    readFrames(arguments.text("frames"), numbers);
    FrameCache cache(arguments);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (!arguments.has("quiet"))
            std::fprintf(stderr, "vdb_synth: frame %d, %zu of %zu\n", numbers[n], n + 1, numbers.size());
        const int code = execute(command, atFrame(arguments, numbers[n]), line, &cache);
        if (code == 0) continue;
        if (n > 0)
            std::fprintf(stderr, "vdb_synth: stopped at frame %d; the %zu before it are written\n",
                         numbers[n], n);
        return code;
    }
    return 0;
}

int dispatch(char** argv, const std::string& name, const std::vector<std::string>& words) {
    if (name.empty()) {
        std::fprintf(stderr, "%s", overview().c_str());
        return 2;
    }
    if (isAboutProgram(name)) {
        try {
            std::printf("%s", aboutProgram(name, words).c_str());
        } catch (const Error& error) {
            return fail(error, "");
        }
        return printed();
    }
    const Command* command = findCommand(name);
    if (!command) {
        std::vector<std::string> names{"help", "completion"};
        for (const Command* known : commands()) names.push_back(known->name);
        return fail(Error(ErrorCode::InvalidOption, notACommand(name, names)), "");
    }
    Arguments arguments;
    try {
        arguments = parseArguments(command->name, words);
        if (arguments.has("help")) {
            std::printf("%s", helpText(*command).c_str());
            return printed();
        }
        if (arguments.has("version")) {
            std::printf("%s", versionText().c_str());
            return printed();
        }
        mergeConfig(arguments);
        arguments.check();
        checkFrames(arguments, command->inputsAreOutputs);
        for (const Arguments& one : framesOf(arguments)) refuseOverwriting(one, command->inputsAreOutputs);
    } catch (const Error& error) {
        return fail(error, command->name);
    } catch (const std::exception& error) {
        return fail(Error(ErrorCode::InvalidOption, error.what()), command->name);
    }
    const auto work = [&](const SupervisorLine& line) {
        return arguments.has("frames") ? executeFrames(*command, arguments, line)
                                       : execute(*command, arguments, line);
    };
    if (arguments.has("no-supervisor") || command->runsOthers || command->ofTheProgram) {
        installStopHandlers();
        return work(SupervisorLine());
    }
    return supervise(argv, work);
}

}  // namespace

}  // namespace vdbsynth::cli

int main(int argc, char** argv) {
    using namespace vdbsynth;
    // If a standard stream is closed, the next file opened would take its number.
    for (int file = ::open("/dev/null", O_RDWR); file >= 0 && file <= 2;) file = ::open("/dev/null", O_RDWR);
    const std::vector<std::string> words(argv + std::min(argc, 2), argv + argc);
    const std::string first = argc > 1 ? argv[1] : "";
    return cli::dispatch(argv, first, words);
}
