#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace vdbsynth::cli::batch {

/// How a child process ended.
struct Ended {
    pid_t process = 0;
    int code = 0;                 ///< exit code; 128 + signal if it was killed
    int signal = 0;               ///< that killed it, 0: none
    std::uint64_t peakBytes = 0;  ///< largest resident memory of it and its own children
};

/// Starts this program in a folder, both output streams to the end of a file, nothing as standard input. It
/// is asked to stop (SIGTERM) when this process dies.
/// @param keptOpen  a file that it keeps open, see BatchLock
/// @return its id, below 0 if there is none
pid_t startProcess(const std::vector<std::string>& words, const std::string& folder, const std::string& log,
                   int keptOpen);

/// A child that ended, if one has; children of children that died count as ours.
std::optional<Ended> endedProcess();

/// Makes this process the parent of children whose parents die.
void adoptOrphans();

/// Waits until no child is left, or for a number of seconds.
void waitForAll(double seconds);

}  // namespace vdbsynth::cli::batch
