#include "libvdbsynth/patch/onto/onto_arrangement.h"

#include "tests/support/onto_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

const PatchLattice kLattice{2, 6, 5, 4};

}  // namespace

TEST_CASE("readBetween: nodes as they are, means between them, the nearest beyond") {
    const PatchField field = test::noisePatchField(kLattice, 3);
    std::vector<float> values(field.columnLength()), distances(4);
    readBetween(field, {2 * 3 + 1, 2 * 2 + 1}, values.data());
    for (std::size_t n = 0; n < values.size(); ++n) REQUIRE(values[n] == field.column(3, 2)[n]);
    const PlanePlace between{2 * 3 + 1.5, 2 * 2 + 2};  // a quarter along x, a half along y
    readBetween(field, between, values.data());
    readDistances(field, between, distances.data());
    for (int k = 0; k < 4; ++k) {
        const float wanted = 0.5f * (0.75f * field.distance(3, 2, k) + 0.25f * field.distance(4, 2, k)) +
                             0.5f * (0.75f * field.distance(3, 3, k) + 0.25f * field.distance(4, 3, k));
        CHECK(values[std::size_t(k * kFieldValues)] == Approx(wanted).margin(1e-5));
        CHECK(distances[std::size_t(k)] == values[std::size_t(k * kFieldValues)]);
        CHECK(readDistance(field, between, k) == Approx(wanted).margin(1e-5));
    }
    readBetween(field, {-100, 1e6}, values.data());
    for (std::size_t n = 0; n < values.size(); ++n) REQUIRE(values[n] == field.column(0, 4)[n]);
}

TEST_CASE("OntoPatch: the way to the exemplar and back") {
    OntoPatch patch;
    patch.from = {10, 20};
    patch.turn = {0.6f, 0.8f};
    const PlanePlace place = patch.inExemplar({1, 0});
    CHECK(place.x == Approx(10.6));
    CHECK(place.y == Approx(20.8));
    const Vec2f back = patch.onDisk(patch.inExemplar({3, -2}));
    CHECK(back.x == Approx(3));
    CHECK(back.y == Approx(-2));
}

// Two disks of a plane whose tangents are turned against each other see the same field.
TEST_CASE("readOnto: what lies there, in the axes of the disk that looks") {
    const OntoSurface surface = test::surfaceAlong(test::squareShape(12, 1), {1, 0, 0}, 1);
    SurfaceDisks disks(surface);
    OntoArrangement arrangement;
    arrangement.nz = 4;
    arrangement.step = 2;
    arrangement.label.assign(surface.sites.size() * 4, 0);
    const std::uint32_t first = test::siteAt(surface, {5, 5, 0}), second = test::siteAt(surface, {7, 6, 0});
    const PatchField field = test::noisePatchField(kLattice, 3);
    OntoPatch patch;
    patch.disk = disks.around(first, 6);
    patch.from = {6, 5};
    patch.turn = {0, 1};  // x of the disk runs along the exemplar's y
    arrangement.patches.push_back(patch);
    const SurfaceDisk disk = disks.around(second, 6);
    std::vector<float> seen(field.columnLength()), own(seen);
    for (std::size_t m = 0; m < disk.size(); ++m) {
        const std::ptrdiff_t other = patch.disk.find(disk.site[m]);
        if (other < 0) continue;
        readOnto(field, arrangement, disk, std::ptrdiff_t(m), disk.at[m] + Vec2f{0.2f, 0.1f}, seen.data());
        readBetween(field, patch.inExemplar(patch.disk.at[std::size_t(other)] + Vec2f{0.2f, 0.1f}),
                    own.data());
        for (int k = 0; k < 4; ++k) {
            const float *a = seen.data() + k * kFieldValues, *b = own.data() + k * kFieldValues;
            REQUIRE(a[0] == Approx(b[0]).margin(1e-2));
            REQUIRE(a[1] == Approx(b[2]).margin(1e-2));
            REQUIRE(a[2] == Approx(-b[1]).margin(1e-2));
            REQUIRE(a[3] == Approx(b[3]).margin(1e-2));
        }
    }
    CHECK(arrangement.known(0));
}
