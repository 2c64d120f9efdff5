// Every reader on files cut short and with bytes changed: a result or an Error, nothing else. The fuzz
// targets (tests/fuzz) look deeper; this runs every time.
#include <catch2/catch.hpp>

#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/whole_files.h"

using namespace vdbsynth;

namespace {

void readAny(const std::string& path) {
    RunContext ctx;
    ctx.maxMemory = 500000000;
    if (isRasterPath(path))
        readRaster(path, ctx);
    else if (isPointPath(path) || holdsPoints(path))
        readPoints(path, ctx);
    else
        readMesh(path, ctx);
}

}  // namespace

TEST_CASE("readers: files cut short or with bytes changed give a result or an Error", "[io][property]") {
    const test::TemporaryFolder folder;
    std::size_t refusals = 0;
    for (const auto& [name, whole] : test::wholeFiles(folder)) {
        CAPTURE(name);
        REQUIRE(test::thrownBy([&, path = folder.write(name, whole)] { readAny(path); }).message == "");
        Random random(5, hash64(name.data(), name.size(), 0));
        for (int round = 0; round < 150; ++round) {
            std::string content = whole;
            if (round % 3 == 0) content.resize(std::size_t(random.uniform(0, double(content.size()))));
            for (int i = 0; i < round % 8 && !content.empty(); ++i)
                content[std::size_t(random.uniform(0, double(content.size())))] =
                    char(random.uniform(0, 256));
            const test::Thrown thrown =
                test::thrownBy([&, path = folder.write(name, content)] { readAny(path); });
            refusals += thrown.code >= 0;
            if (thrown.code >= 0) CHECK(test::contains(thrown.message, name));
        }
    }
    CHECK(refusals > 500);
}
