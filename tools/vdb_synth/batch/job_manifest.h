#pragma once
#include "libvdbsynth/base/run_context.h"
#include "tools/vdb_synth/batch/job_plan.h"

#include <cstdint>
#include <map>
#include <string>

namespace vdbsynth::cli::batch {

/// What is known of a job that was done.
struct JobRecord {
    std::string fingerprint;                     ///< see fingerprintOf
    std::map<std::string, std::string> outputs;  ///< hashes by path
    double seconds = 0;
    std::uint64_t peakBytes = 0;
};

/// Hashes of files, each read once in a run.
class FileHashes {
public:
    /// @throw Error Io
    const std::string& of(const std::string& path);
    /// A job wrote the file.
    void forget(const std::string& path) { mHashes.erase(path); }

private:
    std::map<std::string, std::string> mHashes;
};

/// Hash of all that a job's outputs depend on: program version, command, options with their defaults, seed,
/// names of inputs and outputs, and what is in the inputs. Threads, memory and verbosity are left out.
/// Files that a model refers to (.mtl, .bin, pictures) count with the model, where they lie in its folder.
/// @throw Error Io (an input is not there)
std::string fingerprintOf(const Plan& plan, const Job& job, FileHashes& hashes);

/// The records of a batch in LOGS/manifest.json, which is replaced as a whole.
class Manifest {
public:
    /// Reads the file; one that is damaged or of another format is said (Warning) and begun anew: its jobs
    /// run again, as they do after a change of the program's version (Note). An empty path stands for no
    /// file: `save` writes none.
    Manifest(const std::string& path, const RunContext& ctx);

    /// Null if the job was never done.
    const JobRecord* find(const std::string& job) const;
    void put(const std::string& job, JobRecord record);
    /// @throw Error Io (cannot be written)
    void save();

private:
    std::string mPath;
    std::map<std::string, JobRecord> mRecords;
};

/// True if the job was done with the same fingerprint, and its outputs are there with the same content.
bool isCurrent(const Plan& plan, const Job& job, const Manifest& manifest, FileHashes& hashes);

/// Replaces a file by rename. @throw Error Io
void replaceFile(const std::string& path, const std::string& content);

}  // namespace vdbsynth::cli::batch
