#include "tools/vdb_synth/batch/slurm/slurm_submission.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "tools/vdb_synth/batch/job_manifest.h"

#include <chrono>
#include <filesystem>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

constexpr int kFormat = 1;

}  // namespace

std::string Submission::idText(const std::string& sign) const {
    std::string text;
    for (const SubmittedArray& array : arrays)
        if (!array.id.empty()) text += (text.empty() ? "" : sign) + array.id;
    return text;
}

std::string fullPath(const std::string& path) {
    const std::filesystem::path full = std::filesystem::absolute(path).lexically_normal();
    return (full.has_filename() ? full : full.parent_path()).string();
}

std::string submissionPath(const std::string& logs) {
    return logs + "/slurm.json";
}

std::string taskFilePath(const std::string& logs, const std::string& token, int number) {
    return logs + "/slurm/" + token + "." + std::to_string(number) + ".tasks.json";
}

std::string resultPath(const std::string& logs, const std::string& job) {
    return logs + "/slurm/" + job + ".result.json";
}

std::string slurmLogPath(const std::string& logs, const std::string& id, const std::string& index) {
    return logs + "/slurm/" + id + "_" + index + ".out";
}

std::optional<Submission> readSubmission(const std::string& logs) {
    const std::string path = submissionPath(logs);
    if (::access(path.c_str(), F_OK) != 0) return {};
    try {
        const Json json = parseJobText(path, readWholeFile(path), false);
        if (json.at("format").get<int>() != kFormat) throw Error(ErrorCode::BadData, "is of another format");
        Submission submission;
        submission.token = json.at("token").get<std::string>();
        for (const Json& array : json.at("arrays"))
            submission.arrays.push_back({array.at("number").get<int>(), array.at("name").get<std::string>(),
                                         array.at("id").get<std::string>()});
        return submission;
    } catch (const std::exception&) {
        throw Error(ErrorCode::BadData,
                    path +
                        ": is damaged, so what is in Slurm's queue is unknown; end its jobs "
                        "(squeue --me, scancel) and remove this file");
    }
}

void writeSubmission(const std::string& logs, const Submission& submission) {
    Json arrays = Json::array();
    for (const SubmittedArray& array : submission.arrays)
        arrays.push_back({{"number", array.number}, {"name", array.name}, {"id", array.id}});
    const Json all{{"format", kFormat}, {"token", submission.token}, {"arrays", arrays}};
    replaceFile(submissionPath(logs), all.dump(1) + "\n");
}

Submission newSubmission() {
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    const std::string text = std::string(host) + "," + std::to_string(::getpid()) + "," +
                             std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
    Submission submission;
    submission.token = contentHash(text.data(), text.size()).substr(0, 8);
    return submission;
}

void refuseSubmitted(const std::string& logs) {
    const std::optional<Submission> submission = readSubmission(logs);
    if (!submission) return;
    const std::string ids = submission->idText();
    throw Error(ErrorCode::Io, logs + ": jobs of this batch were handed to Slurm" +
                                   (ids.empty() ? "" : " (arrays " + ids + ")") +
                                   " and not followed to their end; --executor slurm follows them");
}

}  // namespace vdbsynth::cli::batch
