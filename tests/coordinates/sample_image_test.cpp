#include "libvdbsynth/coordinates/sample_image.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

SampleImage ramp(int width, int height, bool tileable) {
    SampleImage image{width, height, 2, tileable, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            image.values.push_back(float(x));
            image.values.push_back(float(10 * y));
        }
    return image;
}

}  // namespace

TEST_CASE("foldedTexel: beyond the border texels wrap or are mirrored") {
    CHECK(foldedTexel(-1, 4, true) == 3);
    CHECK(foldedTexel(4, 4, true) == 0);
    CHECK(foldedTexel(-9, 4, true) == 3);
    CHECK(foldedTexel(-1, 4, false) == 0);
    CHECK(foldedTexel(4, 4, false) == 3);
    CHECK(foldedTexel(7, 4, false) == 0);
    CHECK(foldedTexel(8, 4, false) == 0);
    CHECK(foldedTexel(0, 1, false) == 0);
    CHECK(foldedTexel(-5, 1, true) == 0);
}

TEST_CASE("readLinear, readCubic: exact at centres, linear ramps stay linear inside") {
    const SampleImage image = ramp(6, 5, false);
    float out[2];
    for (auto read : {readLinear, readCubic}) {
        read(image, {2.5f, 3.5f}, out);
        CHECK(out[0] == 2);
        CHECK(out[1] == 30);
        read(image, {2.75f, 2.0f}, out);
        CHECK(out[0] == Approx(2.25));
        CHECK(out[1] == Approx(15));
    }
    CHECK(nearestTexel(image, {2.99f, 4.01f})[0] == 2);
    CHECK(nearestTexel(image, {2.99f, 4.01f})[1] == 40);
}

TEST_CASE("readLinear: the border wraps where the sample is tileable, else it is mirrored") {
    float out[2];
    readLinear(ramp(4, 4, true), {0, 0.5f}, out);  // half way between the last column and the first
    CHECK(out[0] == Approx(1.5));
    readLinear(ramp(4, 4, false), {0, 0.5f}, out);
    CHECK(out[0] == 0);
    readLinear(ramp(4, 4, false), {-1, 0.5f}, out);  // between the mirrored columns 0 and 1
    CHECK(out[0] == Approx(0.5));
}

TEST_CASE("readCubic: stays within the four texels around") {
    SampleImage step{4, 1, 1, false, {0, 0, 1, 1}};
    float out = 0;
    for (float x = 0.5f; x < 3.5f; x += 0.05f) {
        readCubic(step, {x, 0.5f}, &out);
        CHECK(out >= 0);
        CHECK(out <= 1);
    }
    readCubic(step, {1.75f, 0.5f}, &out);  // steeper than linear: 0.203125 by the weights at t = 0.25
    CHECK(out == Approx(0.203125));
}

TEST_CASE("largestSquare: the shorter side without a mask, else the largest square of valid texels") {
    SampleImage image{6, 4, 1, false, std::vector<float>(24, 0)};
    CHECK(largestSquare(image) == 4);
    image.valid.assign(24, 1);
    CHECK(largestSquare(image) == 4);
    image.valid[1 * 6 + 2] = 0;  // leaves 3 columns of 4 rows at the right
    CHECK(largestSquare(image) == 3);
    image.valid.assign(24, 0);
    CHECK(largestSquare(image) == 0);
    image.valid[23] = 1;
    CHECK(largestSquare(image) == 1);
}
