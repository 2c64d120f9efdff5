#include "tools/vdb_synth/batch/executor/local_processes.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <csignal>
#include <filesystem>

#include <unistd.h>

namespace vdbsynth::cli::batch {

std::uint64_t LocalProcesses::share() const {
    return std::max<std::uint64_t>(mOptions.memory / std::uint64_t(mOptions.jobs), 1000000);
}

bool LocalProcesses::fits(std::uint64_t bytes) const {
    std::uint64_t taken = 0;
    for (const auto& [id, process] : mRunning) taken += process.reserved;
    return int(mRunning.size()) < mOptions.jobs &&
           (mRunning.empty() || taken + bytes <= std::max<std::uint64_t>(mOptions.memory, 1));
}

void LocalProcesses::launch(const LocalProcess& process, const std::vector<std::string>& words,
                            const std::string& log) {
    const std::string full = std::filesystem::absolute(log).string();
    const pid_t id = startProcess(words, mPlan.folder, full, mOptions.keptOpen);
    if (id < 0) throw Error(ErrorCode::Io, full + ": cannot be written, or no process can be started");
    mRunning[id] = process;
}

bool LocalProcesses::collect() {
    const std::optional<Ended> ended = endedProcess();
    if (!ended) return false;
    const auto found = mRunning.find(ended->process);
    if (found == mRunning.end()) return true;
    found->second.ended = *ended;
    (found->second.picture.empty() ? mEndedJobs : mEndedPictures).push_back(found->second);
    mRunning.erase(found);
    return true;
}

std::optional<LocalProcess> LocalProcesses::next(std::vector<LocalProcess>& ended) {
    while (collect()) {
    }
    if (ended.empty()) return {};
    const LocalProcess first = ended.front();
    ended.erase(ended.begin());
    return first;
}

void LocalProcesses::stop(int signal) {
    for (const auto& [id, process] : mRunning) ::kill(id, signal);
    const auto began = std::chrono::steady_clock::now();
    bool killed = false;
    while (!mRunning.empty()) {
        if (collect()) continue;
        if (!killed && std::chrono::steady_clock::now() - began > std::chrono::seconds(10)) {
            killed = true;
            for (const auto& [id, process] : mRunning) ::kill(id, SIGKILL);
        }
        ::usleep(10000);
    }
}

}  // namespace vdbsynth::cli::batch
