#include "libvdbsynth/render/camera.h"

#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kTangent = 0.26;  // of half the angle that the shorter side of a picture shows
constexpr double kMargin = 0.04;   // of the picture, free at each side

Camera looking(const Vec3d& view, UpAxis axis, double aspect) {
    Camera camera;
    const Vec3d back = normalized(view);
    camera.forward = -back;
    Vec3d up = upVector(axis);
    if (std::abs(dot(up, back)) > 0.999) up = axis == UpAxis::Z ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1};
    camera.right = normalized(cross(camera.forward, up));
    camera.up = cross(camera.right, camera.forward);
    camera.spanX = kTangent * std::max(1.0, aspect);
    camera.spanY = camera.spanX / aspect;
    return camera;
}

// Half of what a picture shows at distance 1 to each side, without its margins.
struct Spans {
    double side, low, high;
};

// How far the places reach beyond each side of the picture of an eye in the middle.
struct Reach {
    double left = -1e300, right = -1e300, low = -1e300, high = -1e300, front = 1e300;
};

void reachOf(const Camera& camera, const Spans& spans, const std::vector<Vec3d>& places, const Vec3d& middle,
             Reach& reach) {
    for (const Vec3d& place : places) {
        const Vec3d p = place - middle;
        const double x = dot(p, camera.right), y = dot(p, camera.up), depth = dot(p, camera.forward);
        reach.right = std::max(reach.right, x - spans.side * depth);
        reach.left = std::max(reach.left, -x - spans.side * depth);
        reach.high = std::max(reach.high, y - spans.high * depth);
        reach.low = std::max(reach.low, -y - spans.low * depth);
        reach.front = std::min(reach.front, depth);
    }
}

}  // namespace

Vec3d upVector(UpAxis up) {
    return up == UpAxis::Z ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
}

Vec3d usualView(UpAxis up) {
    return up == UpAxis::Z ? Vec3d{1, -1.6, 0.9} : Vec3d{1, 0.9, 1.6};
}

Framing framed(const std::vector<Vec3d>& places, const std::vector<Vec3d>& views, UpAxis up, double aspect,
               double least, double below) {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const Vec3d& p : places)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    const Vec3d middle = (low + high) * 0.5;
    Framing result;
    Reach reach;
    Spans spans{};
    for (const Vec3d& view : views) {
        const Camera camera = looking(view, up, aspect);
        const double tall = camera.spanY * (1 - 2 * kMargin);
        spans = {camera.spanX * (1 - 2 * kMargin), tall - 2 * below * camera.spanY, tall};
        reachOf(camera, spans, places, middle, reach);
        result.cameras.push_back(camera);
    }
    // Each side holds, as x - span * depth <= ex - span * ez does for the right one, of the eye (ex, ey, ez).
    const double wanted = std::max((reach.left + reach.right) / (2 * spans.side),
                                   (reach.low + reach.high) / (spans.low + spans.high));
    result.distance = std::max({wanted, least, 1e-3 * length(high - low) - reach.front});
    const double x = (reach.right - reach.left) / 2;
    const double y = (reach.high - reach.low - (spans.high - spans.low) * result.distance) / 2;
    for (Camera& camera : result.cameras)
        camera.eye = middle + camera.right * x + camera.up * y - camera.forward * result.distance;
    return result;
}

std::vector<Vec3d> turntableViews(const Vec3d& view, UpAxis up, int count) {
    std::vector<Vec3d> views;
    for (int i = 0; i < count; ++i) {
        // The camera goes clockwise.
        const double angle = -2 * kPi * i / count, c = i == 0 ? 1 : cosine(angle),
                     s = i == 0 ? 0 : sine(angle);
        if (up == UpAxis::Z)
            views.push_back({c * view.x - s * view.y, s * view.x + c * view.y, view.z});
        else
            views.push_back({c * view.x + s * view.z, view.y, -s * view.x + c * view.z});
    }
    return views;
}

}  // namespace vdbsynth
