#include "libvdbsynth/render/camera.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

// The eight corners of a box.
std::vector<Vec3d> corners(const Vec3d& low, const Vec3d& high) {
    std::vector<Vec3d> places;
    for (int c = 0; c < 8; ++c)
        places.push_back({c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z});
    return places;
}

struct Seen {
    double left = 1, right = 0, top = 1, bottom = 0;  // shares of the picture
};

Seen seenBy(const Camera& camera, const std::vector<Vec3d>& places) {
    Seen seen;
    for (const Vec3d& place : places) {
        const Vec3d p = place - camera.eye;
        const double depth = dot(p, camera.forward);
        REQUIRE(depth > 0);
        const double x = 0.5 + 0.5 * dot(p, camera.right) / (depth * camera.spanX);
        const double y = 0.5 - 0.5 * dot(p, camera.up) / (depth * camera.spanY);
        seen.left = std::min(seen.left, x);
        seen.right = std::max(seen.right, x);
        seen.top = std::min(seen.top, y);
        seen.bottom = std::max(seen.bottom, y);
    }
    return seen;
}

}  // namespace

TEST_CASE("framed: the places fill the picture to its margins on the tighter sides, in its middle",
          "[render][oracle]") {
    for (const auto& [low, high] : {std::pair<Vec3d, Vec3d>{{0, 0, 0}, {10, 10, 10}},
                                    {{-40, 3, 7}, {60, 8, 9}},
                                    {{1e6, 1e6, 0}, {1e6 + 1, 1e6 + 2, 30}}})
        for (const double aspect : {0.5, 1.0, 16.0 / 9})
            for (const Vec3d& view : {Vec3d{1, -1.6, 0.9}, Vec3d{0, 0, 1}, Vec3d{-3, 0.1, -2}}) {
                const std::vector<Vec3d> places = corners(low, high);
                const Framing framing = framed(places, {view}, UpAxis::Z, aspect);
                const Seen seen = seenBy(framing.cameras.front(), places);
                const double wide = seen.right - seen.left, tall = seen.bottom - seen.top;
                CHECK(std::max(wide, tall) == Approx(0.92).margin(1e-4));
                CHECK(std::min({seen.left, seen.top, 1 - seen.right, 1 - seen.bottom}) > 0.0399);
                // Of the side that decides both margins are the same.
                if (wide > tall)
                    CHECK(seen.left + seen.right == Approx(1).margin(1e-4));
                else
                    CHECK(seen.top + seen.bottom == Approx(1).margin(1e-4));
            }
}

TEST_CASE("framed: a label keeps its place free", "[render]") {
    const std::vector<Vec3d> places = corners({0, 0, 0}, {1, 1, 5});
    const Seen seen = seenBy(framed(places, {{0, -1, 0}}, UpAxis::Z, 1, 0, 0.15).cameras.front(), places);
    CHECK(seen.bottom == Approx(1 - 0.04 - 0.15).margin(1e-6));
    CHECK(seen.top == Approx(0.04).margin(1e-6));
}

TEST_CASE("framed: the least distance moves the eye away", "[render]") {
    const std::vector<Vec3d> small = corners({0, 0, 0}, {1, 1, 1}), large = corners({0, 0, 0}, {4, 4, 4});
    const Vec3d view{1, -1.6, 0.9};
    const double far = framed(large, {view}, UpAxis::Z, 1).distance;
    const Framing same = framed(small, {view}, UpAxis::Z, 1, far);
    CHECK(same.distance == far);
    CHECK(framed(small, {view}, UpAxis::Z, 1).distance < far / 3);
}

TEST_CASE("framed: the up axis points up in the picture, along it the next axis", "[render]") {
    const std::vector<Vec3d> places = corners({0, 0, 0}, {1, 1, 1});
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        const Camera camera = framed(places, {usualView(up)}, up, 1).cameras.front();
        CHECK(dot(camera.up, upVector(up)) > 0.8);
        CHECK(std::abs(dot(camera.right, upVector(up))) < 1e-12);
        CHECK(dot(cross(camera.right, camera.up), camera.forward) == Approx(-1));
        const Camera above = framed(places, {upVector(up)}, up, 1).cameras.front();
        CHECK(std::abs(dot(above.up, up == UpAxis::Z ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1})) == Approx(1));
    }
}

TEST_CASE("usualView: the view of models that stand on z, turned to y, is the same picture",
          "[render][property]") {
    // z up to y up: (x, y, z) is (x, z, -y).
    const Vec3d z = usualView(UpAxis::Z), y = usualView(UpAxis::Y);
    CHECK(y.x == z.x);
    CHECK(y.y == z.z);
    CHECK(y.z == -z.y);
}

TEST_CASE("turntableViews: equal steps around the up axis, heights kept, one distance for all",
          "[render][property]") {
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z}) {
        const Vec3d view = usualView(up);
        const std::vector<Vec3d> views = turntableViews(view, up, 12);
        REQUIRE(views.size() == 12);
        CHECK(length(views.front() - view) == 0);
        for (std::size_t i = 0; i < 12; ++i) {
            CHECK(dot(views[i], upVector(up)) == Approx(dot(view, upVector(up))));
            CHECK(length(views[i]) == Approx(length(view)));
            CHECK(length(views[i] - views[(i + 1) % 12]) == Approx(length(views[0] - views[1])));
            // The camera goes clockwise seen from above, so the model turns the other way.
            CHECK(dot(cross(views[i], views[(i + 1) % 12]), upVector(up)) < 0);
        }
        const std::vector<Vec3d> places = corners({0, 0, 0}, {9, 2, 3});
        for (const Camera& camera : framed(places, views, up, 1.5).cameras) {
            const Seen seen = seenBy(camera, places);
            CHECK(std::min({seen.left, seen.top, 1 - seen.right, 1 - seen.bottom}) > 0.0399);
        }
    }
}
