#include "libvdbsynth/render/drawn_text.h"

#include <catch2/catch.hpp>

#include <set>

using namespace vdbsynth;

namespace {

Picture white(int width, int height, int channels = 3) {
    return {width, height,
            std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * std::size_t(channels),
                                      channels == 4 ? 0 : 255),
            channels};
}

std::size_t darkened(const Picture& picture) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3) count += picture.pixels[i] < 128;
    return count;
}

}  // namespace

TEST_CASE("drawText: every letter of ASCII leaves ink of its own, within its width and height",
          "[render][property]") {
    std::set<std::vector<std::uint8_t>> drawn;
    for (char c = '!'; c <= '~'; ++c) {
        INFO(c);
        Picture picture = white(60, 60);
        const std::string text(1, c);
        CHECK(hasLetters(text));
        drawText(picture, text, 10, 40, 24, {0, 0, 0});
        CHECK(darkened(picture) > 2);
        CHECK(drawn.insert(picture.pixels).second);
        const int width = textWidth(text, 24);
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 60; ++x)
                if (picture.pixels[std::size_t(y * 60 + x) * 3] < 128) {
                    CHECK((x >= 10 - 3 && x <= 10 + width + 3));
                    CHECK((y >= 40 - 24 * 11 / 9 - 2 && y <= 40 + 24 * 3 / 9 + 2));
                }
    }
}

TEST_CASE("drawText: a capital letter is as tall as the size", "[render][oracle]") {
    Picture picture = white(80, 80);
    drawText(picture, "I", 40, 60, 45, {0, 0, 0});
    int top = 80, bottom = 0;
    for (int y = 0; y < 80; ++y)
        if (picture.pixels[std::size_t(y * 80 + 40) * 3] < 128) {
            top = std::min(top, y);
            bottom = y;
        }
    CHECK(bottom - top == Approx(45 + 2 * 45 * 0.062).margin(2));
}

TEST_CASE("textWidth: the sum of letters and gaps, nothing of an empty text", "[render]") {
    CHECK(textWidth("", 20) == 0);
    CHECK(textWidth("AB", 90) == 60 + 24 + 60);
    CHECK(textWidth("a b", 20) > textWidth("ab", 20));
    // A character of several bytes is one box.
    CHECK(textWidth("\xc3\xa4", 90) == 50);
    CHECK_FALSE(hasLetters("\xc3\xa4"));
    CHECK(hasLetters("grid.vdb (2x)"));
}

TEST_CASE("drawText: nothing is written beyond the picture", "[render]") {
    Picture picture = white(16, 16);
    drawText(picture, "WWWW", -20, 30, 40, {0, 0, 0});
    CHECK(picture.pixels.size() == 16 * 16 * 3);
    blendRectangle(picture, -5, -5, 500, 3, {1, 2, 3}, 1);
    CHECK(picture.pixels[0] == 1);
    CHECK(picture.pixels[16 * 3 * 3] != 1);
}

TEST_CASE("blendPixel: a clear picture becomes opaque where something is drawn", "[render][oracle]") {
    Picture picture = white(2, 1, 4);
    blendPixel(picture, 0, 0, {200, 100, 50}, 0.5);
    CHECK(int(picture.pixels[3]) == 128);
    CHECK(int(picture.pixels[0]) == 200);
    blendPixel(picture, 0, 0, {0, 0, 0}, 1);
    CHECK(int(picture.pixels[3]) == 255);
    CHECK(int(picture.pixels[0]) == 0);
    CHECK(int(picture.pixels[7]) == 0);
}
