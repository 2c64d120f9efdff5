// Options of every command: how a run proceeds, not what it makes.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {

std::vector<Option> runningOptionTable() {
    const std::vector<std::string> every{"convert", "info",           "crop",   "mask",    "match",  "synth",
                                         "analogy", "texture",        "repeat", "compare", "render", "make",
                                         "relief",  "relief-extract", "patch",  "batch",   "doctor"};
    std::vector<std::string> sequences;
    for (const std::string& command : every)
        if (command != "make" && command != "batch" && command != "doctor") sequences.push_back(command);
    std::vector<Option> table{
        option(Kind::Seed, "seed", "N")
            .says("seed of everything random")
            .initially("0")
            .noting("the same seed gives the same bytes")
            .takenBy({"convert", "synth", "analogy", "texture", "make", "compare", "relief", "patch"}),
        whole("threads", "N", 0, 1024)
            .says("number of threads")
            .initially("0")
            .noting("0: one per core; results do not depend on it")
            .takenBy(every),
        option(Kind::Bytes, "max-memory", "BYTES")
            .says("most memory to use, such as 4G")
            .otherwiseIs("80 % of the machine's")
            .takenBy(every),
        choice("progress", "STYLE",
               {{"auto", "a bar on a terminal, else lines"},
                {"bar", ""},
                {"lines", "a line a minute"},
                {"json", ""},
                {"off", ""}})
            .says("progress on standard error")
            .initially("auto")
            .takenBy(every),
        option(Kind::Frames, "frames", "LIST")
            .says(
                "run once for each of these frames, such as 1-20, 1-20x2 or 1,4,10-12; #### in the names of "
                "inputs and outputs stands for a frame's number")
            .noting("what is the same for all frames is read once")
            .takenBy(sequences),
        output("report", "FILE.json", {"*"})
            .says("write options, times and peak memory by stage, and counts")
            .takenBy(every),
        file("config", "FILE.json", {})
            .says("options from a file or an earlier report; the command line takes precedence")
            .takenBy(every),
        flag("force")
            .says("allow an output that is also an input of this run; it is replaced at the end")
            .takenBy(every),
        flag("no-supervisor").says("run in this process, for debuggers").takenBy(every),
        flag("quiet").shortly('q').says("errors and warnings only").takenBy(every),
        flag("verbose").shortly('v').says("print each step").takenBy(every),
        flag("help").shortly('h').says("this text").takenBy(every),
        flag("version").says("versions of vdb_synth and of the libraries it runs with").takenBy(every),
    };
    // The seed has a metadata key of its own.
    for (Option& option : table) option.in(Group::Running).ofTheRun();
    return table;
}

}  // namespace vdbsynth::cli
