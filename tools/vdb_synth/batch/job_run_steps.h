#pragma once
#include "tools/vdb_synth/batch/job_run.h"

#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli::batch {

/// The state of what must be done before a job.
struct Before {
    bool open = false;  ///< some of it has not ended
    long failed = -1;   ///< one that was not done, -1: none
};
Before beforeOf(const Job& job, const std::vector<JobStatus>& status);

/// True if an error says that memory did not suffice, and the job does not set it itself.
bool saysMemory(const Job& job, const std::string& error);
/// The words of a job's process, with threads, memory and report.
std::vector<std::string> processWords(const Job& job, const RunOptions& options, std::uint64_t memory);
/// Of the process that draws a small picture of a result.
std::vector<std::string> pictureWords(const std::string& result, const std::string& picture,
                                      const RunOptions& options, std::uint64_t memory);
/// Results of a job, as this process can open them, each with the PNG file to draw; a result that is a small
/// PNG file is its own picture.
std::vector<std::pair<std::string, std::string>> picturesOf(const Plan& plan, const Job& job,
                                                            const std::string& logs);

/// Makes the folders of outputs, and says so. @throw Error Io
void makeFolders(const Plan& plan, const Job& job, const RunContext& ctx);
/// Empties a job's log but for the command line, and removes its report. @throw Error Io
void beginLog(const Plan& plan, const Job& job, const std::string& logs,
              const std::vector<std::string>& words);
/// The largest "peak_bytes" of a job's reports, 0 if there is none.
std::uint64_t peakInReports(const Job& job, const std::string& logs);
/// The files that a job's process writes: outputs and reports.
std::vector<std::string> filesWrittenBy(const Plan& plan, const Job& job, const std::string& logs);
/// Removes what a killed job left of its outputs.
void removeTemporaries(const Plan& plan, const Job& job, const std::string& logs);

}  // namespace vdbsynth::cli::batch
