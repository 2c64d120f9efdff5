// NIfTI: which frame places a volume, which of several volumes is read, what is refused.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/raster/raster_alignment.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"

using namespace vdbsynth;

namespace {

const std::vector<float> kPlain{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

struct File {
    std::string bytes;

    template <typename T>
    File& put(std::size_t at, T value) {
        std::memcpy(&bytes[at], &value, sizeof value);
        return *this;
    }
    // Dimensions 0 to 7 of the header.
    File& dims(const std::vector<int>& sides) {
        for (std::size_t i = 0; i < sides.size(); ++i) put(40 + 2 * i, std::int16_t(sides[i]));
        return *this;
    }
    File& qform(const std::vector<float>& bcd, const std::vector<float>& offset) {
        put(252, std::int16_t(1));
        for (std::size_t i = 0; i < 3; ++i) put(256 + 4 * i, bcd[i]).put(268 + 4 * i, offset[i]);
        return *this;
    }
    File& noSform() { return put(254, std::int16_t(0)); }
};

File ramp(const std::vector<float>& srow = kPlain) {
    return {test::nifti(2, 2, 2, std::string("\0\1\2\3\4\5\6\7", 8), srow)};
}

struct Read {
    Raster raster;
    std::string said;
    test::Thrown thrown;
};

Read reading(const File& file, const std::string& array = "") {
    Read read;
    RunContext ctx;
    ctx.maxMemory = 100000000;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level != MessageLevel::Detail) read.said += text + "\n";
    };
    read.thrown = test::thrownBy([&] { read.raster = readNifti("a.nii", file.bytes, {array}, ctx); });
    return read;
}

void turn(std::string& bytes, std::size_t at, std::size_t size) {
    std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + size));
}

}  // namespace

TEST_CASE("readNifti: an oblique sform keeps its rotation, which is said", "[io][oracle]") {
    // 30 degrees about x, voxels of 3; the slices run backwards.
    const float c = 3 * 0.8660254f, s = 1.5f;
    const Read read = reading(ramp({3, 0, 0, -78, 0, c, s, -76, 0, s, -c, -64}));
    REQUIRE(read.thrown.code == -1);
    CHECK(test::contains(read.said, "turned by 30 degrees"));
    const Raster& r = read.raster;
    CHECK(r.stack);
    CHECK(r.unit == "mm");
    // Voxel (1, 0, 1) of the file holds 5.
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) {
                if (int(r.at(x, y, z)) != 5) continue;
                const Vec3d at = r.origin + r.axes[0] * (r.spacing.x * x) + r.axes[1] * (r.spacing.y * y) +
                                 r.axes[2] * (r.spacing.z * z);
                CHECK(at.x == Approx(-75));
                CHECK(at.y == Approx(-76 + 1.5));
                CHECK(at.z == Approx(-64 - double(c)));
            }
}

TEST_CASE("readNifti: a qform is used where there is no sform, a singular sform is not", "[io][oracle]") {
    // Half a turn about z, whose fourth part rounding must not bring back; qfac reverses the slices.
    File file = ramp();
    file.noSform().qform({0, 1e-6f, 1}, {10, 20, 30}).put(76, -1.f).put(80, 2.f);
    Read read = reading(file);
    REQUIRE(read.thrown.code == -1);
    CHECK(runAlongWorld(read.raster.axes));
    CHECK(read.raster.spacing.x == Approx(2));
    CHECK(read.raster.origin.x == Approx(8));
    CHECK(read.raster.origin.y == Approx(19));
    CHECK(read.raster.origin.z == Approx(29));
    CHECK(read.raster.values == std::vector<float>{7, 6, 5, 4, 3, 2, 1, 0});
    File zeros = ramp(std::vector<float>(12, 0.f));
    zeros.qform({0, 0, 0}, {1, 2, 3});
    read = reading(zeros);
    CHECK(read.raster.origin.z == 3);
    CHECK(test::contains(read.said, "sform is singular; placed by its qform"));
}

TEST_CASE("readNifti: of two frames that differ the sform is used, of none the voxel sizes, both said",
          "[io][oracle]") {
    File both = ramp();
    both.qform({0, 0, 0}, {0.1f, 0, 0});
    CHECK(reading(both).said.empty());  // a tenth of a voxel
    both.qform({0, 0, 0}, {5, 0, 0});
    Read read = reading(both);
    CHECK(read.raster.origin.x == 0);
    CHECK(test::contains(read.said, "by up to 5; the sform is used"));
    File none = ramp();
    none.noSform().put(80, -2.f).put(84, 0.f);
    read = reading(none);
    CHECK(test::contains(read.said, "no sform and no qform"));
    CHECK(read.raster.spacing.x == 2);
    CHECK(read.raster.spacing.y == 1);  // zero is how some writers say one
}

TEST_CASE("readNifti: of several volumes the first is read or the one that is named", "[io][oracle]") {
    File file = {test::nifti(2, 1, 1, std::string("\0\1\2\3\4\5", 6), kPlain)};
    file.dims({4, 2, 1, 1, 3});
    Read read = reading(file);
    CHECK(read.raster.values == std::vector<float>{0, 1});
    CHECK(read.raster.arrays == std::vector<std::string>{"volume1", "volume2", "volume3"});
    CHECK(test::contains(read.said, "volume1, volume2, volume3; volume1 is read; `grid` chooses another"));
    read = reading(file, "volume2");
    CHECK(read.raster.values == std::vector<float>{2, 3});
    CHECK(read.said.empty());
    CHECK(test::contains(reading(file, "volume4").thrown.message, "volume4: not in a.nii"));
    file.dims({5, 2, 1, 1, 1, 3});
    CHECK(test::contains(reading(file).said, "component1 is read"));
    CHECK(reading(file, "component3").raster.values == std::vector<float>{4, 5});
    // Dimensions that are not used may be zero, and those beyond the count anything.
    file.dims({5, 2, 1, 1, 0, 0, 77});
    CHECK(reading(file).raster.arrays.empty());
    CHECK(reading(file).said.empty());
}

TEST_CASE("readNifti: values are scaled, in either byte order", "[io][oracle]") {
    File file = ramp();
    file.put(112, 0.5f).put(116, 10.f);
    CHECK(reading(file).raster.values == std::vector<float>{10, 10.5, 11, 11.5, 12, 12.5, 13, 13.5});
    CHECK(reading(file).raster.white == 0);
    file.put(112, 0.f);
    CHECK(reading(file).raster.values[7] == 7);
    file.put(112, std::numeric_limits<float>::quiet_NaN());
    CHECK(reading(file).raster.values[7] == 7);
    File big = ramp({2, 0, 0, 1, 0, 2, 0, 2, 0, 0, 2, 3});
    turn(big.bytes, 0, 4);
    for (std::size_t at = 40; at < 56; at += 2) turn(big.bytes, at, 2);
    for (const std::size_t at : {70, 252, 254}) turn(big.bytes, at, 2);
    for (std::size_t at = 76; at < 120; at += 4) turn(big.bytes, at, 4);
    for (std::size_t at = 256; at < 328; at += 4) turn(big.bytes, at, 4);
    CHECK(reading(big).raster.values[7] == 7);
    CHECK(reading(big).raster.origin.z == 3);
}

TEST_CASE("readNifti: units of length are kept", "[io][oracle]") {
    for (const auto& [code, unit] : {std::pair{0, ""}, {1, "m"}, {2, "mm"}, {3, "um"}, {2 | 8, "mm"}}) {
        File file = ramp();
        file.put(123, char(code));
        CHECK(reading(file).raster.unit == unit);
    }
}

TEST_CASE("readNifti: what is not read is refused by name", "[io][error]") {
    const auto refused = [](const File& file, const std::string& words) {
        const test::Thrown thrown = reading(file).thrown;
        CAPTURE(words, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.nii: "));
        CHECK(test::contains(thrown.message, words));
    };
    for (const auto& [code, words] : {std::pair{128, "RGB24"},
                                      {2304, "RGBA32"},
                                      {32, "complex"},
                                      {1, "bits"},
                                      {1536, "float128"},
                                      {999, "type 999"}}) {
        File file = ramp();
        refused(file.put(70, std::int16_t(code)), words);
    }
    File pair = ramp(), analyze = ramp(), many = ramp(), huge = ramp(), nan = ramp(), none = ramp();
    refused(pair.put(344, 'n').put(345, 'i'), ".img");
    refused(analyze.put(344, std::int32_t(0)), "Analyze 7.5");
    refused(many.dims({7, 2, 2, 2, 30000, 30000, 30000, 30000}), "over 100000 volumes");
    refused(huge.dims({4, 2, 2, 2, 2}), "truncated");
    const float noNumber = std::numeric_limits<float>::quiet_NaN();
    refused(nan.noSform().qform({0, noNumber, 0}, {0, 0, 0}), "singular or holds no usable numbers");
    refused(none.dims({0}), "0 dimensions");
}

TEST_CASE("readNifti: files of version 2 are read, their pairs refused", "[io][oracle]") {
    File file{std::string(544, '\0')};
    file.put(0, std::int32_t(540)).put(4, 'n').put(5, '+').put(6, '2').put(12, std::int16_t(2));
    const std::int64_t dims[8] = {3, 2, 1, 1, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) file.put(16 + 8 * i, dims[i]).put(104 + 8 * i, 1.0);
    file.put(168, std::int64_t(544)).put(176, 2.0).put(348, std::int32_t(1)).put(500, std::int32_t(3));
    const double rows[12] = {0, 2, 0, 5, 3, 0, 0, 6, 0, 0, -4, 7};
    for (std::size_t i = 0; i < 12; ++i) file.put(400 + 8 * i, rows[i]);
    file.bytes += "\1\2";
    const Read read = reading(file);
    REQUIRE(read.thrown.message.empty());
    CHECK(read.raster.size == Index3{1, 2, 1});
    CHECK(read.raster.values == std::vector<float>{2, 4});
    CHECK(read.raster.spacing.y == 3);
    CHECK(read.raster.origin.y == 6);
    CHECK(read.raster.unit == "um");
    file.put(5, 'i');
    CHECK(test::contains(reading(file).thrown.message, ".img"));
}
