// NumPy arrays of three and four dimensions.
#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/raster_reading.h"

using namespace vdbsynth;

namespace {

using Floats = std::vector<float>;

using Read = test::RasterReading;

Read reading(const std::string& content, const std::string& name = "") {
    return test::readRasterBy(readNpy, "a.npy", content, name);
}

std::string counted(const std::string& shape, std::size_t count, bool fortran = false) {
    std::vector<std::uint8_t> values(count);
    std::iota(values.begin(), values.end(), std::uint8_t(0));
    return test::npy("|u1", shape, test::raw(values), fortran);
}

}  // namespace

TEST_CASE("readNpy: a volume in either order", "[io][oracle]") {
    const Raster c = reading(counted("(2, 3, 4)", 24)).raster;
    CHECK(c.size == Index3{4, 3, 2});
    CHECK(c.stack);
    CHECK(c.at(1, 2, 1) == 12 + 8 + 1);
    const Raster f = reading(counted("(2, 3, 4)", 24, true)).raster;
    CHECK(f.size == Index3{4, 3, 2});
    CHECK(f.at(1, 2, 1) == 1 + 2 * 2 + 6 * 1);
    CHECK(reading(counted("(2L, 3L, 4L)", 24)).raster.size == Index3{4, 3, 2});
}

TEST_CASE("readNpy: indices of length one are left out, a fourth one chooses among channels",
          "[io][oracle]") {
    Read read = reading(counted("(1, 1, 2, 3, 4)", 24));
    CHECK(read.raster.size == Index3{4, 3, 2});
    CHECK(read.said.empty());
    // Channels first.
    read = reading(counted("(2, 3, 4, 5)", 120));
    CHECK(read.raster.size == Index3{5, 4, 3});
    CHECK(read.raster.at(1, 2, 1) == 20 + 10 + 1);
    CHECK(test::contains(read.said, "the first is taken for channels"));
    CHECK(test::contains(read.said, "channel1 is read; `grid` chooses another"));
    CHECK(read.raster.arrays.size() == 2);
    CHECK(reading(counted("(2, 3, 4, 5)", 120), "channel2").raster.at(1, 2, 1) == 60 + 20 + 10 + 1);
    // Channels last.
    read = reading(counted("(5, 4, 3, 2)", 120), "channel2");
    CHECK(read.raster.size == Index3{3, 4, 5});
    CHECK(read.raster.at(2, 1, 3) == 3 * 24 + 6 + 4 + 1);
    CHECK(test::contains(read.said, "the last is taken for channels"));
    // The other order of memory.
    CHECK(reading(counted("(5, 4, 3, 2)", 120, true), "channel2").raster.at(2, 1, 3) == 3 + 5 + 40 + 60);
    CHECK(test::contains(reading(counted("(2, 3, 4, 5)", 120), "red").thrown.message, "`grid` red: not in"));
}

TEST_CASE("readNpy: bytes whose last dimension is three or four are a picture, which is said",
          "[io][oracle]") {
    Read read = reading(counted("(8, 9, 3)", 216));
    CHECK(read.raster.size == Index3{9, 8, 1});
    CHECK(read.raster.channels == 3);
    CHECK(read.raster.rowsFromTop);
    CHECK_FALSE(read.raster.stack);
    CHECK(read.raster.white == 255);
    CHECK(read.raster.values[27 + 4] == 31);
    CHECK(test::contains(read.said, "a picture of 8 rows and 9 columns"));
    read = reading(counted("(8, 8, 4)", 256));
    CHECK(read.raster.values.size() == 8 * 8 * 3);
    CHECK(read.raster.values[3] == 4);
    const std::string truths = test::npy("|b1", "(8, 8, 3)", std::string(192, '\1'));
    CHECK(reading(truths).raster.stack);
    CHECK(reading(test::npy("<f4", "(8, 8, 3)", std::string(768, '\0'))).raster.stack);
}

TEST_CASE("readNpy: what is not read is refused by name, without bytes of the file", "[io][error]") {
    const auto refused = [](const std::string& content, const std::string& words) {
        const test::Thrown thrown = reading(content).thrown;
        CAPTURE(words, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, words));
        for (const char c : thrown.message) CHECK((c >= ' ' && c <= '~'));
    };
    refused(counted("(2, 3, 2, 3, 4)", 144), "of 5 dimensions");
    refused(counted("()", 1), "of 0 dimensions");
    refused(counted("(4,)", 4), "of 1 dimensions");
    refused(counted("(0, 3, 4)", 0), "empty");
    refused(counted("(2, 3, 5)", 24), "truncated; its header claims 2 x 3 x 5");
    refused(counted("(1099511627776, 1099511627776, 1099511627776, 2)", 24), "truncated");
    refused(counted("(200000, 1, 2, 2)", 10), "truncated");
    std::string ones = "(2, 2";
    for (int i = 0; i < 70; ++i) ones += ",1";
    const std::string padded = test::npy("|u1", "(1, 1)", "abcd");
    std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': " + ones + "), }";
    std::string content = padded.substr(0, 8);
    test::append(content, std::uint16_t(header.size()));
    refused(content + header + "abcd", "over 64 dimensions");
    refused(test::npy("<c16", "(1, 1)", std::string(16, '\0')), "type 'c16'");
    refused(test::npy("|O\x01", "(1, 1)", std::string(16, '\0')), "type 'O?'");
    std::string records = test::npy("<f4", "(1, 1)", "abcd");
    records.replace(records.find("'<f4'"), 5, "[('x'");
    refused(records, "structured array");
}
