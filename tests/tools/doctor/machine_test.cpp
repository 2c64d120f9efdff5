#include "tools/vdb_synth/doctor/machine.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>

#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

namespace {

// A machine of files: its root is a temporary folder.
struct Machine {
    test::TemporaryFolder folder;
    void write(const std::string& path, const std::string& content) const {
        std::filesystem::create_directories(std::filesystem::path(folder.path(path)).parent_path());
        folder.write(path, content);
    }
    std::string root() const {
        std::string path = folder.path("");
        path.pop_back();  // the slash
        return path;
    }
};

}  // namespace

TEST_CASE("systemFacts: the name of the system, and a container's mark", "[tools]") {
    const Machine machine;
    CHECK(systemFacts(machine.root()).name.empty());
    CHECK_FALSE(systemFacts(machine.root()).container);
    machine.write("etc/os-release", "ID=toy\nPRETTY_NAME=\"Toy OS 3\"\n");
    machine.write(".dockerenv", "");
    CHECK(systemFacts(machine.root()).name == "Toy OS 3");
    CHECK(systemFacts(machine.root()).container);
    CHECK(test::contains(systemFacts(machine.root()).kernel, "Linux"));
}

TEST_CASE("processorFacts: model, instructions and processors", "[tools]") {
    const Machine machine;
    machine.write("proc/cpuinfo", "processor\t: 0\nmodel name\t: Toy 9\nflags\t\t: fpu avx avx2 sse4_2\n\n");
    const ProcessorFacts facts = processorFacts(machine.root());
    CHECK(facts.model == "Toy 9");
    CHECK(facts.instructions == "SSE4.2 AVX AVX2");
    CHECK(facts.usable >= 1);
    CHECK(facts.present >= facts.usable);
    CHECK(facts.share == 0);
}

TEST_CASE("processorFacts: the least share of all control groups counts", "[tools]") {
    const Machine machine;
    machine.write("proc/self/cgroup", "0::/pod/box\n");
    machine.write("sys/fs/cgroup/pod/cpu.max", "300000 100000\n");
    machine.write("sys/fs/cgroup/pod/box/cpu.max", "max 100000\n");
    CHECK(processorFacts(machine.root()).share == 3);
    machine.write("sys/fs/cgroup/pod/box/cpu.max", "150000 100000\n");
    CHECK(processorFacts(machine.root()).share == 1.5);
}

TEST_CASE("processorFacts: control groups of version 1", "[tools]") {
    const Machine machine;
    machine.write("proc/self/cgroup", "4:cpu,cpuacct:/box\n2:memory:/other\n");
    machine.write("sys/fs/cgroup/cpu/box/cpu.cfs_quota_us", "200000\n");
    machine.write("sys/fs/cgroup/cpu/box/cpu.cfs_period_us", "100000\n");
    CHECK(processorFacts(machine.root()).share == 2);
    machine.write("sys/fs/cgroup/cpu/box/cpu.cfs_quota_us", "-1\n");
    CHECK(processorFacts(machine.root()).share == 0);
}

TEST_CASE("memoryFacts: in bytes, with the limit of the control group", "[tools]") {
    const Machine machine;
    machine.write("proc/meminfo",
                  "MemTotal:       1000 kB\nMemAvailable:    500 kB\nSwapTotal:         0 kB\n");
    CHECK(memoryFacts(machine.root()).present == 1024000);
    CHECK(memoryFacts(machine.root()).available == 512000);
    CHECK(memoryFacts(machine.root()).swap == 0);
    CHECK(memoryFacts(machine.root()).group == kNoLimit);
    machine.write("proc/self/cgroup", "0::/\n");
    machine.write("sys/fs/cgroup/memory.max", "70000\n");
    CHECK(memoryFacts(machine.root()).group == 70000);
    machine.write("sys/fs/cgroup/memory.max", "9223372036854771712\n");
    CHECK(memoryFacts(machine.root()).group == kNoLimit);
}

TEST_CASE("processLimits: the names of ulimit", "[tools]") {
    const auto limits = processLimits();
    for (const char* name : {"virtual memory", "data", "file size", "stack", "open files"})
        CHECK(std::count_if(limits.begin(), limits.end(),
                            [&](const auto& limit) { return limit.first == name; }) == 1);
}

TEST_CASE("folderFacts: a folder, none, and no folder", "[tools]") {
    const test::TemporaryFolder folder;
    CHECK(folderFacts(folder.path("")).there);
    CHECK(folderFacts(folder.path("")).writable);
    CHECK(folderFacts(folder.path("")).free > 0);
    CHECK_FALSE(folderFacts(folder.path("none")).there);
    folder.write("file", "");
    CHECK_FALSE(folderFacts(folder.path("file")).there);
}

TEST_CASE("localeFacts: a locale that is not installed is said", "[tools]") {
    const char* before = std::getenv("LC_ALL");
    const std::string kept = before ? before : "";
    ::setenv("LC_ALL", "C", 1);
    CHECK(localeFacts().installed);
    CHECK(localeFacts().decimalPoint == ".");
    ::setenv("LC_ALL", "xx_XX.nowhere", 1);
    CHECK_FALSE(localeFacts().installed);
    CHECK(localeFacts().variables.front() == std::pair<std::string, std::string>("LC_ALL", "xx_XX.nowhere"));
    if (before)
        ::setenv("LC_ALL", kept.c_str(), 1);
    else
        ::unsetenv("LC_ALL");
}

TEST_CASE("terminalFacts: the type that the environment names", "[tools]") {
    const char* before = std::getenv("TERM");
    const std::string kept = before ? before : "";
    ::setenv("TERM", "toy", 1);
    CHECK(terminalFacts().type == "toy");
    if (before)
        ::setenv("TERM", kept.c_str(), 1);
    else
        ::unsetenv("TERM");
}
