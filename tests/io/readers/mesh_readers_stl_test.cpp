#include <catch2/catch.hpp>

#include <limits>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/stl_files.h"

using namespace vdbsynth;

namespace {

const std::vector<test::StlFacet> kBox = test::boxFacets();

// Reads the box of 12 triangles from what may also hold other things.
void requireBox(const std::string& content, test::Said& said) {
    const MeshSummary box = summarize(meshOf("a.stl", readStl("a.stl", content, said.ctx), said.ctx));
    CHECK(box.vertices == 8);
    CHECK(box.faces == 12);
    CHECK(box.closedManifold());
    CHECK(box.signedVolume == Approx(24));
}

test::Thrown refused(const std::string& content) {
    return test::thrownBy([&] { readStl("a.stl", content); });
}

}  // namespace

TEST_CASE("readStl: a whole binary file, whatever its header says", "[io][oracle]") {
    for (const char* header : {"", "solid", "solid facet normal 0 0 0", "COLOR=", "\xFF\xFE"}) {
        CAPTURE(header);
        test::Said said;
        requireBox(test::binaryStl(kBox, 12, false, header), said);
        CHECK(said.nothing());
    }
}

TEST_CASE("readStl: a wrong count gives way to the size of the file", "[io][oracle]") {
    for (const std::uint32_t count : {0u, 0xFFFFFFFFu}) {
        test::Said said;
        requireBox(test::binaryStl(kBox, count), said);
        CHECK(said.noted("a.stl: the header claims " + std::to_string(count) +
                         " triangles, the size of the file says 12 triangles, which are read"));
    }
    for (const std::uint32_t count : {1u, 5u, 11u}) {
        test::Said said;
        requireBox(test::binaryStl(kBox, count), said);
        CHECK(said.warned("the size of the file says 12 triangles"));
    }
    for (const std::uint32_t count : {13u, 999u, 0x20202020u}) {
        test::Said said;
        requireBox(test::binaryStl(kBox, count), said);
        CHECK(said.warned("the file has 12 triangles, which are read: they are a closed surface"));
    }
    test::Said said;
    requireBox(test::binaryStl(kBox, 0) + "x", said);
    CHECK(said.noted("the size of the file says 12"));
    CHECK(said.noted("1 byte behind the last of 12 triangles left out"));
}

TEST_CASE("readStl: bytes behind the triangles are said, not read", "[io][oracle]") {
    const std::string noise =
        "metadata: exported by a program that adds a long line of text at the end of its files";
    for (const std::string& behind : {std::string("x"), std::string(22, '\0'), std::string(50, '\0'),
                                      std::string(512, '\0'), noise, noise + noise + noise}) {
        CAPTURE(behind.size());
        test::Said said;
        requireBox(test::binaryStl(kBox, 12) + behind, said);
        CHECK(said.noted(countText(behind.size(), "byte") + " behind the last of 12 triangles left out"));
        CHECK(said.warnings.empty());
        test::Said solid;
        requireBox(test::binaryStl(kBox, 12, false, "solid x") + behind, solid);
    }
}

TEST_CASE("readStl: a truncated binary file says how many triangles are there", "[io][error]") {
    const std::string whole = test::binaryStl(kBox, 12);
    for (std::size_t size = 84; size < whole.size(); ++size) {
        const test::Thrown thrown = refused(whole.substr(0, size));
        CAPTURE(size, thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(
            test::contains(thrown.message, "truncated, or not an STL file: the header claims 12 triangles, " +
                                               std::to_string((size - 84) / 50) + " of them are there"));
    }
    for (std::size_t size = 1; size < 84; ++size)
        CHECK(test::contains(refused(whole.substr(0, size)).message, "not an STL file"));
}

TEST_CASE("readStl: big-endian numbers", "[io][oracle]") {
    for (const std::uint32_t count : {12u, 0u, 7u}) {
        test::Said said;
        requireBox(test::binaryStl(kBox, count, true), said);
        CHECK(said.noted("big-endian"));
    }
    test::Said said;
    requireBox(test::binaryStl(kBox, 12, true) + "tail", said);
    CHECK(said.noted("4 bytes behind"));
}

TEST_CASE("readStl: binary solids one after the other", "[io][oracle]") {
    const std::vector<test::StlFacet> first(kBox.begin(), kBox.begin() + 5),
        second(kBox.begin() + 5, kBox.end());
    test::Said said;
    requireBox(test::binaryStl(first, 5) + test::binaryStl(second, 7, false, "solid two"), said);
    CHECK(said.noted("2 binary solids one after the other"));
}

TEST_CASE("readStl: attribute words are not read, which is said", "[io][oracle]") {
    test::Said said;
    requireBox(test::binaryStl(kBox, 12, false, "COLOR=\xFF\x80\x10\xFF", "\x1F\x80"), said);
    CHECK(said.noted("12 triangles with attribute words, such as colours, which are not read"));
}

TEST_CASE("readStl: facets that are not finite", "[io][degenerate]") {
    std::vector<test::StlFacet> facets = kBox;
    facets[3][1][2] = std::numeric_limits<float>::quiet_NaN();
    test::Said said;
    const MeshContent mesh = readStl("a.stl", test::binaryStl(facets, 12), said.ctx);
    CHECK(mesh.polygons.sizes.size() == 11);
    CHECK(said.warned("1 of 12 triangles have a coordinate that is not a finite number; they are left out"));
    for (test::StlFacet& facet : facets) facet[0][0] = std::numeric_limits<float>::infinity();
    CHECK(test::contains(refused(test::binaryStl(facets, 12)).message, "12 of 12 triangles"));
    CHECK(refused(test::binaryStl(facets, 0)).code == int(ErrorCode::BadData));
}

TEST_CASE("readStl: other files", "[io][error]") {
    CHECK(test::contains(refused("ply\nformat ascii 1.0\n").message,
                         "it is text that does not begin with solid"));
    CHECK(
        test::contains(refused(std::string(500, 'x')).message, "it is text that does not begin with solid"));
    CHECK(test::contains(refused(std::string(200, '\0')).message, "are not triangles"));
    CHECK(refused(std::string("PK\3\4", 4) + std::string(300, '\x90') + std::string(9, '\0')).code ==
          int(ErrorCode::BadData));
    CHECK(readStl("a.stl", std::string(84, '\0')).polygons.sizes.empty());
}
