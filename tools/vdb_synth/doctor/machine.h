#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli {

// What a bug report has to say of the machine. Nothing here names the user, the host, or a folder of either.
// `root` is a folder that contains proc, sys and etc; empty for the machine's own.

/// 2^64 - 1: no limit.
inline constexpr std::uint64_t kNoLimit = ~std::uint64_t(0);

struct SystemFacts {
    std::string name;        ///< "Debian GNU/Linux 12 (bookworm)"; empty if unknown
    std::string kernel;      ///< "Linux 6.1.0 x86_64"
    bool container = false;  ///< Docker's or Podman's mark is there
};
SystemFacts systemFacts(const std::string& root = "");

struct ProcessorFacts {
    std::string model;         ///< empty if unknown
    int present = 0;           ///< logical processors that are on
    int usable = 0;            ///< of which this process may use (taskset, job schedulers)
    double share = 0;          ///< processors that its control groups allow at once; 0: no limit
    std::string instructions;  ///< of those that matter, what the processor has: "SSE4.2 AVX AVX2"
};
ProcessorFacts processorFacts(const std::string& root = "");

struct MemoryFacts {
    std::uint64_t present = 0, available = 0, swap = 0;  ///< [bytes]
    std::uint64_t group = kNoLimit;                      ///< limit of its control groups [bytes]
};
MemoryFacts memoryFacts(const std::string& root = "");

/// Limits of this process (ulimit), by the names that `ulimit -a` gives them. [bytes, counts, seconds]
std::vector<std::pair<std::string, std::uint64_t>> processLimits();

struct FolderFacts {
    std::uint64_t free = 0;  ///< [bytes] for this user
    bool there = false, writable = false;
};
FolderFacts folderFacts(const std::string& path);

struct LocaleFacts {
    std::vector<std::pair<std::string, std::string>>
        variables;                   ///< LC_ALL, LC_NUMERIC, LC_CTYPE, LANG if set
    bool installed = true;           ///< false: they name a locale that is not here
    std::string decimalPoint = ".";  ///< of that locale
};
LocaleFacts localeFacts();

struct TerminalFacts {
    bool input = false, output = false, error = false;  ///< standard streams that are a terminal
    int columns = 0, rows = 0;                          ///< 0: unknown
    std::string type;                                   ///< TERM
};
TerminalFacts terminalFacts();

}  // namespace vdbsynth::cli
