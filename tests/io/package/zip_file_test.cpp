#include "libvdbsynth/io/package/zip_file.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <cstdlib>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

std::string smallArchive() {
    ZipWriter zip;
    zip.add("a.txt", "hello");
    zip.add("b/c.txt", std::string(1000, 'x'));
    return zip.finish();
}

// The message with which an archive, or the reading of all its entries, is refused; empty if it is not.
std::string refusal(const std::string& bytes, const RunContext& ctx = {}) {
    return test::thrownBy([&] {
               const std::string path = "a.zip";
               const ZipFile zip(path, bytes);
               for (const ZipFile::Entry& entry : zip.entries()) zip.read(entry, ctx);
           })
        .message;
}

// Bytes overwritten from a place on.
std::string changed(std::string bytes, std::size_t at, const std::string& by) {
    return bytes.replace(at, by.size(), by);
}

}  // namespace

TEST_CASE("ZipFile: gives back what ZipWriter packed, by names in any case", "[io][property]") {
    const std::string path = "a.zip", bytes = smallArchive();
    const ZipFile zip(path, bytes);
    REQUIRE(zip.entries().size() == 2);
    REQUIRE(zip.find("B/C.TXT"));
    CHECK(zip.read(*zip.find("B/C.TXT"), {}) == std::string(1000, 'x'));
    CHECK(zip.read(zip.entries()[0], {}) == "hello");
    CHECK_FALSE(zip.find("c.txt"));
    CHECK(ZipFile(path, ZipWriter().finish()).entries().empty());
}

TEST_CASE("ZipFile: reads what Python writes, stored, deflated, 64 bit and with a comment", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("p.zip");
    const std::string script =
        "import zipfile\n"
        "with zipfile.ZipFile('" +
        path +
        "', 'w') as z:\n"
        "  z.writestr('stored', 'abc'); z.writestr('/packed', 'xyz' * 5000, zipfile.ZIP_DEFLATED)\n"
        "  with z.open('wide', 'w', force_zip64=True) as f: f.write(b'wide')\n"
        "  z.comment = b'PK comment'\n";
    REQUIRE(std::system(("python3 -c \"" + script + "\"").c_str()) == 0);
    const std::string bytes = test::contentOf(path);
    const ZipFile zip(path, bytes);
    REQUIRE(zip.find("stored"));
    REQUIRE(zip.find("packed"));
    REQUIRE(zip.find("wide"));
    CHECK(zip.read(*zip.find("stored"), {}) == "abc");
    CHECK(zip.read(*zip.find("packed"), {}).size() == 15000);
    CHECK(zip.read(*zip.find("wide"), {}) == "wide");
}

TEST_CASE("ZipWriter: Python finds no fault, pieces join, any number of threads gives the same bytes",
          "[io][oracle][determinism]") {
    const test::TemporaryFolder folder;
    const auto make = [](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        return withThreads(ctx, [] {
            ZipWriter zip;
            zip.add("many", 9, [](std::size_t i) { return std::string(1000 * i, char('a' + i)); });
            return zip.finish();
        });
    };
    const std::string bytes = make(1);
    CHECK(make(4) == bytes);
    folder.write("w.zip", bytes);
    CHECK(std::system(("python3 -c \"import sys, zipfile; z = zipfile.ZipFile('" + folder.path("w.zip") +
                       "'); sys.exit(z.testzip() is not None or len(z.read('many')) != 36000)\"")
                          .c_str()) == 0);
    const std::string path = "w.zip";
    const ZipFile zip(path, bytes);
    CHECK(zip.read(zip.entries()[0], {}).substr(998, 4) == "bbcc");
}

TEST_CASE("ZipFile: what is no archive, cut short or claims too much is refused", "[io][error]") {
    const std::string whole = smallArchive();
    const std::size_t end = whole.size() - 22, first = whole.find("PK\x01\x02");
    CHECK(test::contains(refusal("hello"), "is no ZIP archive"));
    CHECK(test::contains(refusal(""), "is no ZIP archive"));
    CHECK(test::contains(refusal(whole.substr(0, end)), "truncated"));
    CHECK(test::contains(refusal(changed(whole, end + 4, "\x01")), "several"));
    CHECK(test::contains(refusal(changed(whole, end + 10, "\xff\xff")), "more entries than"));
    CHECK(test::contains(refusal(changed(whole, end + 16, "\xff\xff\xff\x7f")), "more entries than"));
    CHECK(test::contains(refusal(changed(whole, first, "PX")), "directory is corrupt"));
    CHECK(test::contains(refusal(changed(whole, first + 28, "\xff\xff")), "directory is corrupt"));
    CHECK(test::contains(refusal(changed(whole, first + 42, "\xff\xff\xff\x7f")), "behind the file's end"));
    CHECK(test::contains(refusal(changed(whole, first + 42, "\x02")), "its place"));
    CHECK(test::contains(refusal(changed(whole, first + 16, "abcd")), "its checksum is wrong"));
    CHECK(test::contains(refusal(changed(whole, first + 8, "\x01")), "encrypted"));
    CHECK(test::contains(refusal(changed(whole, first + 10, "\x0e")), "method 14"));
    CHECK(test::contains(refusal(changed(whole, first + 24, "\xff\xff\xff\x7f")), "truncated"));
    CHECK(test::contains(refusal(changed(whole, first + 24, "\x07")), "corrupt"));
    CHECK(test::contains(refusal(changed(whole, first + 20, "\xff\xff\xff\x7f")), "overlap"));
    for (std::size_t length = 0; length < whole.size(); ++length)
        CHECK_FALSE(refusal(whole.substr(0, length)).empty());
}

TEST_CASE("ZipFile: entries of one name, and a bomb, are refused before memory is taken", "[io][error]") {
    ZipWriter zip;
    zip.add("a", "1");
    zip.add("A", "2");
    CHECK(test::contains(refusal(zip.finish()), "two entries"));
    zip.add("bomb", std::string(50000000, '\0'));
    RunContext ctx;
    ctx.maxMemory = 1000000;
    const std::string bytes = zip.finish();
    CHECK(bytes.size() < 400000);
    CHECK(test::contains(refusal(bytes, ctx), "a.zip (bomb) needs"));
    CHECK(refusal(bytes).empty());
    // The same bytes under many names.
    std::string many = bytes;
    const std::size_t first = bytes.find("PK\x01\x02", bytes.size() - 200), end = bytes.size() - 22;
    std::string directory;
    for (char name = 'a'; name < 'z'; ++name)
        directory += changed(bytes.substr(first, end - first), 46, std::string(1, name));
    many = bytes.substr(0, first) + directory + changed(changed(bytes.substr(end), 8, "\x19"), 10, "\x19");
    CHECK(test::contains(refusal(many), "overlap"));
}
