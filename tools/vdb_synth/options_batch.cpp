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
            .noting(
                "a job waits while the others leave too little memory; with --executor slurm: tasks of an "
                "array that run at once, by default any number"),
        choice("executor", "WHERE",
               {{"local", "on this machine"}, {"slurm", "as job arrays of a Slurm cluster"}})
            .in(Group::Method)
            .says("where jobs run")
            .initially("local"),
        option(Kind::Text, "slurm-partition", "NAME")
            .in(Group::Method)
            .says("partition of the cluster")
            .otherwiseIs("the cluster's own"),
        option(Kind::Text, "slurm-time", "TIME")
            .in(Group::Method)
            .says("most time that a job may take, as sbatch --time has it: 90 (minutes), 2:30:00, 1-00")
            .otherwiseIs("the partition's own"),
        option(Kind::Text, "slurm-arguments", "WORDS")
            .in(Group::Method)
            .says("more arguments of sbatch: --slurm-arguments=\"--account=show --qos=night\""),
        choice("on-interrupt", "WHAT",
               {{"leave", "jobs stay in Slurm's queue, and the same command follows them"},
                {"cancel", "jobs are cancelled"}})
            .in(Group::Method)
            .says("what ctrl-C and SIGTERM do to the jobs of --executor slurm")
            .initially("leave"),
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
        whole("task", "N", 1, 4000000)
            .in(Group::Running)
            .says("run one job of a file that --executor slurm wrote, by its number; tasks of arrays do so"),
    };
    for (Option& option : table) option.takenBy(batch).ofTheRun();
    return table;
}

}  // namespace vdbsynth::cli
