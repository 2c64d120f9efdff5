#include "libvdbsynth/vdb/read/metadata_format.h"

#include <catch2/catch.hpp>

#include <vector>

#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("unknownMetadata: nothing is said of a known format, and of files without one", "[vdb]") {
    CHECK(unknownMetadata({}).empty());
    CHECK(unknownMetadata({{"vdbsynth:version", "0.1.0"}}).empty());
    CHECK(unknownMetadata({{"vdbsynth:format", "1"}, {"vdbsynth:version", "9.9.9"}}).empty());
}

TEST_CASE("unknownMetadata: a newer format is said with the version that wrote it", "[vdb]") {
    CHECK(unknownMetadata({{"vdbsynth:format", "7"}, {"vdbsynth:version", "2.3.4"}}) ==
          "its metadata are of format 7, written by vdb_synth 2.3.4; this version knows format 1, so its "
          "domain "
          "and other entries may be misread: update vdb_synth");
    for (const char* format : {"0", "-1", "two", "1.5", "99999999999999999999"})
        CHECK(test::contains(unknownMetadata({{"vdbsynth:format", format}}), format));
}

TEST_CASE("readVdb: a file of a newer format is read, and one warning says so", "[vdb]") {
    const test::TemporaryFolder folder;
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(3.f);
    grid->setName("surface");
    std::vector<std::string> warnings;
    RunContext context;
    context.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Warning) warnings.push_back(text);
    };
    const std::string path = folder.path("a.vdb");
    writeVdb(path, {grid}, {{kMetadataFormatKey, "1"}});
    CHECK(readVdb(path, context).grids.size() == 1);
    CHECK(warnings.empty());
    writeVdb(path, {grid}, {{kMetadataFormatKey, "2"}, {"vdbsynth:version", "9.0.0"}});
    CHECK(readVdb(path, context).grids.size() == 1);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].compare(0, path.size() + 28, path + ": its metadata are of format") == 0);
}
