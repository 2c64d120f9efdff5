#pragma once
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/pipeline/texture/texture.h"
#include "tests/support/makers.h"

// Small samples and targets for the tests of texturing.
namespace vdbsynth::test {

/// A sample whose red is u and whose green is v, both over the sides; `maps` further maps of one channel.
inline TextureSample rampSample(int width, int height, int maps = 0) {
    TextureSample sample;
    sample.name = "ramp.png";
    sample.maps = {{"Cd", 0, 3, 255}};
    for (int m = 0; m < maps; ++m) sample.maps.push_back({"map" + std::to_string(m), 3 + m, 1, 255});
    sample.image = {width, height, 3 + maps, false, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            sample.image.values.insert(sample.image.values.end(), {(float(x) + 0.5f) / float(width),
                                                                   (float(y) + 0.5f) / float(height), 0});
            for (int m = 0; m < maps; ++m) sample.image.values.push_back(float(m + 1) / 4);
        }
    return sample;
}

/// A mesh as a target.
inline TextureShape shapeOf(const Mesh& mesh) {
    TextureShape shape;
    shape.kind = TargetKind::Mesh;
    shape.name = "target";
    shape.points = mesh.points;
    shape.triangles = triangulated(mesh);
    shape.attributes = mesh.attributes;
    makeSites(shape, {});
    return shape;
}

/// A flat square of n x n vertices a unit apart in z = 0, with texture coordinates of its own over 0..1.
inline Mesh squareMesh(int n) {
    Mesh mesh;
    Attribute uv{"uv", 2, {}};
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            mesh.points.push_back({float(x), float(y), 0});
            uv.values.insert(uv.values.end(), {float(x) / float(n - 1), float(y) / float(n - 1)});
        }
    for (std::uint32_t y = 0; y + 1 < std::uint32_t(n); ++y)
        for (std::uint32_t x = 0; x + 1 < std::uint32_t(n); ++x) {
            const std::uint32_t a = y * std::uint32_t(n) + x, b = a + std::uint32_t(n);
            mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, b}, {a + 1, b + 1, b}});
        }
    mesh.attributes = {uv};
    return mesh;
}

/// One chart over a flat shape: u is x, v is y, a texel is a unit.
inline TextureResult flatResult(const TextureShape& shape, const TextureSample& sample) {
    TextureResult result;
    const std::size_t channels = std::size_t(sample.image.channels), count = shape.site.size();
    result.sites.sample.assign(count, 0);
    result.sites.tangent.assign(count, Vec3f{1, 0, 0});
    result.sites.blended.assign(count, 0);
    result.sites.values.resize(count * channels);
    for (std::size_t i = 0; i < count; ++i) {
        result.sites.coordinate.push_back({shape.site[i].x, shape.site[i].y});
        readCubic(sample.image, result.sites.coordinate[i], &result.sites.values[i * channels]);
    }
    return result;
}

}  // namespace vdbsynth::test
