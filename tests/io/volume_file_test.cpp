#include "libvdbsynth/io/volume_file.h"

#include <catch2/catch.hpp>

#include <atomic>

#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

const char* const kNames[] = {"v.npy", "v.tif", "v.vti", "v.nii", "v.nii.gz"};

VolumeHead headOf(const Index3& size, bool bytes) {
    VolumeHead head;
    head.name = "distance";
    head.size = size;
    head.bytes = bytes;
    return head;
}

float valueAt(const Index3& size, int x, int y, int z, bool bytes) {
    const int number = (z * size.y + y) * size.x + x;
    return bytes ? float(number % 7) : 0.25f * float(number) - 9;
}

// Fills slices, and remembers how many it was asked for at once.
SliceSource source(const VolumeHead& head, int& mostAtOnce) {
    return [&head, &mostAtOnce](int first, int count, char* out) {
        mostAtOnce = std::max(mostAtOnce, count);
        for (int z = first; z < first + count; ++z)
            for (int y = 0; y < head.size.y; ++y)
                for (int x = 0; x < head.size.x; ++x) {
                    const float value = valueAt(head.size, x, y, z, head.bytes);
                    if (head.bytes) {
                        *out++ = char(value);
                        continue;
                    }
                    std::copy_n(reinterpret_cast<const char*>(&value), sizeof value, out);
                    out += sizeof value;
                }
    };
}

VolumeFormat formatOf(const std::string& path) {
    VolumeFormat format{};
    REQUIRE(volumeFormatOf(path, format));
    return format;
}

}  // namespace

TEST_CASE("writeVolume: every format and type comes back, however thin the slabs", "[io][property]") {
    const test::TemporaryFolder folder;
    for (const bool bytes : {false, true})
        for (const std::uint64_t memory : {std::uint64_t(0), std::uint64_t(3000)}) {
            const VolumeHead head = headOf({9, 11, 10}, bytes);
            for (const char* name : kNames) {
#ifndef VDBSYNTH_TESTS_TIFF
                if (std::string(name) == "v.tif") continue;
#endif
                RunContext ctx;
                ctx.maxMemory = memory;
                int mostAtOnce = 0;
                const std::string path = folder.path(name);
                writeVolume(path, name, formatOf(path), head, source(head, mostAtOnce), ctx);
                CAPTURE(name, bytes, memory);
                CHECK(mostAtOnce == (memory == 0 ? 10 : bytes ? 3 : 1));
                const Raster raster = readRaster(path);
                REQUIRE(raster.size == head.size);
                bool same = true;
                for (int z = 0; z < 10; ++z)
                    for (int y = 0; y < 11; ++y)
                        for (int x = 0; x < 9; ++x)
                            same = same && raster.at(x, y, z) == valueAt(head.size, x, y, z, bytes);
                CHECK(same);
            }
        }
}

TEST_CASE("writeVolume: twice the same bytes, packed it unpacks to the same file", "[io][determinism]") {
    const test::TemporaryFolder folder;
    const VolumeHead head = headOf({9, 11, 10}, false);
    int unused = 0;
    for (const char* name : kNames) {
        std::string contents[2];
        for (std::string& content : contents) {
            writeVolume(folder.path(name), name, formatOf(name), head, source(head, unused));
            content = test::contentOf(folder.path(name));
        }
        CHECK(contents[0] == contents[1]);
    }
    CHECK(test::contentOf(folder.path("v.nii.gz")).size() < test::contentOf(folder.path("v.nii")).size());
}

TEST_CASE("writeVolume: what it refuses", "[io][errors]") {
    const test::TemporaryFolder folder;
    int unused = 0;
    const auto thrown = [&](const Index3& size, VolumeFormat format, RunContext ctx = {},
                            const std::string& name = "v") {
        const VolumeHead head = headOf(size, false);
        return test::thrownBy(
            [&] { writeVolume(folder.path(name), "v.nii", format, head, source(head, unused), ctx); });
    };
    CHECK(thrown({0, 1, 1}, VolumeFormat::Npy).code == int(ErrorCode::InvalidOption));
    CHECK(thrown({1, 1, (1 << 24) + 1}, VolumeFormat::Vti).code == int(ErrorCode::InvalidOption));
    const test::Thrown side = thrown({1, 32768, 1}, VolumeFormat::NiftiGz);
    CHECK(side.code == int(ErrorCode::InvalidOption));
    CHECK(test::contains(side.message, "32767 in .nii; write .vti or .npy"));
    const test::Thrown large = thrown({10000, 10000, 1000}, VolumeFormat::Npy);
    CHECK(large.code == int(ErrorCode::Unusable));
    CHECK(test::contains(large.message, "400 GB, over 256 GB"));
    RunContext little;
    little.maxMemory = 1000000;
    CHECK(thrown({1000, 1000, 2}, VolumeFormat::Npy, little).code == int(ErrorCode::Memory));
    CHECK(thrown({2, 2, 2}, VolumeFormat::Npy, {}, "no/folder").code == int(ErrorCode::Io));
    const std::atomic<bool> cancel{true};
    RunContext stopped;
    stopped.cancel = &cancel;
    CHECK(thrown({2, 2, 2}, VolumeFormat::Npy, stopped).code == int(ErrorCode::Cancelled));
}

TEST_CASE("volumeFormatOf: by extension", "[io][oracle]") {
    CHECK(formatOf("A.NII.GZ") == VolumeFormat::NiftiGz);
    CHECK(formatOf("a.nii") == VolumeFormat::Nifti);
    CHECK(formatOf("a.TIFF") == VolumeFormat::Tiff);
    VolumeFormat format{};
    for (const char* name : {"a.npy.gz", "a.gz", "a.vdb", "nii", "a.exr", ""})
        CHECK_FALSE(volumeFormatOf(name, format));
}

TEST_CASE("lostInVolume: what each format has no place for", "[io][oracle]") {
    VolumeHead head = headOf({2, 2, 2}, true);
    for (const char* name : kNames) CHECK(lostInVolume(formatOf(name), head).empty());
    head.unit = "um";
    CHECK(lostInVolume(VolumeFormat::Vti, head) == "no place for its unit (um)");
    CHECK(lostInVolume(VolumeFormat::Tiff, head).empty());
    CHECK(lostInVolume(VolumeFormat::Nifti, head).empty());
    head.unit = "in";
    CHECK(lostInVolume(VolumeFormat::NiftiGz, head) == "no place for its unit (in)");
    head.unit = "";
    head.toWorld = {0, 0.5, 0, 0, -0.5, 0, 0, 0, 0, 0, 0.5, 0, 3, 0, 0, 1};
    CHECK(lostInVolume(VolumeFormat::Vti, head).empty());
    CHECK(lostInVolume(VolumeFormat::Nifti, head).empty());
    CHECK(lostInVolume(VolumeFormat::Tiff, head) == "no place for the rotation of its axes, its origin");
    CHECK(lostInVolume(VolumeFormat::Npy, head) ==
          "no place for the rotation of its axes, its origin, the side of its voxels");
    head.toWorld[12] = 1e9 + 1;
    CHECK(lostInVolume(VolumeFormat::Nifti, head) ==
          "only floats for its place, which move it by up to 2 voxels");
}
