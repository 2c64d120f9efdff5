#include "libvdbsynth/render/picture_row.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

Picture filled(int width, int height, std::uint8_t value, int channels = 3) {
    return {
        width, height,
        std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * std::size_t(channels), value),
        channels};
}

}  // namespace

TEST_CASE("pictureRow: every picture in its place", "[render][oracle]") {
    const Picture row = pictureRow({filled(3, 2, 10), filled(1, 2, 20), filled(2, 2, 30)});
    CHECK(row.width == 6);
    CHECK(row.height == 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 6; ++x)
            CHECK(int(row.pixels[std::size_t(y * 6 + x) * 3 + 1]) == (x < 3 ? 10 : x < 4 ? 20 : 30));
}

TEST_CASE("pictureRow: what cannot be a row is refused", "[render][error]") {
    CHECK(test::thrownBy([] { pictureRow({}); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] {
              pictureRow({filled(1, 2, 0), filled(1, 3, 0)});
          }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] {
              pictureRow({filled(1, 2, 0), filled(1, 2, 0, 4)});
          }).code == int(ErrorCode::InvalidOption));
    CHECK(test::contains(
        test::thrownBy([] { pictureRow(std::vector<Picture>(9, filled(8000, 1, 0))); }).message, "`size`"));
}

TEST_CASE("labelPicture: dark on light, light on dark, below only", "[render]") {
    for (const std::uint8_t ground : {std::uint8_t(240), std::uint8_t(10)}) {
        Picture picture = filled(200, 100, ground);
        labelPicture(picture, "grid.vdb");
        std::size_t changed = 0;
        for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
            const std::uint8_t value = picture.pixels[i];
            if (value == ground) continue;
            ++changed;
            CHECK((ground > 128) == (value < ground));
            CHECK(double(i / 3 / 200) >= 100 * (1 - kLabelShare) - 1);
        }
        CHECK(changed > 60);
    }
}

TEST_CASE("labelPicture: a label that is too wide is shortened in its middle", "[render]") {
    Picture picture = filled(120, 200, 255), other = picture;
    labelPicture(picture, "a-very-long-name-of-a-file-that-nobody-reads.vdb");
    std::size_t changed = 0;
    for (std::size_t y = 0; y < 200; ++y) {
        CHECK(picture.pixels[y * 120 * 3] == 255);  // the first column stays free
        for (std::size_t x = 0; x < 120; ++x) changed += picture.pixels[(y * 120 + x) * 3] != 255;
    }
    CHECK(changed > 60);
}

TEST_CASE("pictureRows: row below row, what is left is blank", "[render][oracle]") {
    const Picture all = pictureRows({filled(3, 2, 10), filled(3, 2, 20), filled(3, 2, 30)}, 2);
    CHECK(all.width == 6);
    CHECK(all.height == 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x)
            CHECK(int(all.pixels[std::size_t(y * 6 + x) * 3]) == (y < 2   ? (x < 3 ? 10 : 20)
                                                                  : x < 3 ? 30
                                                                          : 10));
    CHECK(pictureRows({filled(3, 2, 10)}, 5).width == 3);
    CHECK(test::contains(test::thrownBy([] { pictureRows({filled(1, 1, 0)}, 0); }).message, "`columns`"));
}
