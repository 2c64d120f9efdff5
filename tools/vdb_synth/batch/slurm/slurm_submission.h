#pragma once
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// A job array as it was handed over.
struct SubmittedArray {
    int number = 0;
    std::string name;  ///< of Slurm's job; no two batches share one
    std::string id;    ///< Slurm's; empty: sbatch was about to be called
};

/// What is in Slurm's queue for a batch: LOGS/slurm.json, which is there until the last job was followed to
/// its end. It is written before and after each array is handed over, so that whatever kills a batch, the
/// next one finds them all.
struct Submission {
    std::string token;  ///< tells batches apart
    std::vector<SubmittedArray> arrays;

    /// "12, 13": the ids.
    std::string idText(const std::string& sign = ", ") const;
};

/// An absolute path without . and .., and without a / at its end.
std::string fullPath(const std::string& path);
std::string submissionPath(const std::string& logs);
/// The file of an array's tasks, which they read when they start.
std::string taskFilePath(const std::string& logs, const std::string& token, int number);
/// Where a job's last task said how it ended.
std::string resultPath(const std::string& logs, const std::string& job);
/// What Slurm keeps of a task's output.
std::string slurmLogPath(const std::string& logs, const std::string& id, const std::string& index);

/// None if nothing was handed over. @throw Error BadData (damaged), Io
std::optional<Submission> readSubmission(const std::string& logs);
/// @throw Error Io
void writeSubmission(const std::string& logs, const Submission& submission);
/// One of which the token is new.
Submission newSubmission();

/// Refuses to run the jobs elsewhere. @throw Error Io if some may be in Slurm's queue
void refuseSubmitted(const std::string& logs);

}  // namespace vdbsynth::cli::batch
