#include "libvdbsynth/io/png_file.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;

namespace {

Picture noise(int width, int height) {
    Picture picture{width, height, {}};
    Random random(3, 1);
    for (int i = 0; i < width * height * 3; ++i) picture.pixels.push_back(std::uint8_t(random.below(256)));
    return picture;
}

// True if a file's pixels are those of a picture, as another reader sees them.
bool holds(const std::string& path, const Picture& picture) {
    const Raster raster = readRaster(path);
    return raster.size == Index3{picture.width, picture.height, 1} && raster.channels == 3 &&
           raster.white == 255 && raster.rowsFromTop &&
           std::equal(raster.values.begin(), raster.values.end(), picture.pixels.begin(),
                      picture.pixels.end(),
                      [](float value, std::uint8_t pixel) { return value == float(pixel); });
}

}  // namespace

TEST_CASE("writePng, encodePng: a picture is read back as it was, rows from the top", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Picture flag{2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 7, 8, 9}};
    for (const Picture& picture : {flag, noise(1, 1), noise(37, 21), noise(1, 300), noise(300, 1)}) {
        writePng(folder.path("a.png"), picture);
        CHECK(holds(folder.path("a.png"), picture));
        CHECK(holds(folder.write("b.png", encodePng(picture)), picture));
    }
}

TEST_CASE("writePng, encodePng: the same picture gives the same bytes, without a time", "[io][property]") {
    const test::TemporaryFolder folder;
    const Picture picture = noise(40, 30);
    writePng(folder.path("a.png"), picture);
    writePng(folder.path("b.png"), picture);
    const std::string bytes = test::contentOf(folder.path("a.png"));
    CHECK(bytes == test::contentOf(folder.path("b.png")));
    const std::string encoded = encodePng(picture);
    CHECK(encoded == encodePng(picture));
    for (const std::string& content : {bytes, encoded}) {
        CHECK(content.substr(0, 8) == "\x89PNG\r\n\x1a\n");
        CHECK_FALSE(test::contains(content, "tIME"));
        CHECK_FALSE(test::contains(content, "tEXt"));
    }
    CHECK(encoded != encodePng(noise(40, 29)));
}

TEST_CASE("writePng: a path that cannot be written, and a picture of no pixels", "[io][error]") {
    const test::TemporaryFolder folder;
    const test::Thrown thrown = test::thrownBy([&] { writePng(folder.path("none/a.png"), noise(2, 2)); });
    CHECK(thrown.code == int(ErrorCode::Io));
    CHECK(test::contains(thrown.message, "none/a.png"));
    CHECK(test::thrownBy([&] { writePng(folder.path(""), noise(2, 2)); }).code == int(ErrorCode::Io));
    CHECK(test::thrownBy([&] { writePng(folder.path("a.png"), Picture()); }).code == int(ErrorCode::Io));
    CHECK(test::thrownBy([&] { encodePng(Picture()); }).code == int(ErrorCode::Memory));
}

TEST_CASE("readPng: turned upright as its EXIF chunk says, before the pixels or behind them",
          "[io][regression]") {
    const std::string plain = encodePng({2, 1, {10, 10, 10, 20, 20, 20}});
    // Length, name, EXIF with one entry, and a checksum: libpng leaves out a chunk whose checksum is wrong.
    test::TiffMaker maker;
    maker.bigEndian = true;
    const std::string exif = "MM" + maker.number(42, 2) + maker.number(8, 4) + maker.number(1, 2) +
                             maker.number(274, 2) + maker.number(3, 2) + maker.number(1, 4) +
                             maker.number(3, 2) + maker.number(0, 6);
    const std::string chunk = maker.number(exif.size(), 4) + "eXIf" + exif + maker.number(0, 4);
    for (const std::size_t at : {plain.find("IEND") - 4, plain.find("IDAT") - 4}) {
        test::Said said;
        const Raster raster = readPng("a.png", std::string(plain).insert(at, chunk), {}, said.ctx);
        CHECK(raster.values == std::vector<float>{20, 20, 20, 10, 10, 10});
        CHECK(said.all() == "a.png: turned upright as its EXIF orientation 3 says\n");
    }
    // A chunk that claims more than there is, and damaged EXIF.
    for (const std::string& odd :
         {maker.number(0xffffffff, 4) + "eXIf", maker.number(4, 4) + "eXIfMM" + maker.number(0, 6)})
        CHECK(readPng("a.png", plain + odd, {}, {}).values.front() == 10);
}
