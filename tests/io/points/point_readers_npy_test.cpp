#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/point_contents.h"
#include "tests/support/raster_files.h"

using namespace vdbsynth;

namespace {

// Row i holds 3 i, 3 i + 1, 3 i + 2; with an offset that floats cannot hold.
template <typename T>
std::string rows(int count, int columns, double offset, bool byColumns = false) {
    std::string bytes;
    for (int i = 0; i < count * columns; ++i) {
        const int row = byColumns ? i % count : i / columns, column = byColumns ? i / count : i % columns;
        test::append(bytes, T(offset + row * columns + column));
    }
    return bytes;
}

test::PointsRead npyOf(const std::string& content) {
    return test::readBy(readNpyPoints, content, "a.npy");
}

}  // namespace

TEST_CASE("readNpyPoints: N x 3 and 3 x N, both orders, doubles and whole numbers", "[io][hand]") {
    const double far = 5648340.0009765625;
    for (const std::string& content : {test::npy("<f8", "(40, 3)", rows<double>(40, 3, far)),
                                       test::npy("<f8", "(40, 3)", rows<double>(40, 3, far, true), true),
                                       test::npy("<f8", "(3, 40)", rows<double>(40, 3, far, true)),
                                       test::npy("<f8", "(3, 40)", rows<double>(40, 3, far), true)}) {
        REQUIRE(npyHoldsPoints("a.npy", content));
        const test::PointsRead read = npyOf(content);
        REQUIRE(read.cloud.points.size() == 40);
        CHECK(test::equal(read.cloud.points[39], {far + 117, far + 118, far + 119}));
        CHECK(test::contains(read.said, "40 points"));
    }
    const test::PointsRead whole = npyOf(test::npy("<i8", "(40, 3)", rows<std::int64_t>(40, 3, 123456789)));
    CHECK(whole.cloud.points[1].x == 123456792);
    std::string swapped;
    for (int i = 0; i < 120; ++i) swapped += std::string("\x3f\x80\0\0", 4);  // 1
    CHECK(test::equal(npyOf(test::npy(">f4", "(40, 3)", swapped)).cloud.points[39], {1, 1, 1}));
}

TEST_CASE("readNpyPoints: six columns are normals or colours", "[io][hand]") {
    std::string normals;
    for (int i = 0; i < 60; ++i)
        for (const float value : {float(i), 0.f, 0.f, 0.f, 0.f, -1.f}) test::append(normals, value);
    CHECK(npyOf(test::npy("<f4", "(60, 6)", normals)).cloud.normals.size() == 60);
}

TEST_CASE("npyHoldsPoints: pictures stay pictures", "[io][hand]") {
    const auto holds = [](const char* type, const char* shape) {
        return npyHoldsPoints("a.npy", test::npy(type, shape, ""));
    };
    CHECK(holds("<f4", "(1000, 9)"));
    CHECK_FALSE(holds("<f4", "(1000, 10)"));
    CHECK_FALSE(holds("<f4", "(3, 3)"));
    CHECK_FALSE(holds("<f4", "(29, 3)"));
    CHECK_FALSE(holds("<f4", "(2, 1000)"));
    CHECK_FALSE(holds("|u1", "(1000, 3)"));
    CHECK_FALSE(holds("|b1", "(1000, 3)"));
    CHECK_FALSE(holds("<u2", "(1000, 4)"));
    CHECK(holds("<i4", "(1000, 3)"));
    CHECK_FALSE(holds("<f4", "(1000, 3, 1)"));
    CHECK_FALSE(holds("<f4", "(1000,)"));
}

TEST_CASE("readNpyPoints: truncated, and no points", "[io][error]") {
    for (const std::string& content :
         {test::npy("<f8", "(40, 3)", std::string(959, '\0')), test::npy("<f4", "(9999999999, 3)", "0123"),
          test::npy("<f4", "(3, 3)", std::string(36, '\0')), std::string("\x93NUMPY"),
          std::string("nonsense"), test::npy("<f4", "(1099511627776, 3)", "0123")}) {
        const test::Thrown thrown = test::thrownBy([&] { readNpyPoints("a.npy", content); });
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.npy: "));
    }
    // Records are refused by name.
    std::string records = test::npy("XX", "(40,)", std::string(480, '\0'));
    records.replace(records.find("'XX'"), 4, "[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]");
    CHECK(test::contains(test::thrownBy([&] { npyHoldsPoints("a.npy", records); }).message, "structured"));
}
