#include "tools/vdb_synth/doctor/library_versions.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/makers.h"

using namespace vdbsynth;
using namespace vdbsynth::cli;

TEST_CASE("libraryOfFile: a file's name is a library's name and version", "[tools]") {
    CHECK(libraryOfFile("libz.so.1.2.13").name == "libz");
    CHECK(libraryOfFile("libz.so.1.2.13").version == "1.2.13");
    CHECK(libraryOfFile("libOpenEXR-3_1.so.30.5.1").name == "libOpenEXR-3_1");
    CHECK(libraryOfFile("libm.so").version.empty());
    CHECK(libraryOfFile("odd").name == "odd");
    CHECK(libraryOfFile("libz.so.1.2.13").file == "libz.so.1.2.13");
}

TEST_CASE("loadedLibraries: the C library is among them, without its folder", "[tools]") {
    const std::vector<LoadedLibrary> all = loadedLibraries();
    CHECK(std::any_of(all.begin(), all.end(), [](const LoadedLibrary& l) { return l.name == "libc"; }));
    for (const LoadedLibrary& library : all) CHECK_FALSE(test::contains(library.file, "/"));
}

TEST_CASE("libraryVersions: OpenVDB is first, and what runs is what was built here", "[tools]") {
    const std::vector<LibraryVersion> all = libraryVersions();
    REQUIRE(all.size() > 5);
    CHECK(all.front().name == "OpenVDB");
    CHECK_FALSE(all.front().runs.empty());
    for (const LibraryVersion& library : all) {
        INFO(libraryLine(library));
        CHECK((!library.built.empty() || !library.runs.empty()));
        // The build folder links the very libraries that CMake found.
        CHECK_FALSE(library.differs);
    }
    const auto zlib =
        std::find_if(all.begin(), all.end(), [](const LibraryVersion& l) { return l.name == "zlib"; });
    REQUIRE(zlib != all.end());
    CHECK(zlib->runs == zlib->built);
    CHECK(zlib->file.compare(0, 8, "libz.so.") == 0);
}

TEST_CASE("libraryLine: says what runs, and what it was built with where that differs", "[tools]") {
    LibraryVersion library;
    library.name = "zlib";
    library.built = "1.2.13";
    CHECK(libraryLine(library) == "zlib 1.2.13");
    library.runs = "1.2.13";
    library.file = "libz.so.1.2.13";
    CHECK(libraryLine(library) == "zlib 1.2.13 (libz.so.1.2.13)");
    library.runs = "1.3";
    library.differs = true;
    CHECK(libraryLine(library) == "zlib 1.3 (built with 1.2.13; libz.so.1.2.13)");
}
