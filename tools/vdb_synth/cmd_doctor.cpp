#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/doctor/doctor_report.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

void doctor(Run& run) {
    run.requireInputs(0, 0);
    const nlohmann::ordered_json report = doctorReport(run.context);
    if (run.arguments.has("json") || run.arguments.has("output")) {
        run.answer(report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else {
        const std::string text = doctorText(report);
        printLine(text.substr(0, text.size() - 1));
    }
    run.finish();
}

}  // namespace

const Command kDoctor{"doctor",
                      "doctor [--json] [-o OUT.json]",
                      "Print what a bug report needs: versions, processor, memory, limits, locale",
                      "vdb_synth doctor",
                      doctor,
                      /* inputsAreOutputs= */ false,
                      /* runsOthers= */ false,
                      /* ofTheProgram= */ true};

}  // namespace vdbsynth::cli
