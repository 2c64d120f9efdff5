#pragma once
#include "tools/vdb_synth/batch/job_plan.h"

#include <map>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// The files that a job reads and writes, frames of its option --frames filled in.
/// @throw Error InvalidOption (a standard stream)
std::vector<std::string> readBy(const Job& job);
std::vector<std::string> writtenBy(const Job& job);

/// Which job writes which file; paths are compared without their "." and "..".
class PathTable {
public:
    explicit PathTable(const Plan& plan);

    /// @throw Error InvalidOption (another job writes it, or it is the job file)
    void addOutput(std::size_t job, const std::string& name, const std::string& path);
    /// @throw Error InvalidOption: a pattern that matches what a job writes would make more jobs next time
    void refuseMatches(const std::string& pattern) const;
    /// The inputs of a job, each pattern replaced by the files it matches and by what other jobs write.
    /// @throw Error InvalidOption (matches nothing, or what the job itself writes)
    std::vector<std::string> expanded(std::size_t job, const Job& of) const;
    /// The job that writes a file, -1 if it is there already.
    /// @throw Error Io (neither), InvalidOption (the job itself)
    long makerOf(std::size_t job, const std::string& path) const;

private:
    struct Output {
        std::size_t job;
        std::string name, path;
    };
    std::string full(const std::string& path) const;
    const Plan& mPlan;
    std::map<std::string, Output> mOutputs;  // by full path
};

}  // namespace vdbsynth::cli::batch
