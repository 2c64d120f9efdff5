#include "libvdbsynth/render/wires.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// A vertex in the picture: pixels, and the depth's inverse, which is linear along a line of the picture.
struct Seen {
    double x = 0, y = 0, inverse = 0;
};

struct Canvas {
    int width, height;
    const std::vector<float>& depths;
    double slack, radius;
    std::vector<float> coverage;

    void cover(int x, int y, double off, double inverse) {
        if (x < 0 || y < 0 || x >= width || y >= height) return;
        const double share = std::clamp(radius + 0.5 - std::abs(off), 0.0, 1.0);
        if (share <= 0) return;
        const std::size_t pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
        if (1 / inverse > double(depths[pixel]) + slack) return;
        coverage[pixel] = std::max(coverage[pixel], float(share));
    }

    // Pixel by pixel along the side that is longer.
    void line(const Seen& a, const Seen& b) {
        if (!(a.inverse > 0) || !(b.inverse > 0)) return;
        const double dx = b.x - a.x, dy = b.y - a.y;
        const bool flat = std::abs(dx) >= std::abs(dy);
        const double longer = flat ? dx : dy, slope = longer != 0 ? (flat ? dy : dx) / longer : 0;
        const double from = flat ? a.x : a.y, to = flat ? b.x : b.y;
        const double least = std::max(std::floor(std::min(from, to)), -1.0);
        const double most = std::min(std::floor(std::max(from, to)), double(flat ? width : height));
        const double thick = std::sqrt(1 + slope * slope), beside = (radius + 0.5) * thick;
        for (int i = int(least); i <= int(most); ++i) {
            const double t = longer != 0 ? std::clamp((i + 0.5 - from) / longer, 0.0, 1.0) : 0.0;
            const double across = (flat ? a.y + t * dy : a.x + t * dx) - 0.5;
            if (!(std::abs(across) < 1e5)) continue;
            const double inverse = a.inverse + (b.inverse - a.inverse) * t;
            for (int j = int(std::ceil(across - beside)); j <= int(std::floor(across + beside)); ++j)
                cover(flat ? i : j, flat ? j : i, (j - across) / thick, inverse);
        }
    }
};

}  // namespace

std::vector<float> wireCoverage(const Mesh& mesh, const Camera& camera, int width, int height,
                                const std::vector<float>& depths, double slack) {
    std::vector<Seen> seen(mesh.points.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const Vec3d p = cast<double>(mesh.points[i]) + mesh.origin - camera.eye;
        const double depth = dot(p, camera.forward);
        if (!(depth > slack)) continue;
        seen[i] = {(dot(p, camera.right) / (depth * camera.spanX) + 1) * 0.5 * width,
                   (1 - dot(p, camera.up) / (depth * camera.spanY)) * 0.5 * height, 1 / depth};
    }
    Canvas canvas{width, height, depths, slack, std::max(0.5, height / 1400.0), {}};
    canvas.coverage.resize(std::size_t(width) * std::size_t(height));
    const auto around = [&](const auto& face) {
        for (std::size_t k = 0; k < face.size(); ++k)
            canvas.line(seen[face[k]], seen[face[(k + 1) % face.size()]]);
    };
    for (const Triangle& t : mesh.triangles) around(t);
    for (const Quad& q : mesh.quads) around(q);
    return std::move(canvas.coverage);
}

}  // namespace vdbsynth
