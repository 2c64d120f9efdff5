#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/io/readers/raster_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/tiff_maker.h"

using namespace vdbsynth;

namespace {

std::string bytesOf(const std::string& hex) {
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2) bytes += char(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
}

const std::string kTables =
    "ffd8ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d3042605565645f555d5b6a7899816a7190"
    "735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4";
// Grey, 24 x 16: 40 in the block at the top left, 120 in the other two of the top row, 200 below.
const std::string kGrey = kTables +
                          "ffc0000b080010001801011100ffc4001500010100000000000000000000000000000005ffc400"
                          "14100100000000000000000000000000000000ffda0008010100003f008ab02b83ffd9";
// Grey, 8 x 64: the row times 4.
const std::string kTall = kTables +
                          "ffc0000b080040000801011100ffc4001500010100000000000000000000000000000406ffc400"
                          "1510010100000000000000000000000000000013ffda0008010100003f009d995326654c999532"
                          "6654dfffd9";
const std::string kTallProgressive =
    kTables +
    "ffc2000b080040000801011100ffc4001500010100000000000000000000000000000305ffda00080101000000019ca8aa"
    "a8bfffc4001510010100000000000000000000000000000011ffda000801010001050288888888ffc40014100100000000"
    "0000000000000000000030ffda0008010100063f020fffc40014100100000000000000000000000000000030ffda000801"
    "0100013f21000fffda000801010000001033ffc40014100100000000000000000000000000000030ffda0008010100013f"
    "10000fffd9";
// Inks, 16 x 8, by Adobe's marker: magenta and yellow at the left (red), half of black at the right.
const std::string kInks =
    "ffd8ffee000e41646f626500640000000000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d3042"
    "605565645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc0001408000800100443"
    "11004d11005911004b1100ffc400160001010100000000000000000000000000060700ffc4001410010000000000000000"
    "000000000000000000ffda000e0443004d0059004b00003f004c32324cca629832ffd9";

// With another marker before the rest.
std::string withMarker(const std::string& jpeg, int kind, const std::string& data) {
    test::TiffMaker maker;
    maker.bigEndian = true;
    return jpeg.substr(0, 2) + "\xff" + char(kind) + maker.number(data.size() + 2, 2) + data + jpeg.substr(2);
}

std::string exif(int orientation, bool bigEndian) {
    test::TiffMaker maker;
    maker.bigEndian = bigEndian;
    return std::string("Exif\0\0", 6) + (bigEndian ? "MM" : "II") + maker.number(42, 2) + maker.number(8, 4) +
           maker.number(1, 2) + maker.number(274, 2) + maker.number(3, 2) + maker.number(1, 4) +
           maker.number(std::uint64_t(orientation), 2) + maker.number(0, 6);
}

Raster read(const std::string& content, const RunContext& ctx = {}) {
    return readJpeg("a.jpg", content, {}, ctx);
}

bool near(float value, float right) {
    return std::abs(value - right) < 12;
}

}  // namespace

TEST_CASE("readJpeg: upright without EXIF, and turned as EXIF says in either byte order", "[io][oracle]") {
    const Raster stored = read(bytesOf(kGrey));
    REQUIRE(stored.size == Index3{24, 16, 1});
    REQUIRE(near(stored.at(3, 3, 0), 40));
    REQUIRE(near(stored.at(20, 3, 0), 120));
    REQUIRE(near(stored.at(3, 12, 0), 200));
    // Where the dark block, the top left one of the stored rows, is to be seen.
    const Index3 dark[9] = {{},        {3, 3, 0},  {20, 3, 0},  {20, 12, 0}, {3, 12, 0},
                            {3, 3, 0}, {12, 3, 0}, {12, 20, 0}, {3, 20, 0}};
    for (int orientation = 1; orientation <= 8; ++orientation)
        for (const bool bigEndian : {false, true}) {
            test::Said said;
            const Raster raster =
                read(withMarker(bytesOf(kGrey), 0xe1, exif(orientation, bigEndian)), said.ctx);
            CAPTURE(orientation, bigEndian);
            CHECK(raster.size == (orientation > 4 ? Index3{16, 24, 1} : Index3{24, 16, 1}));
            const Index3& p = dark[orientation];
            CHECK(near(raster.at(p.x, p.y, 0), 40));
            CHECK(said.all() == (orientation == 1 ? ""
                                                  : "a.jpg: turned upright as its EXIF orientation " +
                                                        std::to_string(orientation) + " says\n"));
        }
}

TEST_CASE("readJpeg: EXIF behind other markers, damaged or none", "[io][error]") {
    const std::string xmp = std::string("http://ns.adobe.com/xap/1.0/") + '\0' + "<x/>";
    const std::string turned = withMarker(bytesOf(kGrey), 0xe1, exif(6, true));
    CHECK(read(withMarker(turned, 0xe1, xmp)).size == Index3{16, 24, 1});
    CHECK(read(withMarker(turned, 0xe0, std::string("JFIF\0\1\1\0\0\1\0\1\0\0", 14))).size ==
          Index3{16, 24, 1});
    CHECK(read(withMarker(bytesOf(kGrey), 0xe1, exif(0, true))).size == Index3{24, 16, 1});
    const std::string whole = exif(6, false);
    for (std::size_t length = 0; length < 26; ++length)
        CHECK(read(withMarker(bytesOf(kGrey), 0xe1, whole.substr(0, length))).size == Index3{24, 16, 1});
    test::Said said;
    read(withMarker(bytesOf(kGrey), 0xe1, exif(77, true)), said.ctx);
    CHECK(test::contains(said.all(), "EXIF orientation 77 is none"));
}

TEST_CASE("readJpeg: damage from which libjpeg goes on is a warning", "[io][regression]") {
    // Bytes between two markers.
    std::string bytes = bytesOf(kGrey);
    bytes.insert(bytes.find("\xff\xc0"), "rubbish");
    test::Said said;
    CHECK(read(bytes, said.ctx).values == read(bytesOf(kGrey)).values);
    REQUIRE(said.warnings.size() == 1);
    CHECK(test::contains(said.warnings[0], "7 extraneous bytes"));
    CHECK_FALSE(test::contains(said.warnings[0], "missing"));
    // Only the end marker is missing: nothing is lost.
    test::Said open;
    CHECK(read(bytesOf(kTall.substr(0, kTall.size() - 4)), open.ctx).values == read(bytesOf(kTall)).values);
    CHECK(open.warnings.size() == 1);
}

TEST_CASE("readJpeg: of a truncated image what is there is read, and what is missing is said",
          "[io][regression]") {
    const Raster whole = read(bytesOf(kTall));
    REQUIRE(near(whole.at(0, 60, 0), 240));
    test::Said said;
    const Raster part = read(bytesOf(kTall.substr(0, kTall.size() - 16)), said.ctx);
    CHECK(part.size == whole.size);
    CHECK(near(part.at(0, 10, 0), 40));
    CHECK_FALSE(near(part.at(0, 60, 0), 240));
    REQUIRE(said.warnings.size() == 1);
    CHECK(test::contains(said.warnings[0], "Premature end"));
    CHECK(test::contains(said.warnings[0], "of 64 on, parts may be missing"));
    test::Said later;
    CHECK(near(read(bytesOf(kTallProgressive.substr(0, kTallProgressive.find("88888888") + 4)), later.ctx)
                   .at(0, 60, 0),
               240));
    REQUIRE(later.warnings.size() == 1);
    CHECK(test::contains(later.warnings[0], "later passes"));
    // No pixel at all.
    const test::Thrown thrown =
        test::thrownBy([&] { read(bytesOf(kTall.substr(0, kTall.find("9d99532")))); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "truncated"));
}

TEST_CASE("readJpeg: any length and any changed byte gives an image or an error", "[io][hostile]") {
    for (const std::string& hex : {kGrey, kTall, kTallProgressive, kInks}) {
        const std::string whole = withMarker(bytesOf(hex), 0xe1, exif(6, true));
        RunContext ctx;
        ctx.maxMemory = 100000000;
        for (std::size_t at = 0; at < whole.size(); ++at) {
            std::string changed = whole;
            changed[at] = char(changed[at] ^ 0x5a);
            for (const std::string& bytes : {whole.substr(0, at), changed}) {
                const test::Thrown thrown = test::thrownBy([&] { read(bytes, ctx); });
                const bool good = thrown.code == -1 || thrown.code == int(ErrorCode::BadData) ||
                                  thrown.code == int(ErrorCode::Memory);
                CHECK(good);
            }
        }
    }
}

TEST_CASE("readJpeg: inks become colours, Adobe's and others", "[io][oracle]") {
    test::Said said;
    const Raster raster = read(bytesOf(kInks), said.ctx);
    REQUIRE(raster.size == Index3{16, 8, 1});
    REQUIRE(raster.channels == 3);
    CHECK(near(raster.values[0], 255));
    CHECK(near(raster.values[1], 0));
    CHECK(near(raster.values[2], 0));
    const std::size_t right = 3 * 12;
    for (std::size_t c = 0; c < 3; ++c) CHECK(near(raster.values[right + c], 127));
    REQUIRE(said.notes.size() == 1);
    CHECK(test::contains(said.notes[0], "CMYK"));
    // Without Adobe's marker (18 bytes) the stored numbers are of ink, not of what it leaves of white.
    const std::string plain = bytesOf(kInks).erase(2, 16);
    const Raster other = read(plain);
    CHECK(near(other.values[0], 0));
    CHECK(near(other.values[right], 0));
}
