#include "tools/vdb_synth/batch/executor/job_process.h"

#include <chrono>
#include <csignal>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vdbsynth::cli::batch {

pid_t startProcess(const std::vector<std::string>& words, const std::string& folder, const std::string& log,
                   int keptOpen) {
    // Between fork and exec nothing may allocate: libraries of ours have threads.
    std::vector<char*> argv{const_cast<char*>("vdb_synth")};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const int output = ::open(log.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    if (output < 0) return -1;
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) ::_exit(1);  // it died before the line above
        const int nothing = ::open("/dev/null", O_RDONLY);
        ::dup2(nothing, 0);
        ::dup2(output, 1);
        ::dup2(output, 2);
        if (keptOpen >= 0) ::fcntl(keptOpen, F_SETFD, 0);
        if (::chdir(folder.c_str()) == 0) ::execv("/proc/self/exe", argv.data());
        ::_exit(127);
    }
    ::close(output);
    return process;
}

std::optional<Ended> endedProcess() {
    int status = 0;
    rusage usage{};
    const pid_t process = ::wait4(-1, &status, WNOHANG, &usage);
    if (process <= 0) return {};
    Ended ended;
    ended.process = process;
    ended.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    ended.code = ended.signal ? 128 + ended.signal : WEXITSTATUS(status);
    ended.peakBytes = std::uint64_t(usage.ru_maxrss) * 1024;
    return ended;
}

void adoptOrphans() {
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
    ::signal(SIGCHLD, SIG_DFL);  // an inherited SIG_IGN would hide how children end
}

void waitForAll(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        const pid_t process = ::waitpid(-1, nullptr, WNOHANG);
        if (process < 0) return;
        if (process == 0) ::usleep(10000);
    }
}

}  // namespace vdbsynth::cli::batch
