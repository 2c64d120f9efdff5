#include "libvdbsynth/io/readers/stl_text.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/stl_files.h"

using namespace vdbsynth;
using test::replaced;

namespace {

MeshSummary summaryOf(const std::string& content, const RunContext& ctx = {}) {
    return summarize(meshOf("a.stl", readStl("a.stl", content, ctx), ctx));
}

void requireBox(const std::string& content, const RunContext& ctx = {}) {
    const MeshSummary box = summaryOf(content, ctx);
    CHECK(box.vertices == 8);
    CHECK(box.faces == 12);
    CHECK(box.closedManifold());
    CHECK(box.signedVolume == Approx(24));
}

std::string upper(std::string text) {
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    return text;
}

}  // namespace

TEST_CASE("readStlText: dialects that say the same give the same, without a word", "[io][oracle]") {
    const std::string plain = test::asciiStl(), body = test::stlFacets(test::boxFacets());
    const std::vector<std::string> all{
        plain,
        upper(plain),
        replaced(replaced(plain, "endloop", "ENDLOOP"), "endsolid", "EndSolid"),
        replaced(replaced(replaced(plain, "endloop", "end loop"), "endfacet", "end facet"), "endsolid",
                 "end solid"),
        replaced(plain, "outer loop", "outerloop"),
        replaced(plain, "outer loop\n", "loop\n"),
        " \t" + plain,
        "\n\r\n  \n" + plain,
        "\xEF\xBB\xBF" + plain,
        replaced(plain, "\n", "\r\n"),
        replaced(plain, "\n", "\r"),
        replaced(plain, "\n", " "),
        replaced(plain, " ", "\t"),
        replaced(plain, "normal 0 0 0", "normal nan -nan(ind) 1.#QNAN"),
        replaced(plain, "normal 0 0 0", "normal"),
        "solid\n" + body + "endsolid\n",
        "solid\n" + body + "endsolid",
        "solid facet of a name\n" + body + "endsolid facet of a name\n",
        "solid a\nendsolid a\nsolid b\n" + body + "endsolid b\n",
        replaced(plain, "vertex 1 ", "vertex +1.0D+00 "),
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);
        CHECK(isStlText(all[i]));
        test::Said said;
        requireBox(all[i], said.ctx);
        CHECK(said.nothing());
    }
}

TEST_CASE("readStlText: several solids become one mesh", "[io][oracle]") {
    const std::vector<test::StlFacet> facets = test::boxFacets();
    const std::vector<test::StlFacet> first(facets.begin(), facets.begin() + 5),
        second(facets.begin() + 5, facets.end());
    requireBox("solid a\n" + test::stlFacets(first) + "endsolid a\nsolid b\n" + test::stlFacets(second) +
               "endsolid b\n");
    requireBox(replaced("solid a\n" + test::stlFacets(first) + "endsolid a\nsolid b\n" +
                            test::stlFacets(second) + "endsolid b\n",
                        "\n", " "));
}

TEST_CASE("readStlText: what is guessed or left out is said", "[io][error]") {
    const std::string plain = test::asciiStl(), body = test::stlFacets(test::boxFacets());
    const auto box = [](const std::string& content, test::Said& said) { requireBox(content, said.ctx); };
    {
        test::Said said;
        box("solid a\n" + body, said);
        CHECK(said.warned("a.stl: ends without endsolid; its 12 whole facets are read"));
    }
    {
        test::Said said;
        box(body + "endsolid\n", said);  // no first line
        CHECK(said.nothing());
    }
    {
        test::Said said;
        box(replaced(plain, "vertex 1 ", "vertex 1,0 "), said);
        CHECK(said.noted("decimal commas"));
    }
    {
        test::Said said;
        box(replaced(plain, "endloop\n", "endloop\nattribute \x1B 7\n"), said);
        CHECK(said.noted(
            "36 words that do not belong in an STL file are not read, the first \"attribute\" in line 8"));
    }
    {
        test::Said said;
        box(plain + "\x1A", said);  // the end of a file in DOS
        CHECK(said.noted("\"?\" in line"));
    }
    {
        test::Said said;
        box(std::string("solid a\0\0\n", 10) + body + "endsolid\n", said);
        CHECK(said.nothing());
    }
}

TEST_CASE("readStlText: facets of four corners, facets that are not finite", "[io][degenerate]") {
    test::Said said;
    const MeshContent quad =
        readStl("a.stl",
                "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
                "endfacet\nendsolid\n",
                said.ctx);
    CHECK(quad.polygons.sizes == std::vector<std::uint32_t>{4});
    CHECK(said.noted("1 facets of more than three vertices"));
    for (const char* word : {"nan", "-nan(ind)", "1.#QNAN", "inf", "1e40"}) {
        CAPTURE(word);
        test::Said unfinite;
        std::string content = test::asciiStl();
        content.replace(content.find("vertex 1"), 8, std::string("vertex ") + word);
        CHECK(summaryOf(content, unfinite.ctx).faces == 11);
        CHECK(unfinite.warned("1 of 12 triangles have a coordinate that is not a finite number"));
    }
}

TEST_CASE("readStlText: coordinates of surveys keep their decimals", "[io][oracle]") {
    std::string survey;
    // x to 500000.001 and .003: half a float's step apart would be one.
    survey = replaced(replaced(test::asciiStl(), "vertex 1 ", "vertex 500000.001 "), "vertex 3 ",
                      "vertex 500000.003 ");
    survey = replaced(replaced(survey, " 2 ", " 5600000.002 "), " 5 ", " 5600000.005 ");
    survey = replaced(replaced(survey, " 3\n", " 0.003\n"), " 7\n", " 0.007\n");
    const MeshContent mesh = readStl("a.stl", survey);
    CHECK(mesh.points.size() == 8);
    CHECK(summarize(meshOf("a.stl", mesh, {})).signedVolume == Approx(24e-9).epsilon(1e-3));
}

TEST_CASE("readStlText: errors name what is wrong and where", "[io][error]") {
    const std::string body = test::stlFacets(test::boxFacets());
    std::string many = "solid\nfacet\nouter loop\n";
    for (int i = 0; i < 101; ++i) many += "vertex 0 0 0\n";
    const std::pair<std::string, std::string> all[] = {
        {"solid a\n" + body + "facet normal 0 0 1\nouter loop\nvertex 0 0",
         "behind 12 whole facets; it is truncated"},
        {"solid a\n" + body + "facet normal 0 0 1\nouter", "behind 12 whole facets; it is truncated"},
        {"solid a\n" + body + "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0", "truncated"},
        {"solid a\n" + body + "fac", "behind 12 whole facets; it is truncated"},
        {"solid a\n", "truncated"},
        {"solid waste and other words\nof a letter\n", "\"of\" in line 2 does not belong in an STL file"},
        {"solid\nfacet\nouter loop\nendloop\nendfacet\nendsolid\n",
         "a.stl:4: a facet has fewer than three vertices"},
        {"solid\nfacet\nendfacet\nendsolid\n", "fewer than three"},
        {"solid\nfacet\nouter loop\nvertex 0 \xFF\x01 0\n", "\"?\?\" is not a number"},
        {"solid\nfacet\nouter loop\nvertex 1.000,5 0 0\n", "is not a number"},
        {many, "more than 100 vertices"},
        {std::string("\xFF\xFEs\0o\0l\0i\0d\0", 12), "UTF-16"},
    };
    for (const auto& [content, says] : all) {
        CAPTURE(says);
        const test::Thrown thrown = test::thrownBy([&, &content = content] { readStl("a.stl", content); });
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, says));
        CHECK(test::contains(thrown.message, "a.stl"));
    }
}

TEST_CASE("isStlText: only text that begins with solid or facet", "[io][fast]") {
    CHECK_FALSE(isStlText(""));
    CHECK_FALSE(isStlText("sol"));
    CHECK_FALSE(isStlText("solidus"));
    CHECK_FALSE(isStlText("hello solid"));
    CHECK_FALSE(isStlText(test::binaryStl(test::boxFacets(), 12, false, "solid box")));
    CHECK(isStlText("FACET NORMAL 0 0 1"));
}
