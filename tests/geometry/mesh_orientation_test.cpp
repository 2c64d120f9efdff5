#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/geometry/mesh.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

double volumeOf(const Mesh& mesh) {
    return summarize(mesh).signedVolume;
}

}  // namespace

TEST_CASE("isBalanced: closed and consistent, whatever touches", "[geometry][property]") {
    Mesh mesh = test::sphereMesh(1, 2);
    CHECK(edgeBalance(mesh) == EdgeBalance::Manifold);
    Mesh twice = mesh;  // four faces at every edge
    twice.triangles.insert(twice.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    CHECK(edgeBalance(twice) == EdgeBalance::Balanced);
    Mesh open = mesh;
    open.triangles.pop_back();
    CHECK_FALSE(isBalanced(open));
    Mesh turned = mesh;
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    CHECK_FALSE(isBalanced(turned));
    CHECK(isBalanced(Mesh{}));
    CHECK(isBalanced(test::boxMesh({0, 0, 0}, {1, 1, 1})));
}

TEST_CASE("weldVertices: a soup of triangles becomes one surface", "[geometry][property]") {
    const Mesh mesh = test::sphereMesh(1, 2);
    Mesh soup;
    for (const Triangle& t : mesh.triangles) {
        const std::uint32_t first = std::uint32_t(soup.points.size());
        for (std::uint32_t corner : t) soup.points.push_back(mesh.points[corner]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    CHECK_FALSE(isBalanced(soup));
    CHECK(weldVertices(soup) == soup.points.size() - mesh.points.size());
    CHECK(isBalanced(soup));
}

TEST_CASE(
    "orientFaces: a third of the faces turned comes back, an inside-out ball looks outward, a cavity stays",
    "[geometry][property]") {
    const Mesh ball = test::sphereMesh(1, 3);
    Mesh mixed = ball;
    for (std::size_t i = 0; i < mixed.triangles.size(); i += 3)
        std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
    CHECK(orientFaces(mixed) == (ball.triangles.size() + 2) / 3);
    CHECK(volumeOf(mixed) == Approx(volumeOf(ball)));
    CHECK(isBalanced(mixed));
    Mesh inverted = ball;
    for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
    CHECK(orientFaces(inverted) == ball.triangles.size());
    CHECK(volumeOf(inverted) == Approx(volumeOf(ball)));
    Mesh hollow = ball;
    const Mesh inner = test::sphereMesh(0.5f, 2);
    const std::uint32_t shift = std::uint32_t(hollow.points.size());
    hollow.points.insert(hollow.points.end(), inner.points.begin(), inner.points.end());
    for (const Triangle& t : inner.triangles)
        hollow.triangles.push_back({t[1] + shift, t[0] + shift, t[2] + shift});
    CHECK(orientFaces(hollow) == 0);
}

TEST_CASE("orientFaces: half of the faces turned at random come back by their volume",
          "[geometry][property]") {
    const Mesh ball = test::sphereMesh(1, 3);
    Mesh mixed = ball;
    for (std::size_t i = 0; i < mixed.triangles.size(); i += 2)
        std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
    orientFaces(mixed);
    CHECK(volumeOf(mixed) == Approx(volumeOf(ball)));
}

TEST_CASE("removeDuplicateFaces: double-sided faces become single ones", "[geometry][property]") {
    const Mesh ball = test::sphereMesh(1, 2);
    Mesh twice = ball;
    for (const Triangle& t : ball.triangles) twice.triangles.push_back({t[1], t[0], t[2]});
    twice.triangles.push_back({3, 3, 4});
    CHECK(removeDuplicateFaces(twice) == ball.triangles.size());
    CHECK(twice.triangles == ball.triangles);
    CHECK(removeDuplicateFaces(twice) == 0);
}

TEST_CASE("removeDuplicateFaces: two-sided quads count once, whichever diagonal splits them",
          "[geometry][hand]") {
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 1, 1});
    const std::vector<Quad> quads = mesh.quads;
    for (Quad q : quads) {
        std::swap(q[1], q[3]);
        mesh.quads.push_back({q[1], q[2], q[3], q[0]});
    }
    CHECK(removeDuplicateFaces(mesh) == 12);
    CHECK(mesh.triangles.size() == 12);
    CHECK(edgeBalance(mesh) == EdgeBalance::Manifold);
}
