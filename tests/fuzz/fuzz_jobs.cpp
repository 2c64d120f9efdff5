// A job file under libFuzzer, from its text to the plan of its jobs: JSON where it begins with a brace, else
// YAML. Anything but a plan or an Error is found.
#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/batch/job_plan.h"

#include <cstddef>
#include <cstdint>
#include <string>

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
