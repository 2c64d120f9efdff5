#include "libvdbsynth/base/machine_memory.h"

#include <catch2/catch.hpp>

#include <limits>

#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

// A machine of files: its root is a temporary folder.
struct Machine {
    test::TemporaryFolder folder;
    void write(const std::string& path, const std::string& content) const {
        std::filesystem::create_directories(std::filesystem::path(folder.path(path)).parent_path());
        folder.write(path, content);
    }
    std::uint64_t limit() const { return controlGroupLimit(folder.path("")); }
};

const char* const kMountTwo = "29 22 0:27 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw\n";
const char* const kMountOne =
    "34 30 0:31 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
    "33 30 0:30 / /sys/fs/cgroup/cpuset rw - cgroup cgroup rw,cpuset\n";

}  // namespace

TEST_CASE("controlGroupLimit: the group of a job counts, not only the root", "[base][fast]") {
    const Machine machine;
    machine.write("proc/self/cgroup", "0::/slurm/job_7/step_0\n");
    machine.write("proc/self/mountinfo", kMountTwo);
    machine.write("sys/fs/cgroup/slurm/job_7/memory.max", "4000000000\n");
    machine.write("sys/fs/cgroup/slurm/job_7/step_0/memory.max", "max\n");
    CHECK(machine.limit() == 4000000000u);
    machine.write("sys/fs/cgroup/slurm/memory.max", "3000000000\n");
    CHECK(machine.limit() == 3000000000u);
    machine.write("sys/fs/cgroup/slurm/job_7/step_0/memory.max", "2000000000\n");
    CHECK(machine.limit() == 2000000000u);
    machine.write("sys/fs/cgroup/memory.max", "1000000000\n");
    CHECK(machine.limit() == 1000000000u);
    machine.write("sys/fs/cgroup/slurm/job_8/memory.max", "5\n");
    CHECK(machine.limit() == 1000000000u);
}

TEST_CASE("controlGroupLimit: version 1, and both versions at once", "[base][fast]") {
    const Machine machine;
    machine.write("proc/self/cgroup", "5:cpuset:/other\n4:cpu,memory:/pbs/17\n0::/system\n");
    machine.write("proc/self/mountinfo",
                  kMountOne + std::string("40 30 0:37 / /sys/fs/cgroup/unified rw - cgroup2 c rw\n"));
    machine.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    machine.write("sys/fs/cgroup/memory/pbs/17/memory.limit_in_bytes", "6000000000\n");
    machine.write("sys/fs/cgroup/memory/other/memory.limit_in_bytes", "5\n");
    CHECK(machine.limit() == 6000000000u);
    machine.write("sys/fs/cgroup/unified/system/memory.max", "5000000000\n");
    CHECK(machine.limit() == 5000000000u);
}

TEST_CASE("controlGroupLimit: a container mounts its own group as the root", "[base][fast]") {
    const Machine machine;
    machine.write("proc/self/cgroup", "0::/docker/abc/inner\n");
    machine.write("proc/self/mountinfo", "29 22 0:27 /docker/abc /sys/fs/cgroup ro - cgroup2 cgroup2 rw\n");
    machine.write("sys/fs/cgroup/memory.max", "800\n");
    CHECK(machine.limit() == 800);
    machine.write("sys/fs/cgroup/inner/memory.max", "700\n");
    CHECK(machine.limit() == 700);
    for (const char* elsewhere : {"0::/../../elsewhere\n", "0::/docker/abcd\n", "0::/\n"}) {
        machine.write("proc/self/cgroup", elsewhere);
        CHECK(machine.limit() == 800);
    }
}

TEST_CASE("controlGroupLimit: without files or with nonsense in them nothing is limited",
          "[base][degenerate]") {
    const Machine machine;
    CHECK(machine.limit() == kNone);
    machine.write("proc/self/cgroup", "hello\n\n0:\n0::\n");
    machine.write("proc/self/mountinfo", "1 2 - cgroup2\n- - - - - - - cgroup2\n");
    for (const char* text : {"max", "", "0", "-5", "12 apples", "99999999999999999999999"}) {
        machine.write("sys/fs/cgroup/memory.max", text);
        CHECK(machine.limit() == kNone);
    }
    machine.write("sys/fs/cgroup/memory.max", "44");
    CHECK(machine.limit() == 44);
}

TEST_CASE("presentMemory: this machine has some", "[base][fast]") {
    CHECK(presentMemory() > 10000000);
    CHECK(presentMemory() <= controlGroupLimit());
}
