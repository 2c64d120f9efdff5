#include "tools/vdb_synth/supervisor.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "tools/vdb_synth/stop_flag.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vdbsynth::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Passed to the child: the number of its end of the pipe, and its parent's process id ("7,4711").
constexpr const char* kLineVariable = "VDBSYNTH_SUPERVISOR_LINE";

std::atomic<bool> gStop{false};
volatile std::sig_atomic_t gSignal = 0;

extern "C" void onStopSignal(int signal) {
    gSignal = signal;
    gStop.store(true, std::memory_order_relaxed);
}

// The child's state as the parent knows it.
struct Child {
    pid_t process = 0;
    std::string pending;  // bytes of an unfinished message
    std::string reading;  // file being read, empty if none
    Clock::time_point lastSign = Clock::now();
    std::set<std::string> temporaries;
};

void handle(Child& child, const std::string& message) {
    child.lastSign = Clock::now();
    if (message.empty()) return;
    if (message[0] == 'R') child.reading = message.substr(1);
    if (message[0] == 'D') child.reading.clear();
    if (message[0] == 'T') child.temporaries.insert(message.substr(1));
}

void readMessages(Child& child, int file) {
    char buffer[4096];
    for (;;) {
        const ssize_t got = ::read(file, buffer, sizeof buffer);
        if (got <= 0) return;
        child.pending.append(buffer, std::size_t(got));
        std::size_t end;
        while ((end = child.pending.find('\0')) != std::string::npos) {
            handle(child, child.pending.substr(0, end));
            child.pending.erase(0, end + 1);
        }
    }
}

// Generous: no reader here is slower than 200 KB/s on any sample.
double secondsAllowed(const std::string& path) {
    double fixed = 0;
    const char* variable = std::getenv("VDBSYNTH_READ_TIMEOUT");
    if (variable && parseReal(variable, fixed)) return fixed;
    struct stat status {};
    const double bytes = ::stat(path.c_str(), &status) == 0 ? double(status.st_size) : 0;
    return 20 + bytes / 200e3;
}

void removeTemporaries(const Child& child) {
    // In reverse order, so that a folder is removed after the files in it.
    for (auto path = child.temporaries.rbegin(); path != child.temporaries.rend(); ++path)
        std::remove(path->c_str());
}

int reportDeath(const Child& child, int signal, bool hung) {
    const char* program = "vdb_synth: error: ";
    const std::string reading = printableText(child.reading);
    if (hung) {
        std::fprintf(
            stderr,
            "%s%s: reading made no progress and was stopped; the file is corrupt or not what its name says\n",
            program, reading.c_str());
        return 3;
    }
    if (signal == SIGKILL) {
        std::fprintf(stderr,
                     "%s%sthe process was killed, most likely out of memory; use larger voxels, a smaller "
                     "size or --max-memory\n",
                     program, reading.empty() ? "" : (reading + ": ").c_str());
        return 1;
    }
    if (!reading.empty()) {
        std::fprintf(stderr, "%s%s: its reader crashed (signal %d); the file is truncated or corrupt\n",
                     program, reading.c_str(), signal);
        return 3;
    }
    std::fprintf(stderr,
                 "%sinternal error (signal %d); nothing was written; please report the "
                 "command line and what vdb_synth doctor prints\n",
                 program, signal);
    return 1;
}

// waitpid for the child. A container's process 1 is given the processes that lost their parents: they are
// waited for too, or they stay as zombies.
pid_t waitFor(const Child& child, int& status, int options) {
    for (;;) {
        int one = 0;
        const pid_t ended = ::waitpid(-1, &one, options);
        if (ended == child.process) status = one;
        if (ended == child.process || ended <= 0) return ended;
    }
}

int watch(Child& child, int file) {
    bool killed = false, hung = false, asked = false;
    Clock::time_point askedAt;
    int status = 0;
    for (;;) {
        pollfd wait{file, POLLIN, 0};
        ::poll(&wait, 1, 200);
        readMessages(child, file);
        const pid_t ended = waitFor(child, status, WNOHANG);
        if (ended == child.process || (ended < 0 && errno == ECHILD)) break;
        if (wait.revents & POLLHUP) {
            // The child closed its end: it is about to end.
            if (waitFor(child, status, 0) == child.process) break;
        }
        if (gSignal && !asked) {
            asked = true;
            askedAt = Clock::now();
            ::kill(child.process, gSignal);
        }
        const double silent = std::chrono::duration<double>(Clock::now() - child.lastSign).count();
        hung = hung || (!child.reading.empty() && silent > secondsAllowed(child.reading));
        const bool late = asked && std::chrono::duration<double>(Clock::now() - askedAt).count() > 5;
        if ((hung || late) && !killed) {
            killed = true;
            ::kill(child.process, SIGKILL);
        }
    }
    readMessages(child, file);
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    removeTemporaries(child);
    // A signal to both may end the child before it listens, and before this loop looks.
    const int stop = gSignal ? int(gSignal) : WTERMSIG(status);
    if (stop == SIGINT || stop == SIGTERM) {
        std::fprintf(stderr, "vdb_synth: error: interrupted; nothing was written\n");
        return 128 + stop;
    }
    return reportDeath(child, WTERMSIG(status), hung);
}

}  // namespace

const std::atomic<bool>* stopFlag() {
    return &gStop;
}
int stopSignal() {
    return gSignal;
}

void installStopHandlers() {
    struct sigaction action {};
    action.sa_handler = onStopSignal;
    ::sigemptyset(&action.sa_mask);
    struct sigaction inherited {};
    ::sigaction(SIGINT, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN) ::sigaction(SIGINT, &action, nullptr);  // nohup and background jobs
    ::sigaction(SIGTERM, &action, nullptr);
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is a write error like a full disk
}

void SupervisorLine::send(char kind, const std::string& text) const {
    if (mFile < 0) return;
    std::string message = kind + text;
    message += '\0';
    ssize_t ignored = ::write(mFile, message.data(), message.size());
    (void)ignored;
}

namespace {

// The child's side: runs the work, and ends when the parent dies.
int superviseChild(int file, pid_t parent, const std::function<int(const SupervisorLine&)>& work) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // A parent that died before the line above sends no signal. Compare with the parent's process id, not
    // with 1: a container's entry point is process 1 itself, and a subreaper may have any id.
    if (::getppid() != parent) return 1;
    ::fcntl(file, F_SETFD, FD_CLOEXEC);
    installStopHandlers();
    const int code = work(SupervisorLine(file));
    std::fflush(nullptr);
    ::_exit(code);  // everything is written; the grids need no freeing
}

// Reads kLineVariable and clears it. @return false in a process that no supervisor started
bool takeLine(int& file, pid_t& parent) {
    const char* variable = std::getenv(kLineVariable);
    if (!variable) return false;
    const std::string line = variable;
    ::unsetenv(kLineVariable);
    const std::size_t comma = std::min(line.find(','), line.size() - 1);
    return parseWhole(line.substr(0, comma), file) && parseWhole(line.substr(comma + 1), parent);
}

}  // namespace

int supervise(char** argv, const std::function<int(const SupervisorLine&)>& work) {
    int file = -1;
    pid_t parent = 0;
    if (takeLine(file, parent)) return superviseChild(file, parent, work);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return work(SupervisorLine());
    installStopHandlers();
    ::signal(SIGCHLD, SIG_DFL);  // an inherited SIG_IGN would hide how the child ended
    const std::string line = std::to_string(ends[1]) + ',' + std::to_string(::getpid());
    ::setenv(kLineVariable, line.c_str(), 1);
    const pid_t process = ::fork();
    if (process == 0) {
        // OpenVDB's logging library starts threads when it is loaded, and a fork of a process with threads
        // may only exec.
        ::fcntl(ends[1], F_SETFD, 0);
        ::execv("/proc/self/exe", argv);
        ::_exit(127);
    }
    ::unsetenv(kLineVariable);
    ::close(ends[1]);
    if (process < 0) {
        ::close(ends[0]);
        return work(SupervisorLine());
    }
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    Child child;
    child.process = process;
    return watch(child, ends[0]);
}

}  // namespace vdbsynth::cli
