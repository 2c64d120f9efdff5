#include "libvdbsynth/io/readers/orientation.h"

#include <catch2/catch.hpp>

#include <numeric>

#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;

namespace {

// An EXIF block with one entry before the orientation.
std::string exif(int orientation, bool bigEndian, std::uint16_t type = 3) {
    test::TiffMaker maker;
    maker.bigEndian = bigEndian;
    std::string block = std::string(bigEndian ? "MM" : "II") + maker.number(42, 2) + maker.number(8, 4);
    block += maker.number(2, 2);
    block += maker.number(271, 2) + maker.number(2, 2) + maker.number(4, 4) + "abc" + std::string(1, '\0');
    std::string value = maker.number(std::uint64_t(orientation), type == 4 ? 4 : type == 3 ? 2 : 1);
    value.resize(4, '\0');
    return block + maker.number(274, 2) + maker.number(type, 2) + maker.number(1, 4) + value +
           maker.number(0, 4);
}

Raster ramp(int columns, int rows, int slices, int channels) {
    Raster raster;
    raster.size = {columns, rows, slices};
    raster.channels = channels;
    raster.values.resize(raster.sampleCount() * std::size_t(channels));
    std::iota(raster.values.begin(), raster.values.end(), 0.f);
    raster.spacing = {2, 3, 5};
    return raster;
}

}  // namespace

TEST_CASE("exifOrientation: either byte order, and the types that writers use", "[io][oracle]") {
    for (int orientation = 0; orientation <= 9; ++orientation)
        for (const bool bigEndian : {false, true})
            for (const std::uint16_t type : std::initializer_list<std::uint16_t>{1, 3, 4})
                CHECK(exifOrientation(exif(orientation, bigEndian, type)) == orientation);
    CHECK(exifOrientation(exif(70000, true, 4)) == 65535);
}

TEST_CASE("exifOrientation: a damaged block has none", "[io][error]") {
    const std::string whole = exif(6, true);
    for (std::size_t length = 0; length + 6 < whole.size(); ++length)
        CHECK(exifOrientation(whole.substr(0, length)) == 1);
    for (const char* text : {"", "MM", "II*", "XX*\0aaaaaaaaaaaa", "Exif"}) CHECK(exifOrientation(text) == 1);
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const int value : {0, 1, 127, 255}) {
            std::string block = whole;
            block[at] = char(value);
            const int read = exifOrientation(block);
            CHECK(read >= 0);
            CHECK(read <= 65535);
        }
    // A directory at the end of four bytes of address, and one that claims more entries than there are.
    std::string far = whole;
    far.replace(4, 4, "\xff\xff\xff\xff");
    CHECK(exifOrientation(far) == 1);
    CHECK(exifOrientation(std::string("MM\0\x2a\0\0\0\x08\xff\xff", 10)) == 1);
}

TEST_CASE("turnUpright: all eight by hand", "[io][oracle]") {
    // Stored 0 1 2 / 3 4 5.
    const std::vector<std::vector<float>> upright{{0, 1, 2, 3, 4, 5}, {2, 1, 0, 5, 4, 3}, {5, 4, 3, 2, 1, 0},
                                                  {3, 4, 5, 0, 1, 2}, {0, 3, 1, 4, 2, 5}, {3, 0, 4, 1, 5, 2},
                                                  {5, 2, 4, 1, 3, 0}, {2, 5, 1, 4, 0, 3}};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        test::Said said;
        Raster raster = ramp(3, 2, 1, 1);
        turnUpright("a", raster, orientation, "tag", said.ctx);
        CAPTURE(orientation);
        CHECK(raster.values == upright[std::size_t(orientation - 1)]);
        const bool turned = orientation > 4;
        CHECK(raster.size == (turned ? Index3{2, 3, 1} : Index3{3, 2, 1}));
        CHECK(raster.spacing.x == (turned ? 3 : 2));
        CHECK(raster.spacing.y == (turned ? 2 : 3));
        CHECK(raster.spacing.z == 5);
        CHECK(said.notes.size() == (orientation == 1 ? 0 : 1));
        if (orientation > 1)
            CHECK(said.notes[0] == "a: turned upright as its tag " + std::to_string(orientation) + " says");
    }
}

TEST_CASE("turnUpright: colours and slices go along, no orientation is left alone", "[io][property]") {
    // Undone by the opposite turn.
    const int inverse[9] = {0, 1, 2, 3, 4, 5, 8, 7, 6};
    for (int orientation = 2; orientation <= 8; ++orientation) {
        Raster raster = ramp(4, 3, 2, 3);
        turnUpright("a", raster, orientation, "tag", {});
        CHECK(raster.values != ramp(4, 3, 2, 3).values);
        turnUpright("a", raster, inverse[orientation], "tag", {});
        CHECK(raster.values == ramp(4, 3, 2, 3).values);
        CHECK(raster.size == Index3{4, 3, 2});
    }
    for (const int orientation : {0, 9, 65535, -1}) {
        test::Said said;
        Raster raster = ramp(3, 2, 1, 1);
        turnUpright("a", raster, orientation, "tag", said.ctx);
        CHECK(raster.values == ramp(3, 2, 1, 1).values);
        CHECK(said.notes.size() == (orientation == 0 ? 0 : 1));
    }
    Raster raster = ramp(10, 10, 1, 1);
    RunContext small;
    small.maxMemory = 799;
    CHECK(test::thrownBy([&] { turnUpright("a", raster, 3, "tag", small); }).code == int(ErrorCode::Memory));
}
