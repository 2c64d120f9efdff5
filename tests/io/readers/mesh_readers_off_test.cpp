#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/stl_files.h"

using namespace vdbsynth;
using test::replaced;

namespace {

const char* const kVertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const char* const kFaces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

void requireTetrahedron(const std::string& content, const RunContext& ctx) {
    const MeshSummary solid = summarize(meshOf("a.off", readOff("a.off", content, ctx), ctx));
    CHECK(solid.vertices == 4);
    CHECK(solid.faces == 4);
    CHECK(solid.closedManifold());
    CHECK(solid.signedVolume == Approx(1 / 6.0));
}

}  // namespace

TEST_CASE("readOff: dialects that say the same give the same, without a word", "[io][oracle]") {
    const std::string body = std::string(kVertices) + kFaces, plain = "OFF\n4 4 6\n" + body;
    const std::vector<std::string> all{
        plain,
        "off\n4 4 6\n" + body,
        "OFF4 4 6\n" + body,
        " \t  OFF4 4 6 # glued\n" + body,
        "OFF 4 4 6\n" + body,
        "OFF\n4 4\n" + body,
        "OFF\n4\n4\n6\n" + body,
        "\n\n# a comment\n" + plain,
        "\xEF\xBB\xBF" + plain,
        replaced(plain, "\n", "\r\n"),
        replaced(plain, "\n", "\r"),
        replaced(plain, "\n", "\n\n# between\n"),
        replaced(plain, "\n", " "),
        "nOFF\n3\n4 4 6\n" + body,
        "STOFF\n4 4 6\n" + replaced(kVertices, "\n", " 0.5 0.5\n") + kFaces,
        "NOFF\n4 4 6\n" + replaced(kVertices, "\n", " 0 0 1\n") + kFaces,
        "COFF\n4 4 6\n" + replaced(kVertices, "\n", " 255 0 1 255\n") + kFaces,
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);
        test::Said said;
        requireTetrahedron(all[i], said.ctx);
        CHECK(said.nothing());
    }
}

TEST_CASE("readOff: what is guessed or left out is said", "[io][error]") {
    const std::string body = std::string(kVertices) + kFaces;
    {
        test::Said said;
        requireTetrahedron("4 4 6\n" + body, said.ctx);
        CHECK(said.noted("a.off: does not begin with OFF"));
    }
    {
        test::Said said;
        requireTetrahedron("OFF\n4 4 6\n" + std::string(kVertices) + replaced(kFaces, "\n", " 255 0 0\n"),
                           said.ctx);
        CHECK(said.noted("colours of 4 faces are not read"));
    }
    {
        test::Said said;
        requireTetrahedron("OFF\n4 4 6\n" + replaced(kVertices, "\n", " 255 0 0\n") + kFaces, said.ctx);
        CHECK(said.noted("numbers behind x y z of 4 vertices are not read"));
    }
    {
        test::Said said;
        requireTetrahedron("OFF\n4 4 6\n" + body + "3 0 1 2\n", said.ctx);
        CHECK(said.warned("what stands behind the last of 4 faces, from line 11 on, is not read"));
    }
    {
        test::Said said;  // vertices without coordinates that no face uses
        requireTetrahedron("OFF\n6 4 0\n" + std::string(kVertices) + "nan nan nan\n1.#QNAN 0 0\n" + kFaces,
                           said.ctx);
        CHECK(said.noted("2 vertices without finite coordinates"));
    }
}

TEST_CASE("readOff: errors name what is wrong", "[io][error]") {
    const std::pair<std::string, std::string> all[] = {
        {"HOFF\n", "not an OFF file"},
        {"OFFSET 1 2\n", "not an OFF file"},
        {"ply\n", "not an OFF file"},
        {"OFF9999999999999nOFF 1 1", "is not a whole number"},
        {"\x01\x02\xFFxyz", "not an OFF file"},
        {"4OFF\n1 0 0\n", "4-dimensional"},
        {"C4nOFF 3\n1 0 0\n", "4-dimensional"},
        {"nOFF\n5\n1 0 0\n", "5-dimensional"},
        {"OFF BINARY\n\1\2\3", "binary OFF is not supported; convert it"},
        {"off binary\n", "binary OFF is not supported"},
        {"COFF BINARY\n", "binary OFF is not supported"},
        {"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1", "truncated"},
        {"OFF\n4 4 0\n" + std::string(kVertices) + "3 0 1 2\n", "truncated: 1 of 4 faces are there"},
        {"OFF\n5 4 0\n" + std::string(kVertices) + kFaces, "truncated: 3 of 4 faces are there"},
        {"OFF\n4 1 0\n" + std::string(kVertices) + "3 0 1 4\n", "vertex 4 of 4 does not exist"},
        {"OFF\n4 1 0\n" + std::string(kVertices) + "99999999 0 1 2\n", "a face of 99999999 corners"},
        {"999999999999 3 0\n", "more than the file can hold"},
        {"OFF\n-4 1 0\n", "more than the file can hold"},
    };
    for (const auto& [content, says] : all) {
        CAPTURE(content);
        const test::Thrown thrown = test::thrownBy([&, &content = content] { readOff("a.off", content); });
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, says));
    }
}
