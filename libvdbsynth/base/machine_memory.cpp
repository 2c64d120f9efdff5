#include "libvdbsynth/base/machine_memory.h"

#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <vector>

#include <unistd.h>

namespace vdbsynth {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The process's group in one hierarchy, and the mount point of that hierarchy.
struct Hierarchy {
    std::string group;            // from the hierarchy's root, "/" for that itself
    std::string mount, mounted;   // the folder, and the group mounted there
    const char* limit = nullptr;  // the file with a group's limit
};

std::vector<std::string> split(const std::string& text, char by) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(by, at), text.size());
        parts.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

bool listed(const std::string& list, const std::string& name) {
    const std::vector<std::string> parts = split(list, ',');
    return std::find(parts.begin(), parts.end(), name) != parts.end();
}

// Lines of /proc/self/cgroup are NUMBER:CONTROLLERS:GROUP, version 2's has no controllers.
void findGroups(const std::string& root, Hierarchy& first, Hierarchy& second) {
    std::ifstream file(root + "/proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        const std::size_t names = line.find(':'),
                          group = names == std::string::npos ? names : line.find(':', names + 1);
        if (group == std::string::npos) continue;
        const std::string controllers = line.substr(names + 1, group - names - 1);
        if (controllers.empty())
            second.group = line.substr(group + 1);
        else if (listed(controllers, "memory"))
            first.group = line.substr(group + 1);
    }
}

// Lines of /proc/self/mountinfo: ID PARENT DEVICE ROOT FOLDER OPTIONS TAG... - KIND SOURCE OPTIONS.
void findMounts(const std::string& root, Hierarchy& first, Hierarchy& second) {
    std::ifstream file(root + "/proc/self/mountinfo");
    for (std::string line; std::getline(file, line);) {
        const std::vector<std::string> words = split(line, ' ');
        const std::size_t dash = std::size_t(std::find(words.begin(), words.end(), "-") - words.begin());
        if (words.size() < 6 || dash + 3 >= words.size()) continue;
        const bool isFirst = words[dash + 1] == "cgroup" && listed(words[dash + 3], "memory");
        if (!isFirst && words[dash + 1] != "cgroup2") continue;
        Hierarchy& hierarchy = isFirst ? first : second;
        hierarchy.mounted = words[3];
        hierarchy.mount = words[4];
    }
}

std::uint64_t limitIn(const std::string& path) {
    std::ifstream file(path);
    std::string word;
    long long limit = 0;
    return std::getline(file, word) && parseWhole(word, limit) && limit > 0 ? std::uint64_t(limit)
                                                                            : kUnlimited;
}

// From the group up to the mounted one; a group outside of it (a container that sees its host's names) counts
// as the mounted one.
std::uint64_t smallestLimit(const std::string& root, const Hierarchy& hierarchy) {
    std::string below = hierarchy.group + '/';
    const std::string mounted = hierarchy.mounted.size() > 1 ? hierarchy.mounted + '/' : "/";
    below = below.compare(0, mounted.size(), mounted) == 0 ? below.substr(mounted.size() - 1) : "/";
    below.pop_back();
    std::uint64_t limit = kUnlimited;
    for (;;) {
        limit = std::min(limit, limitIn(root + hierarchy.mount + below + '/' + hierarchy.limit));
        const std::size_t slash = below.rfind('/');
        if (slash == std::string::npos) return limit;
        below.resize(slash);
    }
}

}  // namespace

std::uint64_t controlGroupLimit(const std::string& root) {
    Hierarchy first{"", "/sys/fs/cgroup/memory", "/", "memory.limit_in_bytes"},
        second{"", "/sys/fs/cgroup", "/", "memory.max"};
    findGroups(root, first, second);
    findMounts(root, first, second);
    return std::min(smallestLimit(root, first), smallestLimit(root, second));
}

std::uint64_t presentMemory() {
    const std::uint64_t pages = std::uint64_t(::sysconf(_SC_PHYS_PAGES));
    return std::min(pages * std::uint64_t(::sysconf(_SC_PAGE_SIZE)), controlGroupLimit());
}

}  // namespace vdbsynth
