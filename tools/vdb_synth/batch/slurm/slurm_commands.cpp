#include "tools/vdb_synth/batch/slurm/slurm_commands.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

constexpr double kPatience = 60;

std::vector<std::string> partsOf(const std::string& text, char sign) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, sign);) parts.push_back(part);
    return parts;
}

std::string joined(const std::vector<std::string>& words, const std::string& sign) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : sign) + word;
    return text;
}

// "1-02:03:04", "02:03" or "03": days, hours, minutes, seconds.
double secondsIn(const std::string& text) {
    const std::size_t dash = text.find('-');
    double seconds = 0, days = 0;
    if (dash != std::string::npos) parseReal(text.substr(0, dash), days);
    for (const std::string& part : partsOf(dash == std::string::npos ? text : text.substr(dash + 1), ':')) {
        double number = 0;
        parseReal(part, number);
        seconds = seconds * 60 + number;
    }
    return seconds + days * 86400;
}

bool namesNode(const std::string& nodes) {
    return !nodes.empty() && nodes != "(null)" && nodes.find("None") == std::string::npos;
}

// What a command of Slurm's says, as one line.
std::string lineOf(const CommandOutput& output, const std::string& command) {
    if (output.code == 127) return command + ": cannot be run";
    if (output.code == -1) return command + ": did not answer in " + fixedText(kPatience, 0) + " s";
    std::string line;
    for (const std::string& one : partsOf(output.errors, '\n'))
        if (!one.empty()) line += (line.empty() ? "" : "; ") + one;
    return line.empty() ? command + ": ended with exit code " + std::to_string(output.code) : line;
}

bool isInPath(const std::string& command) {
    const char* path = std::getenv("PATH");
    for (const std::string& folder : partsOf(path ? path : "", ':'))
        if (::access((folder + "/" + command).c_str(), X_OK) == 0) return true;
    return false;
}

}  // namespace

bool isEndState(const std::string& state) {
    static const std::vector<std::string> states{"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE",
                                                 "FAILED",    "NODE_FAIL", "PREEMPTED", "OUT_OF_MEMORY",
                                                 "REVOKED",   "TIMEOUT"};
    return std::find(states.begin(), states.end(), state) != states.end();
}

bool isRunState(const std::string& state) {
    static const std::vector<std::string> states{"RUNNING",   "COMPLETING", "RESIZING", "SIGNALING",
                                                 "STAGE_OUT", "STOPPED",    "SUSPENDED"};
    return std::find(states.begin(), states.end(), state) != states.end();
}

void requireSlurm() {
    for (const char* command : {"sbatch", "squeue", "scancel"})
        if (!isInPath(command))
            throw Error(ErrorCode::Io, std::string(command) +
                                           ": is no command of this machine; --executor slurm needs those of "
                                           "Slurm (sbatch, squeue, scancel)");
}

std::vector<std::string> sbatchArguments(const std::string& text) {
    std::vector<std::string> words;
    char quote = 0;
    bool open = false;
    for (const char c : text) {
        if (quote ? c == quote : c == '\'' || c == '"') {
            quote = quote ? char(0) : c;
        } else if (c == ' ' && !quote) {
            open = false;
            continue;
        } else {
            if (!open) words.emplace_back();
            words.back() += c;
            open = true;
            continue;
        }
        if (!open) words.emplace_back();
        open = true;
    }
    if (quote) throw Error(ErrorCode::InvalidOption, "--slurm-arguments " + text + ": a quote has no end");
    static const std::set<std::string> ours{"-a",
                                            "-d",
                                            "-J",
                                            "-o",
                                            "-e",
                                            "-D",
                                            "-W",
                                            "--array",
                                            "--dependency",
                                            "--job-name",
                                            "--output",
                                            "--open-mode",
                                            "--error",
                                            "--chdir",
                                            "--wait",
                                            "--wrap",
                                            "--parsable",
                                            "--test-only",
                                            "--kill-on-invalid-dep"};
    for (const std::string& word : words)
        if (ours.count(word.substr(0, word.find('='))))
            throw Error(ErrorCode::InvalidOption, "--slurm-arguments " + word + ": batch sets this itself");
    return words;
}

SlurmTasks readTasks(const std::string& rows) {
    SlurmTasks tasks;
    for (const std::string& row : partsOf(rows, '\n')) {
        const std::vector<std::string> cells = partsOf(row, '|');
        int index = 0;
        if (cells.size() < 5 || !parseWhole(cells[1], index)) continue;
        tasks[{cells[0], index}] = {cells[2], cells.size() > 5 ? cells[5] : "", namesNode(cells[4]),
                                    secondsIn(cells[3])};
    }
    return tasks;
}

SlurmTasks readAccounts(const std::string& rows) {
    SlurmTasks tasks;
    for (const std::string& row : partsOf(rows, '\n')) {
        const std::vector<std::string> cells = partsOf(row, '|');
        if (cells.size() < 4) continue;
        const std::vector<std::string> task = partsOf(cells[0], '_');
        int index = 0;
        if (task.size() != 2 || !parseWhole(task[1], index)) continue;
        // "CANCELLED by 1000"
        tasks[{task[0], index}] = {cells[1].substr(0, cells[1].find(' ')), "", namesNode(cells[3]),
                                   secondsIn(cells[2])};
    }
    return tasks;
}

SlurmTasks queuedTasks(const std::vector<std::string>& ids, bool& answered, std::string& problem) {
    answered = true;
    if (ids.empty()) return {};
    const CommandOutput output = runCommand({"squeue", "--noheader", "--array", "--states=all",
                                             "--jobs=" + joined(ids, ","), "--format=%F|%K|%T|%M|%N|%r"},
                                            "", kPatience);
    // All of them left the queue long ago.
    if (output.errors.find("Invalid job id") != std::string::npos) return {};
    answered = output.code == 0;
    if (!answered) problem = lineOf(output, "squeue");
    return readTasks(output.text);
}

SlurmTasks accountedTasks(const std::vector<std::string>& ids) {
    if (ids.empty() || !isInPath("sacct")) return {};
    const CommandOutput output =
        runCommand({"sacct", "--noheader", "--parsable2", "--allocations", "--jobs=" + joined(ids, ","),
                    "--format=JobID,State,Elapsed,NodeList"},
                   "", kPatience);
    return output.code == 0 ? readAccounts(output.text) : SlurmTasks{};
}

std::string arrayNamed(const std::string& name, bool& answered) {
    const CommandOutput output =
        runCommand({"squeue", "--noheader", "--states=all", "--name=" + name, "--format=%F"}, "", kPatience);
    answered = output.code == 0;
    return output.text.substr(0, output.text.find_first_of(" \n"));
}

std::string submitted(const std::vector<std::string>& arguments, const std::string& script) {
    std::vector<std::string> words{"sbatch", "--parsable"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const CommandOutput output = runCommand(words, script, kPatience);
    // "12", or "12;cluster"; lines of the site may stand before it.
    std::string id;
    for (const std::string& line : partsOf(output.text, '\n')) id = line.substr(0, line.find(';'));
    if (output.code != 0 || id.empty() || id.find_first_not_of("0123456789") != std::string::npos)
        throw Error(ErrorCode::Unusable, lineOf(output, "sbatch"));
    return id;
}

void cancelTasks(const std::vector<std::string>& tasks) {
    // Tasks that have ended are no error.
    for (std::size_t begin = 0; begin < tasks.size(); begin += 500) {
        std::vector<std::string> words{"scancel", "--quiet"};
        words.insert(words.end(), tasks.begin() + long(begin),
                     tasks.begin() + long(std::min(tasks.size(), begin + 500)));
        runCommand(words, "", kPatience);
    }
}

int largestIndex() {
    const CommandOutput output = runCommand({"scontrol", "show", "config"}, "", kPatience);
    int size = 1001;  // Slurm's own default
    for (const std::string& line : partsOf(output.text, '\n'))
        if (line.compare(0, 12, "MaxArraySize") == 0)
            parseWhole(line.substr(std::min(line.find('=') + 2, line.size())), size);
    return std::max(size - 1, 1);
}

}  // namespace vdbsynth::cli::batch
