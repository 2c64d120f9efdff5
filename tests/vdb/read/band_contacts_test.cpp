#include "libvdbsynth/vdb/read/band_contacts.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/vdb/read/fields.h"

using namespace vdbsynth;

TEST_CASE("bandContactsOf: a sound band of any width has no jumps and does not end early",
          "[vdb][property]") {
    for (const double width : {0.7, 1.0, 2.0, 3.0, 6.0}) {
        test::Band band;
        band.outside = band.inside = band.background = width;
        band.interior = -width;
        const BandContacts contacts =
            bandContactsOf(*test::bandGrid(test::ballField(10), 18, 0.1, band), 0.15);
        INFO(width);
        CHECK(contacts.jumps == 0);
        CHECK(contacts.inside.voxels > 100);
        CHECK(contacts.outside.voxels > contacts.inside.voxels);
        CHECK(contacts.inside.early + contacts.outside.early == 0);
        CHECK(contacts.deepest == Approx(-width * 0.1));
    }
}

TEST_CASE("bandContactsOf: what is wrong is counted", "[vdb][property]") {
    test::Band band;
    band.interior = 3;
    CHECK(bandContactsOf(*test::bandGrid(test::ballField(10), 15, 1, band), 1.5).jumps > 100);
    band = {};
    band.background = 10;
    const BandContacts far = bandContactsOf(*test::bandGrid(test::ballField(10), 15, 1, band), 1.5);
    CHECK(far.outside.early == far.outside.voxels);
    band = {};
    band.sign = -1;
    const BandContacts turned = bandContactsOf(*test::bandGrid(test::ballField(10), 15, 1, band), 1.5);
    CHECK(turned.jumps > 100);
    CHECK(turned.inside.voxels + turned.outside.voxels == 0);
    CHECK(bandContactsOf(*openvdb::FloatGrid::create(1.f), 1).jumps == 0);
}
