#pragma once
#include <functional>
#include <string>

namespace vdbsynth::cli {

/// The working process's line to its supervisor. All calls are no-ops without a supervisor.
class SupervisorLine {
public:
    explicit SupervisorLine(int file = -1) : mFile(file) {}
    void reading(const std::string& path) const { send('R', path); }
    void doneReading() const { send('D', ""); }
    void alive() const { send('A', ""); }
    void temporary(const std::string& path) const { send('T', path); }

private:
    void send(char kind, const std::string& text) const;
    int mFile;
};

/// Runs `work` in a child process and watches it. If the child crashes, is killed, runs out of memory or
/// hangs while it reads a file, one line on standard error and an exit code by the contract report it, and
/// its temporary files are removed. SIGINT and SIGTERM are passed on; a child that does not end within five
/// seconds is killed. The child is this program run again with the same arguments, so `work` must depend on
/// them alone.
/// @return the exit code for this process
int supervise(char** argv, const std::function<int(const SupervisorLine&)>& work);

/// 0, SIGINT or SIGTERM: the signal that asked this process to stop. See installStopHandlers.
int stopSignal();
/// Makes SIGINT and SIGTERM set the flag that `stopFlag` returns instead of ending the process.
void installStopHandlers();

}  // namespace vdbsynth::cli
