#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

struct Read {
    MeshContent content;
    std::vector<std::string> said;
};
Read read(const std::string& text) {
    Read result;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& line) { result.said.push_back(line); };
    result.content = readObj("a.obj", text, ctx);
    return result;
}
std::vector<std::uint32_t> cornersOf(const std::string& text) {
    const Read result = read(text);
    CHECK(result.said.empty());
    return result.content.polygons.corners;
}
using Corners = std::vector<std::uint32_t>;

// The one message.
std::string saidOf(const std::string& text) {
    const Read result = read(text);
    REQUIRE(result.said.size() == 1);
    return result.said[0];
}

void refuses(const std::string& text, const std::string& says, ErrorCode code = ErrorCode::BadData) {
    CAPTURE(text);
    const test::Thrown thrown = test::thrownBy([&] { read(text); });
    CHECK(thrown.code == int(code));
    CAPTURE(thrown.message);
    CHECK(test::contains(thrown.message, "a.obj"));
    CHECK(test::contains(thrown.message, says));
    CHECK(std::all_of(thrown.message.begin(), thrown.message.end(),
                      [](char c) { return c >= ' ' && c < 127; }));
}

}  // namespace

TEST_CASE("readObj: corners in every way that programs write them", "[io][hand]") {
    for (const char* face : {"f 1 2 3",
                             "f 1/ 2/ 3/",
                             "f 1// 2// 3//",
                             "f 1/1 2/1 3/1",
                             "f 1/1/ 2/1/ 3/1/",
                             "f 1//1 2//1 3//1",
                             "f 1/1/1 2/1/1 3/1/1",
                             "f 1/0/0 2/0/0 3/0/0",
                             "f -3 -2 -1",
                             "f -3/-1/-1 2//-1 +3",
                             "F 1 2 3",
                             "fo 1 2 3",
                             "FO 1 2 3",
                             "f\t1\t2 3  ",
                             "  f 1 2 3",
                             "f 1 2 3 # 4",
                             "f 1 2 3#4",
                             "f 1.0 2e0 3",
                             "f 1 2 3 \\",
                             "f 1 2 \\\n3",
                             "f 1 \\\r\n2 \\ \r\n3",
                             "f 1/9/9 2//9 3//9\nvt 0 0\nvt 0 0\nvt 0 0\nvt 0 0\nvt 0 0\n"
                             "vt 0 0\nvt 0 0\nvt 0 0"}) {
        CAPTURE(face);
        CHECK(cornersOf(kThree + "vt 0.5 0.5\nvn 0 0 1\n" + face) == Corners{0, 1, 2});
    }
    CHECK(cornersOf("f 1 2 3\n" + kThree) == Corners{0, 1, 2});
    CHECK(cornersOf(kThree + "f 1 2 4\nf -1 1 5\nv 1 1 1\nv 2 2 2\n") == Corners{0, 1, 3, 2, 0, 4});
}

TEST_CASE("readObj: line ends, byte order mark and upper case", "[io][hand]") {
    const std::string text =
        "# made by hand\nmtllib a b.mtl\no thing\nV 0 0 0\nv 1 0 0\nv 0 1 0\nVT 0 0\nVN 0 0 1\n"
        "g a b\ns off\nusemtl none\nf 1 2 3\n";
    const auto ends = [&](const std::string& end) {
        std::string changed;
        for (const char c : text) changed += c == '\n' ? end : std::string(1, c);
        return changed;
    };
    for (const char* end : {"\n", "\r\n", "\r", "\r\r\n"})
        for (const char* mark : {"", "\xef\xbb\xbf"}) CHECK(cornersOf(mark + ends(end)) == Corners{0, 1, 2});
    CHECK(cornersOf("# C:\\models\\\nv 0 0 0\ng x\\\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") == Corners{0, 1, 2});
    refuses("\xff\xfev", "UTF-16");
    refuses("\xfe\xff", "UTF-16");
}

TEST_CASE("readObj: a face of any number of corners", "[io][property]") {
    for (const std::size_t n : {3u, 4u, 255u, 256u, 257u, 400u, 511u, 512u, 65535u, 65536u, 70000u}) {
        std::string text, face = "f";
        for (std::size_t i = 1; i <= n; ++i) {
            text += "v " + std::to_string(i) + " 0 0\n";
            face += " " + std::to_string(i) + "//1";
        }
        const MeshContent content = read(text + face + "\n" + face + "\n").content;
        REQUIRE(content.polygons.sizes == std::vector<std::uint32_t>(2, std::uint32_t(n)));
        CHECK(content.polygons.corners[n - 1] == n - 1);
        CHECK(content.polygons.corners[n] == 0);
    }
}

TEST_CASE("readObj: vertices with weights, colours and other numbers", "[io][hand]") {
    const auto vertices = [](const std::string& rest) {
        return "v 0 0 0" + rest + "\nv 1 0 0" + rest + "\nv 0 1 0" + rest + "\nf 1 2 3\n";
    };
    CHECK(cornersOf(vertices(" 1.0")) == Corners{0, 1, 2});
    CHECK(saidOf(vertices(" 0.5")) == "a.obj: 3 weights of vertices (v x y z w) left out");
    CHECK(findAttribute(read(vertices(" 1 0.5 0.25")).content.attributes, "Cd")->values[1] == 0.5f);
    CHECK(findAttribute(read(vertices(" 1 0.5 0.25 1")).content.attributes, "Cd")->values[2] == 0.25f);
    CHECK(test::contains(saidOf(vertices(" 1 0.5 0.25 1")), "3 vertices with numbers that are neither"));
    CHECK(read(vertices(" 1 0.5")).content.attributes.empty());
    CHECK(test::contains(saidOf("v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0\nf 1 2 3\n"),
                         "2 of 3 vertices have colours; those are left out"));
    const MeshContent far = read("v 665187.5220 5648349.8950 243.7680\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").content;
    CHECK(far.points[0].y == 5648349.8950);
}

TEST_CASE("readObj: coordinates that are not finite matter only where faces use them", "[io][hand]") {
    for (const char* bad : {"nan 0 0", "0 -nan 0", "0 0 inf", "0 nan(ind) 0", "-nan(ind) 0 0", "1.#QNAN 0 0",
                            "0 -1.#IND00 0", "0 0 1.#INF", "1e39 0 0", "1e999 0 0"}) {
        CAPTURE(bad);
        const MeshContent content = read(kThree + "v " + bad + "\nf 1 2 3\n").content;
        REQUIRE(content.points.size() == 4);
        const Vec3d& p = content.points[3];
        CHECK_FALSE(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e38);
        refuses(kThree + "v " + bad + "\nf 1 2 4\n", "a.obj:4: a coordinate is not a finite number");
    }
}

TEST_CASE("readObj: what is left out is said", "[io][hand]") {
    const std::string face = kThree + "f 1 2 3\n";
    CHECK(saidOf(face + "l 1 2\nl 2 3\np 1\n") ==
          "a.obj: 3 points and lines (p, l) left out; only faces are read");
    CHECK(test::contains(saidOf(face + "cstype bspline\ndeg 3 3\nsurf 0 1 0 1 1 2 3\nparm u 0 1\nend\n"),
                         "1 free-form curves and surfaces"));
    CHECK(test::contains(saidOf(face + "call other.obj\n"), "1 other files (call) left out"));
    CHECK(test::contains(saidOf(face + "what is this\n\x80\x81\n"), "2 lines that OBJ does not know"));
    CHECK(test::contains(saidOf(kThree + "vt 0 0\nf 1/1 2/2 3/-9\n"), "2 corners with texture coordinates"));
    CHECK(test::contains(saidOf(kThree + "vt nan 0\nf 1/1 2/1 3/1\n"), "texture coordinates that are not"));
    CHECK(test::contains(saidOf(kThree + "vt x 0\nf 1/1 2/1 3/1\n"), "texture coordinates that are not"));
    const std::string ignored =
        "vp 0 0\nmg 1 2\nbevel on\nlod 2\nc_interp on\nshadow_obj a\ns 1\nstep 1 2\ntrim 0 1 1\nsp 1\n";
    CHECK(cornersOf(face + ignored) == Corners{0, 1, 2});
}

TEST_CASE("readObj: errors name the line and what helps", "[io][error]") {
    refuses(kThree + "f 1 0 2\n", "a.obj:4: line 4 has a face with vertex 0");
    refuses(kThree + "f 1 -0 2\n", "vertex 0");
    refuses(kThree + "f 1 2 -4\n", "a.obj:4: a face uses vertex -4, but only 3 are above it");
    refuses(kThree + "f 1 2 3\n\nf 1 2 9 5\nf 1 2 10\n", "a.obj:6: a face uses vertex 8 of 3");
    refuses(kThree + "f 1 2 4294967297\n", "a.obj:4: a face uses vertex 4294967297");
    refuses(kThree + "f 1 2 99999999999999999999\n", "a.obj:4: a corner of a face is not a whole number");
    refuses(kThree + "f 1 2 1.5\n", "not a whole number");
    refuses(kThree + "f 1 2 x\n", "not a whole number");
    refuses(kThree + "f 1 2 3/x\n", "not a whole number");
    refuses(kThree + "f 1/1/1/1 2 3\n", "more than three numbers");
    refuses(kThree + "f / 2 3\n", "vertex 0");
    refuses("v 0,5 1,25 2\n", "a.obj:1: a comma in a coordinate");
    refuses("v 1, 2, 3\n", "decimal points");
    refuses("v 1 2\n", "fewer than three coordinates");
    refuses("v 1 2 \x90\x91\n", "a coordinate is not a number");
    refuses(kThree, "no faces, only vertices", ErrorCode::EmptyInput);
    refuses(kThree + "l 1 2\n", "no faces, only points and lines", ErrorCode::EmptyInput);
    refuses(kThree + "surf 0 1 0 1 1 2 3\n", "only free-form");
    refuses("# nothing\n", "no faces", ErrorCode::EmptyInput);
    refuses(std::string("L\x01\x02\0\x80\n", 6), "not an OBJ file");
    refuses("<html>\n", "not an OBJ file");
}

TEST_CASE("readObj: the same mesh in many dialects", "[io][property]") {
    const auto text = [](std::uint64_t seed) {
        Random random(seed, 0);
        const auto pick = [&](int n) { return int(random.uniform(0, n)); };
        const Mesh ball = test::sphereMesh(1, 1);
        const char* ends[] = {"\n", "\r\n", "\r"};
        const std::string end = ends[pick(3)];
        const bool facesFirst = pick(2) == 0, negative = pick(2) == 0 && !facesFirst;
        const char* slashes[] = {"", "/", "//", "/1", "/1/", "//1", "/1/1"};
        std::string vertices, faces;
        for (const Vec3f& p : ball.points)
            vertices += (pick(2) ? "v " : "V\t") + std::to_string(p.x) + "  " + std::to_string(p.y) + " " +
                        std::to_string(p.z) + (pick(2) ? " 1.0" : "") + (pick(2) ? " # note" : "") + end;
        for (const Triangle& t : ball.triangles) {
            faces += pick(5) ? "f" : "fo";
            for (const std::uint32_t corner : t)
                faces += (pick(4) ? " " : " \\" + end) +
                         std::to_string(negative ? int(corner) - int(ball.points.size()) : int(corner) + 1) +
                         slashes[pick(7)];
            faces += end;
        }
        const std::string rest = "vt 0 0" + end + "vn 0 0 1" + end;
        return facesFirst ? faces + rest + vertices : vertices + rest + faces;
    };
    const std::size_t faces = test::sphereMesh(1, 1).triangles.size();
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        CAPTURE(seed);
        const MeshSummary summary = summarize(meshOf("a.obj", readObj("a.obj", text(seed)), {}));
        CHECK(summary.faces == faces);
        CHECK(summary.closedManifold());
        CHECK(summary.signedVolume == Approx(summarize(test::sphereMesh(1, 1)).signedVolume).epsilon(1e-5));
    }
}
