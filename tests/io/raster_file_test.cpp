#include "libvdbsynth/io/raster_file.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;
using test::raw;

namespace {

test::Thrown reading(const std::string& path, std::uint64_t maxMemory = 0) {
    RunContext ctx;
    ctx.maxMemory = maxMemory;
    return test::thrownBy([&] { readRaster(path, {}, ctx); });
}

const std::vector<float> kRamp{0, 1, 2, 3, 4, 5};

}  // namespace

TEST_CASE("readRaster: pgm and ppm, text and binary, 8 and 16 bits", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Raster text = readRaster(folder.write("a.pgm", "P2 # words\n3 2\n9\n0 1 2\n3 4 5\n"));
    CHECK(text.size == Index3{3, 2, 1});
    CHECK(text.values == kRamp);
    CHECK(text.white == 9);
    CHECK(text.rowsFromTop);
    CHECK(readRaster(folder.write("b.pgm", test::pgm(3, 2, 255, raw<std::uint8_t>({0, 1, 2, 3, 4, 5}))))
              .values == kRamp);
    const Raster wide = readRaster(folder.write("c.pgm", test::pgm(2, 1, 65535, std::string("\1\0\0\2", 4))));
    CHECK(wide.values == std::vector<float>{256, 2});
    const Raster colour = readRaster(folder.write("d.ppm", "P3\n1 1\n255\n10 20 30\n"));
    CHECK(colour.channels == 3);
    CHECK(luminance(colour).values[0] == Approx(0.2126 * 10 + 0.7152 * 20 + 0.0722 * 30));
}

TEST_CASE("readRaster: PNG of 16 bits and EXR come back as written, with what has no data",
          "[io][property]") {
    const test::TemporaryFolder folder;
    const std::vector<float> heights{0, 0.25f, 1, std::nanf(""), 0.5f, 0.75f};
    writeGreyPng(folder.path("a.png"), 3, 2, heights);
    writeGreyExr(folder.path("a.exr"), 3, 2, heights);
    const Raster png = readRaster(folder.path("a.png")), exr = readRaster(folder.path("a.exr"));
    CHECK(png.white == 65535);
    CHECK(exr.white == 0);
    CHECK(png.size == Index3{3, 2, 1});
    CHECK(exr.size == Index3{3, 2, 1});
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if (std::isnan(heights[i])) {
            CHECK(std::isnan(png.values[i]));
            CHECK(std::isnan(exr.values[i]));
            continue;
        }
        CHECK(exr.values[i] == heights[i]);
        CHECK(png.values[i] / 65535 == Approx(heights[i]).margin(1e-5));
    }
}

TEST_CASE("readRaster: TIFF of whole and real numbers, no data, pixel size, pages", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Raster bytes =
        readRaster(folder.write("a.tif", test::tiff(3, 2, 8, 1, {raw<std::uint8_t>({0, 1, 2, 3, 4, 5})})));
    CHECK(bytes.values == kRamp);
    CHECK(bytes.white == 255);
    CHECK_FALSE(bytes.stack);
    const Raster shorts = readRaster(folder.write(
        "b.tif", test::tiff(2, 1, 16, 2, {raw<std::int16_t>({-5, -32768})}, "-32768", {30, 20, 0})));
    CHECK(shorts.values[0] == -5);
    CHECK(std::isnan(shorts.values[1]));
    CHECK(shorts.white == 0);
    CHECK(shorts.knownSpacing);
    CHECK(shorts.spacing.x == 30);
    CHECK(shorts.spacing.y == 20);
    CHECK(readRaster(folder.write("c.tif", test::tiff(3, 2, 32, 3, {raw(kRamp)}))).values == kRamp);
    CHECK(readRaster(folder.write("c.tif", test::tiff(3, 2, 64, 3, {raw<double>({0, 1, 2, 3, 4, 5})})))
              .values == kRamp);
    const Raster stack = readRaster(
        folder.write("d.tif", test::tiff(3, 1, 8, 1, {std::string("\0\1\2", 3), std::string("\3\4\5", 3)})));
    CHECK(stack.size == Index3{3, 1, 2});
    CHECK(stack.stack);
    CHECK(stack.values == kRamp);
}

TEST_CASE("readRaster: npy of any type, order and byte order", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Raster image = readRaster(folder.write("a.npy", test::npy("<f4", "(2, 3)", raw(kRamp))));
    CHECK(image.size == Index3{3, 2, 1});
    CHECK_FALSE(image.stack);
    CHECK(image.values == kRamp);
    const Raster volume = readRaster(
        folder.write("b.npy", test::npy("|u1", "(3, 1, 2)", raw<std::uint8_t>({0, 1, 2, 3, 4, 5}))));
    CHECK(volume.size == Index3{2, 1, 3});
    CHECK(volume.stack);
    CHECK(volume.values == kRamp);
    const Raster turned = readRaster(
        folder.write("c.npy", test::npy("<i8", "(2, 3)", raw<std::int64_t>({0, 3, 1, 4, 2, 5}), true)));
    CHECK(turned.values == kRamp);
    CHECK(readRaster(folder.write("d.npy", test::npy(">u2", "(1, 2)", std::string("\1\0\0\2", 4)))).values ==
          std::vector<float>{256, 2});
    CHECK(readRaster(folder.write("e.npy", test::npy("<f2", "(1, 2)", raw<std::uint16_t>({0x3c00, 0xc500}))))
              .values == std::vector<float>{1, -5});
}

TEST_CASE("readRaster: NIfTI is turned to the axes of the world", "[io][oracle]") {
    const test::TemporaryFolder folder;
    // Voxel axis 0 runs to the patient's left, axis 1 up, axis 2 to the front.
    const Raster raster =
        readRaster(folder.write("a.nii", test::nifti(2, 3, 1, std::string("\0\1\2\3\4\5", 6),
                                                     {-2, 0, 0, 10, 0, 0, 4, 0, 0, 3, 0, 5})));
    CHECK(raster.size == Index3{2, 1, 3});
    CHECK(raster.spacing.x == 2);
    CHECK(raster.spacing.y == 4);
    CHECK(raster.spacing.z == 3);
    CHECK(raster.origin.x == 8);
    CHECK(raster.origin.z == 5);
    CHECK(raster.unit == "mm");
    CHECK(raster.values == std::vector<float>{1, 0, 3, 2, 5, 4});
}

TEST_CASE("readRaster: VTK images as text, base64 and appended", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const auto check = [&](const std::string& content) {
        const Raster raster = readRaster(folder.write("a.vti", content));
        CHECK(raster.size == Index3{3, 2, 1});
        CHECK(raster.values == kRamp);
        CHECK(raster.spacing.z == 2);
        CHECK(raster.origin.y == 2);
    };
    check(test::vti("0 2 0 1 0 0", "", "type=\"Float32\" format=\"ascii\"", "0 1 2\n3 4 5\n"));
    // A header of 6 bytes, then 0 1 2 3 4 5.
    check(test::vti("0 2 0 1 0 0", "", "type=\"UInt8\" format=\"binary\"", "\nBgAAAAABAgMEBQ==\n"));
    std::string appended =
        test::vti("0 2 0 1 0 0", "", "type=\"UInt8\" format=\"appended\" offset=\"2\"", "");
    const std::string data = "<AppendedData encoding=\"raw\">_<<" + std::string("\6\0\0\0\0\1\2\3\4\5", 10) +
                             "</AppendedData>\n</VTKFile>";
    appended.replace(appended.find("</VTKFile>"), 10, data);
    check(appended);
    // zlib's stream of the six bytes, stored: one block of 6, the last of 6, packed to 17.
    const std::string stored = std::string("\x78\x01\x01\x06\x00\xf9\xff\0\1\2\3\4\5\0\x29\0\x10", 17);
    std::string packed = test::vti("0 2 0 1 0 0", "compressor=\"vtkZLibDataCompressor\"",
                                   "type=\"UInt8\" format=\"appended\" offset=\"0\"", "");
    const std::string block = raw<std::uint32_t>({1, 6, 6, 17}) + stored;
    packed.replace(packed.find("</VTKFile>"), 10,
                   "<AppendedData encoding=\"raw\">_" + block + "</AppendedData></VTKFile>");
    check(packed);
}

TEST_CASE("readRaster: GSLIB and INRIMAGE", "[io][oracle]") {
    const test::TemporaryFolder folder;
    const Raster gslib = readRaster(folder.write(
        "a.sgems", "3 2 1\r\n2\r\nfacies\r\nother\r\n0 9\r\n1 9\r\n2 9\r\n3 9\r\n4 9\r\n5 9\r\n"));
    CHECK(gslib.size == Index3{3, 2, 1});
    CHECK(gslib.values == kRamp);
    std::string header =
        "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=1\nVDIM=1\nTYPE=float\nPIXSIZE=32 "
        "bits\nCPU=decm\nVX=0.5\nVY=0.5\nVZ=2\n";
    header.resize(252, '\n');
    const Raster inr = readRaster(folder.write("b.inr", header + "##}\n" + raw(kRamp)));
    CHECK(inr.values == kRamp);
    CHECK(inr.spacing.z == 2);
}

TEST_CASE("readRaster: errors name the file and what is wrong", "[io][error]") {
    const test::TemporaryFolder folder;
    const auto refused = [&](const std::string& name, const std::string& content, ErrorCode code,
                             const std::string& words) {
        const test::Thrown thrown = reading(folder.write(name, content), 1000000000);
        CAPTURE(name, words, thrown.message);
        CHECK(thrown.code == int(code));
        CHECK(test::contains(thrown.message, name));
        CHECK(test::contains(thrown.message, words));
    };
    refused("a.bmp", "BM", ErrorCode::InvalidOption, "unknown extension");
    refused("a.png", "", ErrorCode::BadData, "empty");
    refused("a.png", "\x89PNG nonsense", ErrorCode::BadData, "not a whole PNG");
    refused("a.jpg", "nonsense", ErrorCode::BadData, "not a whole JPEG");
    refused("a.exr", "nonsense", ErrorCode::BadData, "not an OpenEXR");
    refused("a.tif", "nonsense", ErrorCode::BadData, "not a TIFF");
    refused("a.pgm", "P7\n", ErrorCode::BadData, "not a pgm");
    refused("a.pgm", "P5 1000000 1000000 255\n", ErrorCode::BadData, "truncated");
    refused("a.npy", "\x93NUMPY", ErrorCode::BadData, "not an npy");
    refused("a.npy", test::npy("<f4", "(1000000, 1000000)", ""), ErrorCode::BadData, "truncated");
    refused("a.npy", test::npy("<c8", "(1, 1)", "12345678"), ErrorCode::BadData, "type 'c8'");
    refused("a.npy", test::npy("<f4", "(4,)", "0123456789012345"), ErrorCode::BadData, "1 dimensions");
    refused("a.nii", std::string(400, '\0'), ErrorCode::BadData, "not a NIfTI");
    refused("a.nii", test::nifti(20, 20, 20, "", std::vector<float>(12, 1.f)), ErrorCode::BadData,
            "truncated");
    refused("a.vti", "<VTKFile><ImageData>", ErrorCode::BadData, "XML");
    refused("a.vti", test::vti("0 2 0 1 0 0", "", "type=\"UInt8\" format=\"binary\"", "AAAA"),
            ErrorCode::BadData, "truncated");
    refused("a.sgems", "100 100 100\n1\nv\n1\n", ErrorCode::BadData, "truncated");
    refused("a.inr", "#INRIMAGE-4#{\n", ErrorCode::BadData, "not an INRIMAGE");
    refused("a.tif", test::tiff(3, 1, 8, 1, {"abc", "abc"}).substr(0, 60), ErrorCode::BadData, "TIFF");
    CHECK(reading(folder.path("none.png")).code == int(ErrorCode::Io));
    CHECK(reading(folder.write("big.pgm", test::pgm(2000, 2000, 255, std::string(4000000, 'a'))), 1000000)
              .code == int(ErrorCode::Memory));
}

TEST_CASE("readRaster: sizes in headers whose product wraps or is no number are refused",
          "[io][regression]") {
    const test::TemporaryFolder folder;
    const auto refused = [&](const std::string& name, const std::string& content) {
        const test::Thrown thrown = reading(folder.write(name, content), 1000000000);
        CAPTURE(name, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, name));
    };
    const std::string bytes(4096, '\1');
    refused("a.npy", test::npy("<f4", "(1099511627776, 1099511627776, 1099511627776)", bytes));
    refused("b.npy", test::npy("<f8", "(2147483648, 2147483648, 1)", bytes));
    for (const char* sides : {"9223372036854775807 2 1", "4294967296 4294967296 1", "-1 -1 1", "-4 4 -4"})
        refused("c.sgems", sides + std::string("\n1\nv\n") + std::string(4096, '1'));
    refused("d.inr",
            "#INRIMAGE-4#{\nXDIM=4294967296\nYDIM=4294967296\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\n##}\n" +
                bytes);
    refused("e.inr", "#INRIMAGE-4#{\nXDIM=-64\nYDIM=-64\nZDIM=1\nTYPE=float\nPIXSIZE=32 bits\n##}\n" + bytes);
    refused("f.pgm", "P5 4294967296 4294967296 255\n" + bytes);
    refused("g.pgm", "P5 9223372036854775807 1 255\n" + bytes);
    for (const char* extent : {"0 1e30 0 -1e30 0 0", "0 nan 0 1 0 1", "-1e30 1e30 0 0 0 0", "5 0 5 0 0 0"})
        refused("h.vti", test::vti(extent, "", "type=\"UInt8\" format=\"ascii\"", "1 2 3 4"));
    for (std::int64_t side : {std::int64_t(1) << 62, std::int64_t(-1), INT64_MAX}) {
        std::string nifti(600, '\0');
        const auto put = [&](std::size_t at, auto value) { std::memcpy(&nifti[at], &value, sizeof value); };
        put(0, std::int32_t(540));
        put(12, std::int16_t(16));
        for (std::size_t i = 0; i < 8; ++i) put(16 + 8 * i, i == 0 ? std::int64_t(3) : side);
        put(168, std::int64_t(544));
        refused("i.nii", nifti);
        put(40, std::int64_t(0));
        refused("i.nii", nifti);
    }
}

TEST_CASE("readRaster: a TIFF whose pixel size is of another type is read without it", "[io][regression]") {
    const test::TemporaryFolder folder;
    std::string bytes = test::tiff(2, 1, 16, 2, {"abcd"}, "-1", {3, 3, 0});
    const std::size_t tag = bytes.find("\x0e\x83\x0c");  // 33550, doubles
    REQUIRE(tag != std::string::npos);
    bytes[tag + 2] = 1;  // bytes
    CHECK_FALSE(readRaster(folder.write("a.tif", bytes)).knownSpacing);
}

TEST_CASE("readRaster: TIFF bands that are no opacity make no holes, white may be zero", "[io][regression]") {
    const test::TemporaryFolder folder;
    std::string bytes = test::tiff(2, 1, 8, 1, {std::string("\xc8\x00", 2)});
    const std::size_t photometric = bytes.find(std::string("\x06\x01\x03\x00\x01\x00\x00\x00\x01", 9));
    REQUIRE(photometric != std::string::npos);
    bytes[photometric + 8] = 0;
    CHECK(readRaster(folder.write("a.tif", bytes)).values == std::vector<float>{55, 255});
}

TEST_CASE("readRaster: a palette stack gives the numbers that are stored", "[io][regression]") {
    const test::TemporaryFolder folder;
    std::string bytes = test::tiff(3, 1, 8, 1, {std::string("\0\1\4", 3), std::string("\4\1\0", 3)});
    const std::string tag("\x06\x01\x03\x00\x01\x00\x00\x00\x01", 9);
    for (std::size_t at = 0; (at = bytes.find(tag, at)) != std::string::npos; ++at) bytes[at + 8] = 3;
    CHECK(readRaster(folder.write("a.tif", bytes)).values == std::vector<float>{0, 1, 4, 4, 1, 0});
}

TEST_CASE("readRaster: NIfTI voxels never begin in the header", "[io][regression]") {
    const test::TemporaryFolder folder;
    std::string bytes = test::nifti(2, 1, 1, std::string("\7\5", 2), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    const float none = 0;
    std::memcpy(&bytes[108], &none, 4);
    CHECK(readRaster(folder.write("a.nii", bytes)).values == std::vector<float>{7, 5});
}
