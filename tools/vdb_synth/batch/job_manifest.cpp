#include "tools/vdb_synth/batch/job_manifest.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "tools/vdb_synth/batch/referred_files.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/version.h"

#include <algorithm>

#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

constexpr int kFormat = 1;

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Options that change how a run proceeds, and those whose files are listed with the outputs.
bool isOfTheRun(const Option& option) {
    static const std::vector<std::string> names{"threads", "max-memory", "quiet", "verbose", "force"};
    return std::find(names.begin(), names.end(), option.name) != names.end() || option.kind == Kind::Folder ||
           option.kind == Kind::Output;
}

}  // namespace

const std::string& FileHashes::of(const std::string& path) {
    const auto known = mHashes.find(path);
    if (known != mHashes.end()) return known->second;
    return mHashes[path] = fileHash(path);
}

std::string fingerprintOf(const Plan& plan, const Job& job, FileHashes& hashes) {
    Json options = Json::object();
    for (const auto& [name, values] : job.arguments.normalised()) options[name] = values;
    for (const auto& [name, values] : job.arguments.values) {
        const Option* option = findOption(job.command->name, name);
        if (!option || isOfTheRun(*option) || options.contains(name)) continue;
        Json normal = Json::array();
        for (const std::string& value : values)
            normal.push_back(value == kNoValue ? value : normalValue(*option, value));
        options[name] = normal;
    }
    Json inputs = Json::array();
    for (const std::string& path : job.reads) {
        inputs.push_back({path, hashes.of(inFolder(plan, path))});
        for (const std::string& referred : referredFiles(inFolder(plan, path)))
            inputs.push_back({fileNameOf(referred), hashes.of(referred)});
    }
    const Json all{{"version", kVersion}, {"command", job.command->name},
                   {"options", options},  {"words", job.arguments.inputs},
                   {"inputs", inputs},    {"outputs", job.writes}};
    const std::string text = dumped(all);
    return contentHash(text.data(), text.size());
}

void replaceFile(const std::string& path, const std::string& content) {
    OutputSet set;
    try {
        writeWholeFile(set.add(path), content);
    } catch (const Error& error) {
        throw Error(error.code(), set.withoutTemporaries(error.what()));
    }
    set.commit();
}

Manifest::Manifest(const std::string& path, const RunContext& ctx) : mPath(path) {
    if (path.empty() || ::access(path.c_str(), F_OK) != 0) return;
    try {
        const Json json = parseJobText(path, readWholeFile(path), false);
        const int format = json.at("format").get<int>();
        const std::string version = json.value("version", std::string("of an unknown version"));
        if (format != kFormat) {
            message(ctx, MessageLevel::Warning,
                    path + ": is of format " + std::to_string(format) + ", written by vdb_synth " +
                        printableText(version, 20) + "; this version reads format " +
                        std::to_string(kFormat) + ": it is made anew and all jobs run");
            return;
        }
        if (version != kVersion)
            message(ctx, MessageLevel::Note,
                    path + ": was written by vdb_synth " + printableText(version, 20) + "; with " + kVersion +
                        " all jobs run again");
        for (const auto& [name, entry] : json.at("jobs").items()) {
            JobRecord record;
            record.fingerprint = entry.at("fingerprint").get<std::string>();
            for (const auto& [output, hash] : entry.at("outputs").items())
                record.outputs[output] = hash.get<std::string>();
            record.seconds = entry.at("seconds").get<double>();
            record.peakBytes = entry.at("peak_bytes").get<std::uint64_t>();
            mRecords[name] = record;
        }
    } catch (const std::exception&) {
        mRecords.clear();
        message(ctx, MessageLevel::Warning,
                path + ": is damaged, so what was done before is unknown; it is made anew and all jobs run");
    }
}

const JobRecord* Manifest::find(const std::string& job) const {
    const auto record = mRecords.find(job);
    return record == mRecords.end() ? nullptr : &record->second;
}

void Manifest::put(const std::string& job, JobRecord record) {
    mRecords[job] = std::move(record);
}

void Manifest::save() {
    if (mPath.empty()) return;
    Json jobs = Json::object();
    for (const auto& [name, record] : mRecords)
        jobs[name] = {{"fingerprint", record.fingerprint},
                      {"outputs", record.outputs},
                      {"seconds", record.seconds},
                      {"peak_bytes", record.peakBytes}};
    const Json all{{"format", kFormat}, {"version", kVersion}, {"jobs", jobs}};
    replaceFile(mPath, all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

bool isCurrent(const Plan& plan, const Job& job, const Manifest& manifest, FileHashes& hashes) {
    const JobRecord* record = manifest.find(job.name);
    if (!record || record->outputs.size() != job.writes.size()) return false;
    try {
        if (record->fingerprint != fingerprintOf(plan, job, hashes)) return false;
        for (const std::string& path : job.writes) {
            const auto known = record->outputs.find(path);
            if (known == record->outputs.end() || known->second != hashes.of(inFolder(plan, path)))
                return false;
        }
    } catch (const Error&) {
        return false;  // a file is not there or cannot be read: the job says why
    }
    return true;
}

}  // namespace vdbsynth::cli::batch
