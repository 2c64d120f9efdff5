// The frames around the samples, byte by byte, and their places and units through the readers.
#include "libvdbsynth/io/writers/volume_writers.h"

#include <catch2/catch.hpp>

#include <cstring>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/raster/raster_alignment.h"
#include "tests/support/said.h"

using namespace vdbsynth;

namespace {

VolumeHead headOf(const Index3& size, bool bytes, double cell = 1, const Vec3d& first = {0, 0, 0}) {
    VolumeHead head;
    head.name = "inside";
    head.size = size;
    head.bytes = bytes;
    for (std::size_t i = 0; i < 3; ++i) {
        head.toWorld[5 * i] = cell;
        head.toWorld[12 + i] = first[int(i)];
    }
    return head;
}

// Turned by a unit quaternion, and mirrored along the slices if asked for.
VolumeHead turned(double x, double y, double z, double w, bool mirrored) {
    VolumeHead head = headOf({3, 4, 5}, true);
    const Affine turn = rotation(x, y, z, w);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t row = 0; row < 3; ++row)
            head.toWorld[4 * axis + row] = (mirrored && axis == 2 ? -0.25 : 0.25) * turn[4 * axis + row];
    head.toWorld[12] = 7;
    return head;
}

// The number of a sample is its place in the file.
std::string fileOf(const VolumeFrame& frame, const VolumeHead& head) {
    std::string samples;
    const std::size_t count = latticeCount(head.size);
    for (std::size_t i = 0; i < count; ++i) {
        const float value = float(i);
        if (head.bytes)
            samples += char(i);
        else
            samples.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return frame.head + samples + frame.tail;
}

// The world place of every sample of a raster, by its value.
std::vector<Vec3d> placesOf(const Raster& raster) {
    std::vector<Vec3d> places(raster.values.size());
    for (int z = 0; z < raster.size.z; ++z)
        for (int y = 0; y < raster.size.y; ++y)
            for (int x = 0; x < raster.size.x; ++x) {
                Vec3d place = raster.origin;
                const int at[3] = {x, y, z};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    place = place + raster.axes[axis] * (raster.spacing[int(axis)] * at[axis]);
                places[std::size_t(raster.at(x, y, z))] = place;
            }
    return places;
}

// The largest distance [cells] between where a raster has its samples and where they were written to.
double apart(const Raster& raster, const VolumeHead& head) {
    const std::vector<Vec3d> places = placesOf(raster);
    double most = 0;
    std::size_t i = 0;
    for (int z = 0; z < head.size.z; ++z)
        for (int y = 0; y < head.size.y; ++y)
            for (int x = 0; x < head.size.x; ++x)
                most = std::max(
                    most, length(places[i++] - transformed(head.toWorld, {double(x), double(y), double(z)})));
    return most / cellOf(head);
}

}  // namespace

TEST_CASE("npyFrame: numpy's header, aligned to 64 bytes", "[io][oracle]") {
    const VolumeFrame frame = npyFrame(headOf({5, 6, 7}, false));
    CHECK(frame.head.substr(0, 8) == std::string("\x93NUMPY\x01\0", 8));
    CHECK(frame.head.size() % 64 == 0);
    CHECK(frame.head.substr(10).find("{'descr': '<f4', 'fortran_order': False, 'shape': (7, 6, 5), }") == 0);
    CHECK(frame.head.back() == '\n');
    CHECK(frame.tail.empty());
    const VolumeHead head = headOf({5, 6, 7}, true);
    const Raster raster = readNpy("v.npy", fileOf(npyFrame(head), head), {}, {});
    CHECK(raster.size == head.size);
    CHECK(apart(raster, head) == 0);
}

TEST_CASE("npyFrame: three or four columns of bytes stay a volume", "[io][property]") {
    for (const int columns : {2, 3, 4, 5}) {
        const VolumeHead head = headOf({columns, 8, 8}, true);
        const Raster raster = readNpy("v.npy", fileOf(npyFrame(head), head), {}, {});
        CAPTURE(columns);
        CHECK(raster.size == head.size);
        CHECK(raster.channels == 1);
    }
}

TEST_CASE("niftiFrame, vtiFrame: every rotation and reflection comes back in its place", "[io][property]") {
    const double s = std::sqrt(0.5);
    const std::array<double, 4> turns[] = {
        {0, 0, 0, 1},    {s, 0, 0, s},         {0, s, 0, s},
        {0, 0, s, s},    {1, 0, 0, 0},         {0, 1, 0, 0},
        {0, 0, 1, 0},    {0.5, 0.5, 0.5, 0.5}, {0.1, 0.3, -0.5, 0.806225774829855},
        {0.6, 0, 0.8, 0}};
    for (const bool mirrored : {false, true})
        for (const std::array<double, 4>& q : turns) {
            const VolumeHead head = turned(q[0], q[1], q[2], q[3], mirrored);
            CAPTURE(q[0], q[1], q[2], q[3], mirrored);
            std::string nifti = fileOf(niftiFrame(head), head);
            CHECK(apart(readNifti("v.nii", nifti, {}, {}), head) < 1e-5);
            // The qform alone says the same.
            nifti[254] = 0;
            CHECK(apart(readNifti("v.nii", nifti, {}, {}), head) < 1e-5);
            CHECK(apart(readVti("v.vti", fileOf(vtiFrame(head), head), {}, {}), head) < 1e-5);
        }
}

TEST_CASE("niftiFrame: units, and what floats lose far from zero", "[io][oracle]") {
    for (const char* unit : {"m", "mm", "um", ""}) {
        VolumeHead head = headOf({2, 3, 4}, false, 0.5, {1, -2, 3});
        head.unit = unit;
        test::Said said;
        const Raster raster = readNifti("v.nii", fileOf(niftiFrame(head), head), {}, said.ctx);
        CHECK(raster.unit == unit);
        CHECK(raster.origin.y == -2);
        CHECK(said.nothing());
    }
    CHECK(niftiUnit("in") == 0);
    CHECK(niftiError(headOf({2, 3, 4}, true, 0.5, {1, 2, 3})) == 0);
    // 2^24 + 1 is no float.
    CHECK(niftiError(headOf({1, 1, 1}, true, 2, {16777217, 0, 0})) == 0.5);
}

TEST_CASE("vtiFrame: Direction only where the axes are turned", "[io][oracle]") {
    CHECK(vtiFrame(headOf({2, 2, 2}, true)).head.find("Direction") == std::string::npos);
    CHECK(vtiFrame(turned(0, 0, 1, 0, false)).head.find("Direction=\"-1 0 0 0 -1 0 0 0 1\"") !=
          std::string::npos);
    CHECK(vtiFrame(headOf({2, 3, 4}, false)).head.find("WholeExtent=\"0 1 0 2 0 3\"") != std::string::npos);
    CHECK(
        vtiFrame(headOf({2, 3, 4}, false)).head.substr(vtiFrame(headOf({2, 3, 4}, false)).head.size() - 9) ==
        std::string("_\x60\0\0\0\0\0\0\0", 9));
}

TEST_CASE("tiffFrame: a description as ImageJ writes it, words at even places", "[io][oracle]") {
    VolumeHead head = headOf({3, 3, 5}, true, 0.25, {1, 0, -2});
    head.unit = "um";
    const VolumeFrame frame = tiffFrame(head);
    CHECK(frame.head.substr(0, 4) == std::string("II*\0", 4));
    CHECK(frame.tail.find("ImageJ=1.53\nimages=5\nslices=5\nunit=um\nspacing=0.25\nloop=false\nmin=0\nmax=1\n"
                          "xorigin=-4\nzorigin=8\n") == 1);
    std::uint32_t directory = 0;
    std::memcpy(&directory, frame.head.data() + 4, 4);
    CHECK(directory % 2 == 0);
    // Over 4 GB offsets have eight bytes.
    const VolumeFrame big = tiffFrame(headOf({40000, 40000, 3}, true));
    CHECK(big.head.substr(0, 8) == std::string("II\x2b\0\x08\0\0\0", 8));
    std::uint64_t first = 0;
    std::memcpy(&first, big.head.data() + 8, 8);
    CHECK(first > 4800000000u);
    CHECK(first < 4800001000u);
}

#ifdef VDBSYNTH_TESTS_TIFF
TEST_CASE("tiffFrame: slices, cells, origin and unit come back", "[io][property]") {
    for (const double cell : {0.3, 0.0619792, 1.0, 346.909, 1e-6, 5e8, 1.0 / 3})
        for (const bool bytes : {false, true}) {
            VolumeHead head = headOf({3, 5, 7}, bytes, cell, {4 * cell, 0, -2.5 * cell});
            head.unit = "mm";
            const Raster raster = readTiff("v.tif", fileOf(tiffFrame(head), head), {}, {});
            CAPTURE(cell, bytes);
            CHECK(raster.size == head.size);
            CHECK(raster.unit == "mm");
            CHECK(raster.spacing.x == cell);
            CHECK(apart(raster, head) < 1e-9);
        }
}
#endif

TEST_CASE("runsAlongWorld, sampleBytes, appendLittle", "[io][oracle]") {
    CHECK(runsAlongWorld(headOf({1, 1, 1}, true, 0.1)));
    CHECK_FALSE(runsAlongWorld(turned(0, 0, 0, 1, true)));
    CHECK(sampleBytes(headOf({3, 4, 5}, true)) == 60);
    CHECK(sampleBytes(headOf({3000, 4000, 5000}, false)) == 240000000000u);
    std::string text;
    appendLittle(text, 0x01020304, 3);
    CHECK(text == "\x04\x03\x02");
}
