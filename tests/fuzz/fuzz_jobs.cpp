// A job file under libFuzzer, from its text to the plan of its jobs: JSON where it begins with a brace, else
// YAML. Anything but a plan or an Error is found.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "tools/vdb_synth/batch/job_plan.h"
#include "tools/vdb_synth/command.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// What a plan asks of the rest of the program, without what runs the commands and writes models.
namespace vdbsynth {

namespace cli {

const std::vector<const Command*>& commands() {
    static const std::vector<Command> all = [] {
        std::vector<Command> named;
        for (const char* name :
             {"convert", "info", "crop", "mask", "match", "synth", "analogy", "patch", "texture", "repeat",
              "compare", "render", "make", "relief", "relief-extract", "batch", "doctor"})
            named.push_back({name, "", "", "", nullptr, std::string(name) == "make"});
        return named;
    }();
    static const std::vector<const Command*> pointers = [] {
        std::vector<const Command*> each;
        for (const Command& command : all) each.push_back(&command);
        return each;
    }();
    return pointers;
}

const Command* findCommand(const std::string& name) {
    for (const Command* command : commands())
        if (command->name == name) return command;
    return nullptr;
}

}  // namespace cli

void requireOutputPaths(const std::vector<std::string>&) {}

}  // namespace vdbsynth

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vdbsynth::cli::batch;
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const bool yaml = text.empty() || text.front() != '{';
        const Plan plan = makePlan(readJobFile("fuzz", parseJobText("fuzz", text, yaml), {}));
        if (planText(plan).empty() || planJson(plan).empty()) __builtin_trap();
        for (const Job& job : plan.jobs)
            if (shellText(wordsOf(job)).empty()) __builtin_trap();
    } catch (const vdbsynth::Error& error) {
        if (std::string(error.what()).empty()) __builtin_trap();
    }
    return 0;
}
