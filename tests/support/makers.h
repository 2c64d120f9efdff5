#pragma once
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

// Named makers of small inputs, shared by the tests of all rooms.
namespace vdbsynth::test {

inline BrickField fieldFrom(const Index3& size, const std::function<float(const Index3&)>& value) {
    return BrickField::fromVoxels(IndexBox::fromSize(size), {}, value);
}

/// Independent random values in [-1, 1].
inline BrickField noiseField(const Index3& size, std::uint64_t seed) {
    return fieldFrom(size, [seed](const Index3& p) {
        return float(Random(seed, std::uint64_t((p.x * 1000 + p.y) * 1000 + p.z)).uniform(-1, 1));
    });
}

/// Distances to a few random balls, clamped to +-limit: a smooth field with constant regions.
inline BrickField ballsField(const Index3& size, std::uint64_t seed, float limit, int balls = 6) {
    std::vector<std::array<double, 4>> all;
    for (int i = 0; i < balls; ++i) {
        Random random(seed, std::uint64_t(i));
        all.push_back({random.uniform(0, size.x), random.uniform(0, size.y), random.uniform(0, size.z),
                       random.uniform(2, 6)});
    }
    return fieldFrom(size, [=](const Index3& p) {
        double nearest = double(limit);
        for (const auto& b : all)
            nearest = std::min(nearest, std::sqrt((p.x - b[0]) * (p.x - b[0]) + (p.y - b[1]) * (p.y - b[1]) +
                                                  (p.z - b[2]) * (p.z - b[2])) -
                                            b[3]);
        return float(std::max(nearest, -double(limit)));
    });
}

/// Repeats exactly every `period` voxels along each axis.
inline BrickField periodicField(const Index3& size, int period) {
    const BrickField cell = noiseField({period, period, period}, 77);
    return fieldFrom(size, [&](const Index3& p) {
        return cell.at({p.x % period, p.y % period, p.z % period});
    });
}

inline std::vector<float> samplesOf(const BrickField& field) {
    const Index3 size = field.box().size();
    std::vector<float> samples(std::size_t(field.box().volume()));
    field.readBox(field.box().min, size, samples.data());
    return samples;
}

/// A closed box of quads with outward faces.
inline Mesh boxMesh(const Vec3f& low, const Vec3f& high) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.points.push_back({i & 4 ? high.x : low.x, i & 2 ? high.y : low.y, i & 1 ? high.z : low.z});
    mesh.quads = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    return mesh;
}

/// A closed triangulated sphere: an octahedron split `times` times.
inline Mesh sphereMesh(double radius, int times) {
    Mesh mesh;
    mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int t = 0; t < times; ++t) {
        std::vector<Triangle> finer;
        std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto key = std::minmax(a, b);
            const auto pair = std::make_pair(key.first, key.second);
            for (const auto& m : middles)
                if (m.first == pair) return m.second;
            mesh.points.push_back(normalized(mesh.points[a] + mesh.points[b]));
            middles.push_back({pair, std::uint32_t(mesh.points.size() - 1)});
            return middles.back().second;
        };
        for (const Triangle& f : mesh.triangles) {
            const std::uint32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
            finer.insert(finer.end(), {{f[0], a, c}, {a, f[1], b}, {c, b, f[2]}, {a, b, c}});
        }
        mesh.triangles = finer;
    }
    for (Vec3f& p : mesh.points) p = p * float(radius);
    return mesh;
}

/// Code and message of what `work` throws; code is -1 if it throws nothing.
struct Thrown {
    int code = -1;
    std::string message;
};
template <typename Work>
Thrown thrownBy(Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        return {int(error.code()), error.what()};
    }
    return {};
}
inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Path of a sample file, empty if the samples are absent.
inline std::string sample(const std::string& name) {
    const char* folder = std::getenv("VDBSYNTH_SAMPLES");
    return folder && *folder ? std::string(folder) + "/" + name : "";
}

}  // namespace vdbsynth::test
