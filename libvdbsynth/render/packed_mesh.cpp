#include "libvdbsynth/render/packed_mesh.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/render/shading.h"
#include "libvdbsynth/render/surface_colours.h"
#include "libvdbsynth/render/traced_surface.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/level_set.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

// Between far samples the surface is where a line says, not where it is.
Mesh ontoSurface(Mesh mesh, const TracedSurface& surface, const RunContext& ctx) {
    parallelFor(ctx, mesh.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Vec3f here = cast<float>(surface.placeHere(cast<double>(mesh.points[i]) + mesh.origin));
            for (int step = 0; step < 3; ++step)
                here = here - surface.normalAt(here) * std::clamp(surface.bandDistance(here), -1.f, 1.f);
            mesh.points[i] = cast<float>(transformed(surface.toWorld(), cast<double>(here)) - mesh.origin);
        }
    });
    return mesh;
}

// The zero level of every `step`-th voxel, on the surface.
Mesh coarser(const TracedSurface& surface, double step, const RunContext& ctx) {
    const Index3 size = surface.voxels().size();
    Index3 count;
    for (int axis = 0; axis < 3; ++axis) count[axis] = int(size[axis] / step) + 2;
    const BrickField field = BrickField::fromVoxels(IndexBox::fromSize(count), ctx, [&](const Index3& p) {
        return surface.bandDistance({float(p.x * step), float(p.y * step), float(p.z * step)});
    });
    Mesh mesh = zeroLevel(field, field.box(), Facing::Outward, ctx);
    for (Vec3f& p : mesh.points) {
        const Vec3d world = transformed(surface.toWorld(), cast<double>(p) * step);
        if (&p == &mesh.points.front()) mesh.origin = world;
        p = cast<float>(world - mesh.origin);
    }
    return ontoSurface(std::move(mesh), surface, ctx);
}

Mesh reduced(const openvdb::FloatGrid& grid, const TracedSurface& surface, std::size_t most,
             std::size_t& before, const RunContext& ctx) {
    Mesh mesh = levelSetToMesh(grid, {}, ctx);
    const auto count = [&] { return mesh.triangles.size() + 2 * mesh.quads.size(); };
    before = count();
    // Triangles go with the square of the voxels' side.
    double step = 1;
    while (count() > most) {
        step *= std::max(1.03, 1.01 * std::sqrt(double(count()) / double(most)));
        mesh = coarser(surface, step, ctx);
    }
    return mesh;
}

void append(std::string& bytes, std::uint32_t value) {
    for (; value >= 128; value >>= 7) bytes += char((value & 127) | 128);
    bytes += char(value);
}

// The corners in the words of PackedMesh. @return the vertices in the order they are met
std::vector<std::uint32_t> appendCorners(const std::vector<Triangle>& triangles, std::size_t vertices,
                                         std::string& corners) {
    constexpr std::uint32_t kUnmet = 0xffffffffu;
    std::vector<std::uint32_t> number(vertices, kUnmet), order;
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) {
            const auto met = std::uint32_t(order.size());
            if (number[v] == kUnmet) {
                number[v] = met;
                order.push_back(v);
            }
            append(corners, met - number[v]);
        }
    return order;
}

void appendNormal(const Vec3f& normal, std::string& bytes) {
    const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    float u = normal.x / sum, v = normal.y / sum;
    if (normal.z < 0) {
        const float folded = (1 - std::abs(v)) * (u < 0 ? -1.f : 1.f);
        v = (1 - std::abs(u)) * (v < 0 ? -1.f : 1.f);
        u = folded;
    }
    bytes += char(std::int8_t(std::lround(u * 127)));
    bytes += char(std::int8_t(std::lround(v * 127)));
}

struct Looks {
    Vec3f normal{0, 0, 1}, colour{1, 1, 1};
    float open = 1;
};

std::vector<Looks> looksOf(const std::vector<Vec3d>& places, const TracedSurface& surface,
                           const GridConstPtr& colours, const RunContext& ctx) {
    Camera camera;  // turns the cube of directions only
    camera.forward = {-0.48, 0.77, -0.43};
    camera.right = {0.85, 0.53, 0};
    camera.up = {0.23, -0.36, 0.9};
    const Lighting lighting(surface, camera, {0, 0, 1});
    std::vector<Looks> looks(places.size());
    parallelFor(ctx, places.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::optional<SurfaceColours> reader;
        if (colours) reader.emplace(colours);
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f here = cast<float>(surface.placeHere(places[i]));
            const Vec3f normal = surface.normalAt(here);
            looks[i].open = lighting.openAt(here, normal);
            // Index axes may be turned in the world.
            const Affine& m = surface.toWorld();
            Vec3d turned;
            for (int r = 0; r < 3; ++r)
                turned[r] = m[std::size_t(r)] * double(normal.x) + m[std::size_t(4 + r)] * double(normal.y) +
                            m[std::size_t(8 + r)] * double(normal.z);
            if (dot(normal, normal) > 0) looks[i].normal = normalized(cast<float>(normalized(turned)));
            if (reader && !reader->at(places[i], looks[i].colour)) looks[i].colour = {0.75f, 0.67f, 0.6f};
        }
    });
    return looks;
}

}  // namespace

PackedMesh packedMesh(const openvdb::FloatGrid& grid, const GridConstPtr& colours, std::size_t most,
                      const RunContext& ctx) {
    requireOption(most >= 100, "most", std::to_string(most), "at least 100 triangles");
    PackedMesh packed;
    const TracedSurface surface(grid, ctx);
    const Mesh mesh = reduced(grid, surface, most, packed.before, ctx);
    const std::vector<Triangle> triangles = triangulated(mesh);
    packed.triangles = triangles.size();
    const std::vector<std::uint32_t> order = appendCorners(triangles, mesh.points.size(), packed.corners);
    packed.vertices = order.size();
    packed.low = {1e300, 1e300, 1e300};
    packed.high = {-1e300, -1e300, -1e300};
    std::vector<Vec3d> places;
    for (const std::uint32_t v : order) {
        places.push_back(cast<double>(mesh.points[v]) + mesh.origin);
        for (int axis = 0; axis < 3; ++axis) {
            packed.low[axis] = std::min(packed.low[axis], places.back()[axis]);
            packed.high[axis] = std::max(packed.high[axis], places.back()[axis]);
        }
    }
    packed.coloured = colours != nullptr;
    const std::vector<Looks> looks = looksOf(places, surface, colours, ctx);
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const double side = std::max(packed.high[axis] - packed.low[axis], 1e-300);
            const long value = std::lround((places[i][axis] - packed.low[axis]) / side * 65535);
            packed.positions += char(value & 255);
            packed.positions += char(value >> 8 & 255);
        }
        appendNormal(looks[i].normal, packed.normals);
        packed.open += char(std::lround(std::clamp(looks[i].open, 0.f, 1.f) * 255));
        if (packed.coloured)
            for (int c = 0; c < 3; ++c)
                packed.colours += char(std::lround(std::clamp(looks[i].colour[c], 0.f, 1.f) * 255));
    }
    return packed;
}

}  // namespace vdbsynth
