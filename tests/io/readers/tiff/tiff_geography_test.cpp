#include "libvdbsynth/io/readers/tiff/tiff_geography.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;

namespace {

using Fields = std::vector<test::TiffField>;

Raster placed(const Fields& fields, const RunContext& ctx = {}) {
    test::TiffMaker maker;
    test::TiffMaker::Page page{4, 2, 8, "abcdefgh"};
    page.fields = fields;
    const std::string content = maker.file({page});
    TiffFile file("a.tif", content);
    file.select(0);
    Raster raster;
    raster.size = {4, 2, 1};
    readGeography("a.tif", file, raster, ctx);
    return raster;
}

test::TiffField matrix(double a, double b, double d, double e, double y = 200) {
    return test::TiffMaker().doubles(34264, {a, b, 0, 100, d, e, 0, y, 0, 0, 0, 0, 0, 0, 0, 1});
}

const test::TiffField kDegrees = test::TiffMaker().shorts(34735, {1, 1, 0, 1, 1024, 0, 1, 2});

}  // namespace

TEST_CASE("readGeography: by a matrix the same as by a pixel scale", "[io][oracle]") {
    test::TiffMaker maker;
    test::Said said;
    for (const Fields& fields : {Fields{matrix(30, 0, 0, -20)}, Fields{maker.doubles(33550, {30, 20, 0})}}) {
        const Raster raster = placed(fields, said.ctx);
        CHECK(raster.knownSpacing);
        CHECK(raster.spacing.x == 30);
        CHECK(raster.spacing.y == 20);
        CHECK(raster.unit.empty());
    }
    CHECK(said.all().empty());
    // 60 degrees north in the middle of the two rows: a degree of longitude is half as long.
    for (const Fields& fields : {Fields{matrix(0.001, 0, 0, -0.001, 60.001), kDegrees},
                                 Fields{maker.doubles(33550, {0.001, 0.001, 0}),
                                        maker.doubles(33922, {0, 0, 0, 10, 60.001, 0}), kDegrees}}) {
        const Raster raster = placed(fields);
        CHECK(raster.spacing.x == Approx(55.66));
        CHECK(raster.spacing.y == Approx(111.32));
        CHECK(raster.unit == "m");
    }
}

TEST_CASE("readGeography: turned and mirrored images keep their pixel size, with a note", "[io][oracle]") {
    test::Said said;
    const Raster turned = placed({matrix(17.320508075688775, 5, 10, -8.660254037844387)}, said.ctx);
    CHECK(turned.spacing.x == Approx(20));
    CHECK(turned.spacing.y == Approx(10));
    REQUIRE(said.notes.size() == 1);
    CHECK(test::contains(said.notes[0], "turned on the map"));
    CHECK(test::contains(said.notes[0], "20 x 10"));
    for (const auto& field : {matrix(30, 0, 0, 30), matrix(-30, 0, 0, -30)}) {
        test::Said mirrored;
        CHECK(placed({field}, mirrored.ctx).spacing.y == 30);
        CHECK(test::contains(mirrored.all(), "mirrored on the map"));
    }
}

TEST_CASE("readGeography: unusable places are none", "[io][error]") {
    test::TiffMaker maker;
    const double none = std::nan(""), huge = std::numeric_limits<double>::infinity();
    for (const auto& field :
         {matrix(0, 0, 0, 0), matrix(none, 0, 0, 1), matrix(1, 0, 0, huge), matrix(1e200, 0, 0, 1e200),
          maker.doubles(34264, {1, 2, 3}), maker.doubles(33550, {-1, 1, 0}), maker.doubles(33550, {1}),
          maker.shorts(34264, std::vector<int>(16, 1))})
        CHECK_FALSE(placed({field}).knownSpacing);
    test::Said said;
    CHECK_FALSE(placed({maker.doubles(33922, std::vector<double>(24, 1.0))}, said.ctx).knownSpacing);
    CHECK(test::contains(said.all(), "control points"));
}

TEST_CASE("dropNoData: the value in words becomes NaN", "[io][oracle]") {
    for (const auto& [word, count] :
         {std::pair<const char*, int>{"98", 1}, {"98.0 ", 1}, {"nan", 0}, {"x", 0}, {"", 0}}) {
        test::TiffMaker maker;
        test::TiffMaker::Page page{3, 1, 8, "abc"};
        page.fields = {test::TiffMaker::text(42113, word)};
        const std::string content = maker.file({page});
        TiffFile file("a.tif", content);
        file.select(0);
        Raster raster;
        raster.size = {3, 1, 1};
        raster.values = {97, 98, 99};
        dropNoData(file, raster);
        CHECK(std::isnan(raster.values[1]) == (count == 1));
        CHECK(raster.values[0] == 97);
    }
}
