#include "libvdbsynth/io/output_set.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("OutputSet: nothing appears before commit, everything after", "[io][property]") {
    const test::TemporaryFolder folder;
    folder.write("a.txt", "old");
    {
        OutputSet outputs;
        std::ofstream(outputs.add(folder.path("a.txt"))) << "new";
        std::ofstream(outputs.add(folder.path("b.txt"))) << "second";
        CHECK(test::contentOf(folder.path("a.txt")) == "old");
        outputs.commit();
    }
    CHECK(test::contentOf(folder.path("a.txt")) == "new");
    CHECK(test::contentOf(folder.path("b.txt")) == "second");
    CHECK(folder.fileCount() == 2);
}

TEST_CASE("OutputSet: without commit the old file stays and the temporary goes", "[io][property]") {
    const test::TemporaryFolder folder;
    folder.write("a.txt", "old");
    std::vector<std::string> told;
    {
        OutputSet outputs([&](const std::string& path) { told.push_back(path); });
        std::ofstream(outputs.add(folder.path("a.txt"))) << "half";
        CHECK(folder.fileCount() == 2);
    }
    CHECK(test::contentOf(folder.path("a.txt")) == "old");
    CHECK(folder.fileCount() == 1);
    REQUIRE(told.size() == 1);
    CHECK(test::contains(told[0], "/.a.txt."));
}

TEST_CASE("OutputSet: two at once may write one file, the last one stays", "[io][property]") {
    const test::TemporaryFolder folder;
    {
        OutputSet first, second;
        std::ofstream one(first.add(folder.path("a.txt"))), two(second.add(folder.path("a.txt")));
        one << "first" << std::flush;
        two << "second" << std::flush;
        first.commit();
        CHECK(test::contentOf(folder.path("a.txt")) == "first");
        second.commit();
    }
    CHECK(test::contentOf(folder.path("a.txt")) == "second");
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("OutputSet: stale temporaries of dead runs go, those of others stay", "[io][property]") {
    const test::TemporaryFolder folder;
    folder.write(".a.txt.999999999.tmp", "stale");
    folder.write(".a.txt.999999999-2.tmp", "stale");
    folder.write(".a.txt.1.tmp", "of a living process");
    folder.write(".b.txt.999999999.tmp", "another output's");
    OutputSet outputs;
    outputs.add(folder.path("a.txt"));
    CHECK(test::contentOf(folder.path(".a.txt.999999999.tmp")).empty());
    CHECK(test::contentOf(folder.path(".a.txt.999999999-2.tmp")).empty());
    CHECK(test::contentOf(folder.path(".a.txt.1.tmp")) == "of a living process");
    CHECK(test::contentOf(folder.path(".b.txt.999999999.tmp")) == "another output's");
}

TEST_CASE("OutputSet: a directory, a missing folder and the same name twice are refused", "[io][error]") {
    const test::TemporaryFolder folder;
    OutputSet outputs;
    CHECK(test::contains(test::thrownBy([&] { outputs.add("/tmp"); }).message, "is a directory"));
    CHECK(test::contains(test::thrownBy([&] { outputs.add(folder.path("no/a.txt")); }).message,
                         "does not exist"));
    CHECK(test::contains(test::thrownBy([&] { outputs.add("/proc/a.txt"); }).message,
                         "/proc/a.txt: cannot be written: /proc takes no new files"));
    outputs.add(folder.path("a.txt"));
    CHECK(test::thrownBy([&] { outputs.add(folder.path("a.txt")); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("OutputSet: a path that was reserved and never written keeps its file", "[io][property]") {
    const test::TemporaryFolder folder;
    folder.write("old.json", "kept");
    {
        OutputSet outputs;
        outputs.reserve(folder.path("old.json"));
        outputs.reserve(folder.path("new.json"));
        std::ofstream(outputs.add(folder.path("written.txt"))) << "written";
        outputs.commit();
        CHECK(folder.fileCount() == 2);
    }
    CHECK(test::contentOf(folder.path("old.json")) == "kept");
    CHECK(test::contentOf(folder.path("written.txt")) == "written");
    CHECK(folder.fileCount() == 2);
}

TEST_CASE("OutputSet: a reserved path whose folder is another one now is refused", "[io][error]") {
    const test::TemporaryFolder folder;
    const std::string share = folder.path("share"), away = folder.path("away");
    std::filesystem::create_directory(share);
    {
        OutputSet outputs;
        outputs.reserve(share + "/a.txt");
        outputs.reserve(share + "/b.txt");
        // A folder of the same name that holds what was reserved is the same folder, mounted again.
        std::filesystem::rename(share, away);
        std::filesystem::copy(away, share);
        std::ofstream(outputs.add(share + "/a.txt")) << "new";
        std::filesystem::remove_all(share);
        std::filesystem::create_directory(share);
        const auto error = test::thrownBy([&] { outputs.add(share + "/b.txt"); });
        CHECK(error.code == int(ErrorCode::Io));
        CHECK(test::contains(error.message, "b.txt: cannot be written: the folder is gone, or another"));
    }
    CHECK(std::filesystem::is_empty(share));
}
