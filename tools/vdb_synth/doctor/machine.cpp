#include "tools/vdb_synth/doctor/machine.h"

#include "libvdbsynth/base/machine_memory.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <langinfo.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace vdbsynth::cli {
namespace {

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t\""), end = text.find_last_not_of(" \t\"\n");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// The first value of each name in lines "NAME: VALUE" or "NAME=VALUE".
std::map<std::string, std::string> valuesIn(const std::string& path, char sign) {
    std::map<std::string, std::string> values;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        const std::size_t at = line.find(sign);
        if (at != std::string::npos)
            values.emplace(trimmed(line.substr(0, at)), trimmed(line.substr(at + 1)));
    }
    return values;
}

std::string valueOf(const std::map<std::string, std::string>& values, const std::string& name) {
    const auto value = values.find(name);
    return value == values.end() ? "" : value->second;
}

std::string firstLine(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

// Of one group: processors by version 2's "QUOTA PERIOD" or version 1's two files, 0 if it has no limit.
double shareOf(const std::string& folder) {
    std::istringstream both(firstLine(folder + "/cpu.max"));
    std::string quotaWord, periodWord;
    if (!(both >> quotaWord >> periodWord)) {
        quotaWord = firstLine(folder + "/cpu.cfs_quota_us");
        periodWord = firstLine(folder + "/cpu.cfs_period_us");
    }
    double quota = 0, period = 0;
    if (!parseReal(quotaWord, quota) || !parseReal(periodWord, period)) return 0;
    return quota > 0 && period > 0 ? quota / period : 0;
}

// The group of the process: "0::/GROUP" of version 2, "N:cpu,cpuacct:/GROUP" of version 1.
std::string groupOf(const std::string& root, bool second) {
    std::ifstream file(root + "/proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        const std::size_t names = line.find(':');
        const std::size_t group = names == std::string::npos ? names : line.find(':', names + 1);
        if (group == std::string::npos) continue;
        const std::string controllers = "," + line.substr(names + 1, group - names - 1) + ",";
        if (second ? controllers == ",," : controllers.find(",cpu,") != std::string::npos)
            return line.substr(group + 1);
    }
    return "/";
}

// The least share from the group up to the root of its hierarchy.
double smallestShare(const std::string& mount, std::string group) {
    double least = 0;
    for (;;) {
        const double share = shareOf(mount + group);
        if (share > 0 && (least == 0 || share < least)) least = share;
        const std::size_t slash = group.rfind('/');
        if (slash == std::string::npos) return least;
        group.resize(slash);
    }
}

std::uint64_t kilobytes(const std::string& text) {
    long long value = 0;
    return parseWhole(text.substr(0, text.find(' ')), value) && value > 0 ? std::uint64_t(value) * 1024 : 0;
}

}  // namespace

SystemFacts systemFacts(const std::string& root) {
    SystemFacts facts;
    facts.name = valueOf(valuesIn(root + "/etc/os-release", '='), "PRETTY_NAME");
    utsname names{};
    if (::uname(&names) == 0)
        facts.kernel = std::string(names.sysname) + " " + names.release + " " + names.machine;
    std::error_code ignored;
    for (const char* mark : {"/.dockerenv", "/run/.containerenv"})
        facts.container = facts.container || std::filesystem::exists(root + mark, ignored);
    return facts;
}

ProcessorFacts processorFacts(const std::string& root) {
    ProcessorFacts facts;
    const auto values = valuesIn(root + "/proc/cpuinfo", ':');
    facts.model = valueOf(values, "model name");
    const std::string flags = " " + valueOf(values, "flags") + " ";
    for (const auto& [flag, name] : {std::pair<const char*, const char*>{" sse4_2 ", "SSE4.2"},
                                     {" avx ", "AVX"},
                                     {" avx2 ", "AVX2"},
                                     {" avx512f ", "AVX-512"}})
        if (flags.find(flag) != std::string::npos)
            facts.instructions += (facts.instructions.empty() ? "" : " ") + std::string(name);
    facts.present = int(::sysconf(_SC_NPROCESSORS_ONLN));
    cpu_set_t set;
    CPU_ZERO(&set);
    facts.usable = ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : facts.present;
    const double second = smallestShare(root + "/sys/fs/cgroup", groupOf(root, true)),
                 first = smallestShare(root + "/sys/fs/cgroup/cpu", groupOf(root, false));
    facts.share = first > 0 && second > 0 ? std::min(first, second) : std::max(first, second);
    return facts;
}

MemoryFacts memoryFacts(const std::string& root) {
    MemoryFacts facts;
    const auto values = valuesIn(root + "/proc/meminfo", ':');
    facts.present = kilobytes(valueOf(values, "MemTotal"));
    facts.available = kilobytes(valueOf(values, "MemAvailable"));
    facts.swap = kilobytes(valueOf(values, "SwapTotal"));
    // Version 1 of control groups writes the largest whole number of pages for none.
    const std::uint64_t group = controlGroupLimit(root);
    if (group < std::uint64_t(1) << 62) facts.group = group;
    return facts;
}

std::vector<std::pair<std::string, std::uint64_t>> processLimits() {
    std::vector<std::pair<std::string, std::uint64_t>> limits;
    const auto add = [&limits](const char* name, auto resource) {
        rlimit limit{};
        if (::getrlimit(resource, &limit) != 0) return;
        limits.emplace_back(name, limit.rlim_cur == RLIM_INFINITY ? kNoLimit : std::uint64_t(limit.rlim_cur));
    };
    add("virtual memory", RLIMIT_AS);
    add("data", RLIMIT_DATA);
    add("file size", RLIMIT_FSIZE);
    add("stack", RLIMIT_STACK);
    add("open files", RLIMIT_NOFILE);
    add("processes", RLIMIT_NPROC);
    add("processor time", RLIMIT_CPU);
    return limits;
}

FolderFacts folderFacts(const std::string& path) {
    FolderFacts facts;
    std::error_code problem;
    facts.there = std::filesystem::is_directory(path, problem);
    const std::filesystem::space_info space = std::filesystem::space(path, problem);
    if (!problem) facts.free = std::uint64_t(space.available);
    facts.writable = facts.there && ::access(path.c_str(), W_OK) == 0;
    return facts;
}

LocaleFacts localeFacts() {
    LocaleFacts facts;
    for (const char* name : {"LC_ALL", "LC_NUMERIC", "LC_CTYPE", "LANG"})
        if (const char* value = std::getenv(name)) facts.variables.emplace_back(name, value);
    const locale_t environment = ::newlocale(LC_ALL_MASK, "", locale_t(0));
    facts.installed = environment != locale_t(0);
    if (!facts.installed) return facts;
    facts.decimalPoint = ::nl_langinfo_l(RADIXCHAR, environment);
    ::freelocale(environment);
    return facts;
}

TerminalFacts terminalFacts() {
    TerminalFacts facts;
    facts.input = ::isatty(0);
    facts.output = ::isatty(1);
    facts.error = ::isatty(2);
    winsize size{};
    for (const int stream : {2, 1, 0})
        if (facts.columns == 0 && ::ioctl(stream, TIOCGWINSZ, &size) == 0) {
            facts.columns = size.ws_col;
            facts.rows = size.ws_row;
        }
    const char* type = std::getenv("TERM");
    if (type) facts.type = type;
    return facts;
}

}  // namespace vdbsynth::cli
