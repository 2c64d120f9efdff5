#include "libvdbsynth/io/readers/whole_file.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

test::Thrown reading(const std::string& path) {
    return test::thrownBy([&] { readWholeFile(path); });
}
test::Thrown writing(const std::string& path, const std::string& content) {
    return test::thrownBy([&] { writeWholeFile(path, content); });
}

// Every byte, in a length that is no multiple of a buffer's.
std::string everyByte(std::size_t size) {
    std::string content;
    for (std::size_t i = 0; i < size; ++i) content += char(i * 7 % 256);
    return content;
}

}  // namespace

TEST_CASE("readWholeFile, writeWholeFile: every byte comes back, of short, long and empty files",
          "[io][property]") {
    const test::TemporaryFolder folder;
    for (const std::size_t size : {0, 1, 65535, 65536, 65537, 300001}) {
        const std::string content = everyByte(size);
        writeWholeFile(folder.path("a"), content);
        CHECK(std::filesystem::file_size(folder.path("a")) == size);
        CHECK(readWholeFile(folder.path("a")) == content);
    }
    writeWholeFile(folder.path("a"), "a longer one");
    writeWholeFile(folder.path("a"), "short");
    CHECK(readWholeFile(folder.path("a")) == "short");
}

TEST_CASE("readWholeFile: a gzip file is unpacked, whatever its name", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const std::string content = everyByte(100000);
    const std::string raw = folder.write("raw", content);
    REQUIRE(std::system(("gzip -k " + raw).c_str()) == 0);
    const std::string packed = test::contentOf(raw + ".gz");
    CHECK(readWholeFile(raw + ".gz") == content);
    CHECK(readWholeFile(folder.write("a.txt", packed)) == content);
    CHECK(readWholeFile(folder.write("not.gz", "plain")) == "plain");
    const test::Thrown cut = reading(folder.write("cut.gz", packed.substr(0, packed.size() / 2)));
    CHECK(cut.code == int(ErrorCode::BadData));
    CHECK(test::contains(cut.message, "cut.gz"));
    std::string bad = packed;
    bad[bad.size() / 2] ^= 0x55;
    CHECK(reading(folder.write("bad.gz", bad)).code == int(ErrorCode::BadData));
}

TEST_CASE("readWholeFile: what is missing, no file or not readable is named", "[io][error]") {
    const test::TemporaryFolder folder;
    const test::Thrown missing = reading(folder.path("none"));
    CHECK(missing.code == int(ErrorCode::Io));
    CHECK(test::contains(missing.message, folder.path("none")));
    const test::Thrown directory = reading(folder.path(""));
    CHECK(directory.code == int(ErrorCode::Io));
    CHECK(test::contains(directory.message, "directory"));
    CHECK(reading("").code == int(ErrorCode::Io));
    CHECK(reading(folder.write("file", "x") + "/below").code == int(ErrorCode::Io));
    // A pipe without a writer would wait for ever.
    REQUIRE(::mkfifo(folder.path("pipe").c_str(), 0600) == 0);
    CHECK(reading(folder.path("pipe")).code == int(ErrorCode::Io));
    if (::geteuid() == 0) return;  // who may read everything
    const std::string secret = folder.write("secret", "x");
    REQUIRE(::chmod(secret.c_str(), 0) == 0);
    CHECK(reading(secret).code == int(ErrorCode::Io));
}

TEST_CASE("writeWholeFile: what cannot be created or does not fit is named", "[io][error]") {
    const test::TemporaryFolder folder;
    const test::Thrown below = writing(folder.path("none/a"), "x");
    CHECK(below.code == int(ErrorCode::Io));
    CHECK(test::contains(below.message, "none/a"));
    CHECK(writing(folder.path(""), "x").code == int(ErrorCode::Io));
    if (!std::filesystem::exists("/dev/full")) return;  // a disk that is always full
    const test::Thrown full = writing("/dev/full", everyByte(100000));
    CHECK(full.code == int(ErrorCode::Io));
    CHECK(test::contains(full.message, "/dev/full"));
    CHECK(writing("/dev/full", "x").code == int(ErrorCode::Io));
}
