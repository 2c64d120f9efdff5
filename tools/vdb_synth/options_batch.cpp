// Options of batch.
#include "tools/vdb_synth/option_makers.h"
#include "tools/vdb_synth/options.h"

namespace vdbsynth::cli {

std::vector<Option> batchOptionTable() {
    const std::vector<std::string> batch{"batch"};
    std::vector<Option> table{
        whole("jobs", "N", 1, 256)
            .in(Group::Method)
            .says("jobs that run at once; each gets an equal share of --threads and --max-memory")
            .initially("1")
            .noting("a job waits while the others leave too little memory"),
        option(Kind::Text, "set", "NAME=VALUE")
            .in(Group::Method)
            .says("another value for a variable of the job file")
            .repeatable(),
        flag("keep-going")
            .in(Group::Method)
            .says("run what does not depend on a job that failed (the default)"),
        flag("fail-fast").in(Group::Method).says("start no job after one failed; those that run may end"),
        flag("dry-run").in(Group::Output).says("check all, print the command line of each job, and run none"),
        flag("json").in(Group::Output).says("with --dry-run: print the plan as JSON"),
        flag("schema").in(Group::Output).says("print a JSON schema of job files, for editors; needs no JOBS"),
        output("output", "FILE.json", {"json"})
            .shortly('o')
            .says("write the plan of --dry-run as JSON, or the schema, to this file"),
        option(Kind::Folder, "logs", "FOLDER")
            .in(Group::Output)
            .says("folder of logs, reports and the record of what is done")
            .otherwiseIs("NAME.logs beside the job file NAME.json"),
        output("page", "FILE.html", {"html", "htm"})
            .says("keep a page with the state, time, memory and error of each job up to date"),
        flag("pictures").in(Group::Output).says("render a small picture of each result for --page"),
    };
    for (Option& option : table) option.takenBy(batch).ofTheRun();
    return table;
}

}  // namespace vdbsynth::cli
