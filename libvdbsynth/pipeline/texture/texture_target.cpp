#include "libvdbsynth/pipeline/texture/texture_target.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/points/surface_sites.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vdbsynth {
namespace {

// Unchanged if its length is 1 already, so that what is read again keeps its bits.
Vec3f unit(const Vec3f& normal) {
    return std::abs(length(normal) - 1) < 1e-6f ? normal : normalized(normal);
}

bool usable(const Vec3f& normal) {
    const float size = length(normal);
    return std::isfinite(size) && size > 1e-12f;
}

// Elements at one place get one site, numbered in the order of the elements.
void uniteElements(TextureShape& shape) {
    const auto key = [&](std::uint32_t i) {
        const Vec3f& p = shape.points[i];
        return std::make_tuple(p.x, p.y, p.z);
    };
    std::vector<std::uint32_t> order(shape.points.size()), first(order.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first[order[k - 1]] : order[k];
    shape.siteOf.resize(order.size());
    shape.site.clear();
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        if (first[i] == i) {
            shape.siteOf[i] = std::uint32_t(shape.site.size());
            shape.site.push_back(shape.points[i]);
        } else {
            shape.siteOf[i] = shape.siteOf[first[i]];
        }
    }
}

// What the normals at a site sum up to, in doubles and in the order of the elements or faces.
struct NormalSum {
    Vec3d sum, first;
    double whole = 0;  // the sum of lengths

    void add(const Vec3d& normal) {
        const double size = length(normal);
        if (!std::isfinite(size) || !(size > 1e-30)) return;
        if (whole == 0) first = normal;
        sum = sum + normal;
        whole += size;
    }
    // The mean; where normals cancel, as on a sheet with two sides, the first; 0 where there is none.
    Vec3f direction() const {
        constexpr double kCancelled = 1e-3;
        if (whole == 0) return {0, 0, 0};
        const Vec3d& taken = length(sum) > kCancelled * whole ? sum : first;
        return std::abs(length(taken) - 1) < 1e-6 ? cast<float>(taken) : cast<float>(normalized(taken));
    }
};

void normalsFrom(TextureShape& shape, const std::vector<Vec3f>& normals) {
    std::vector<NormalSum> sums(shape.site.size());
    for (std::size_t i = 0; i < normals.size(); ++i)
        if (usable(normals[i])) sums[shape.siteOf[i]].add(cast<double>(unit(normals[i])));
    for (const Triangle& t : shape.triangles) {
        if (!normals.empty()) break;
        const Vec3d a = cast<double>(shape.points[t[0]]), b = cast<double>(shape.points[t[1]]),
                    c = cast<double>(shape.points[t[2]]);
        for (std::uint32_t v : t) sums[shape.siteOf[v]].add(cross(b - a, c - a));
    }
    shape.normal.clear();
    for (const NormalSum& sum : sums) shape.normal.push_back(sum.direction());
}

void estimatedNormals(TextureShape& shape, const RunContext& ctx) {
    message(ctx, MessageLevel::Note, shape.name + ": has no normals; they are estimated from the points");
    PointCloud cloud;
    cloud.points = shape.site;
    if (shape.site.size() >= 3) estimateNormals(cloud, ctx);
    shape.normal = cloud.normals;
    shape.normal.resize(shape.site.size(), Vec3f{0, 0, 0});
}

void fillNormals(TextureShape& shape, const RunContext& ctx) {
    std::size_t without = 0;
    for (Vec3f& n : shape.normal) {
        if (!usable(n)) {
            n = {0, 0, 1};
            ++without;
        }
        n = unit(n);
    }
    if (without > 0)
        message(ctx, MessageLevel::Note,
                shape.name + ": " + std::to_string(without) +
                    " places without a direction of their surface are taken to face up");
}

// Vertices that no face uses would be sites without a surface.
void dropUnused(Mesh& mesh, const std::string& name, const RunContext& ctx) {
    std::vector<char> used(mesh.points.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (std::uint32_t v : t) used[v] = 1;
    std::vector<std::size_t> kept;
    std::vector<std::uint32_t> number(mesh.points.size(), 0);
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) {
            number[i] = std::uint32_t(kept.size());
            kept.push_back(i);
        }
    if (kept.size() == used.size()) return;
    message(ctx, MessageLevel::Note,
            name + ": " + std::to_string(used.size() - kept.size()) + " vertices without faces are left out");
    std::vector<Vec3f> points;
    for (std::size_t i : kept) points.push_back(mesh.points[i]);
    mesh.points = std::move(points);
    mesh.attributes = selectRows(mesh.attributes, kept);
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& v : t) v = number[v];
}

void takeMesh(TextureShape& shape, Mesh mesh, const RunContext& ctx) {
    mesh.triangles = triangulated(mesh);
    mesh.quads.clear();
    dropUnused(mesh, shape.name, ctx);
    shape.origin = mesh.origin;
    shape.points = std::move(mesh.points);
    shape.triangles = std::move(mesh.triangles);
    shape.attributes = std::move(mesh.attributes);
    makeSites(shape, {}, ctx);
}

template <typename Points>
void scale(Points& points, Vec3d& origin, double by) {
    if (by == 1) return;
    origin = origin * by;
    for (Vec3f& p : points) p = cast<float>(cast<double>(p) * by);
}

void takePoints(TextureShape& shape, PointCloud cloud, const RunContext& ctx) {
    shape.origin = cloud.origin;
    shape.points = std::move(cloud.points);
    shape.attributes = std::move(cloud.attributes);
    makeSites(shape, cloud.normals, ctx);
}

void takePointFile(TextureShape& shape, const std::string& path, const ModelOptions& options,
                   const RunContext& ctx) {
    PointFile file = readPoints(path, ctx);
    if (file.invalid > 0)
        message(ctx, MessageLevel::Note,
                path + ": " + std::to_string(file.invalid) + " points without finite coordinates left out");
    if (isMeshPath(path) && !holdsPoints(path))
        message(ctx, MessageLevel::Note, path + ": its faces are left out; `as` mesh textures them");
    scale(file.cloud.points, file.cloud.origin, options.unitScale);
    takePoints(shape, std::move(file.cloud), ctx);
}

void takeLevelSet(TextureShape& shape, LevelSet model, const RunContext& ctx) {
    shape.model = std::move(model);
    takeMesh(shape, levelSetToMesh(*shape.model.grid, {}, ctx), ctx);
}

// A .ply is points by default, and a mesh on request.
bool readsAsMesh(const std::string& path) {
    return isMeshPath(path) && !holdsPoints(path);
}

}  // namespace

TargetKind kindOf(const std::string& path) {
    if (readExtensionOf(path) == "ply" || isPointPath(path) || holdsPoints(path)) return TargetKind::Points;
    return isMeshPath(path) ? TargetKind::Mesh : TargetKind::LevelSet;
}

void makeSites(TextureShape& shape, const std::vector<Vec3f>& normals, const RunContext& ctx) {
    uniteElements(shape);
    const bool given = std::any_of(normals.begin(), normals.end(), usable);
    if (given || !shape.triangles.empty())
        normalsFrom(shape, given ? normals : std::vector<Vec3f>{});
    else
        estimatedNormals(shape, ctx);
    fillNormals(shape, ctx);
}

TextureShape loadTarget(const std::string& path, std::optional<TargetKind> kind, const ModelOptions& options,
                        const RunContext& ctx) {
    requireModelPath(path);
    TextureShape shape;
    shape.name = path;
    const TargetKind own = kindOf(path);
    shape.kind = kind.value_or(own);
    withThreads(ctx, [&] {
        if (shape.kind == TargetKind::LevelSet || own == TargetKind::LevelSet) {
            takeLevelSet(shape, loadModel(path, options, ctx), ctx);
        } else if (shape.kind == TargetKind::Mesh || own == TargetKind::Mesh) {
            if (!readsAsMesh(path))
                throw Error(ErrorCode::Unusable,
                            path + ": holds points, which have no faces; `as` levelset makes a surface");
            Mesh mesh = readMesh(path, ctx);
            scale(mesh.points, mesh.origin, options.unitScale);
            takeMesh(shape, std::move(mesh), ctx);
        } else {
            takePointFile(shape, path, options, ctx);
        }
    });
    if (shape.kind == TargetKind::Points) shape.triangles.clear();
    if (shape.kind != TargetKind::LevelSet) shape.model = {};
    return shape;
}

TextureShape targetOf(const PointCloud& cloud, const std::string& name, const RunContext& ctx) {
    TextureShape shape;
    shape.name = name;
    withThreads(ctx, [&] { takePoints(shape, cloud, ctx); });
    return shape;
}

TextureShape targetOf(const Mesh& mesh, const std::string& name, const RunContext& ctx) {
    TextureShape shape;
    shape.kind = TargetKind::Mesh;
    shape.name = name;
    withThreads(ctx, [&] { takeMesh(shape, mesh, ctx); });
    return shape;
}

TextureShape targetOf(const LevelSet& model, const std::string& name, const RunContext& ctx) {
    TextureShape shape;
    shape.kind = TargetKind::LevelSet;
    shape.name = name;
    withThreads(ctx, [&] { takeLevelSet(shape, model, ctx); });
    return shape;
}

double siteSpacing(const TextureShape& shape, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        return meanNearestDistance(sitesOfPoints(shape.site, shape.normal, kSiteNeighbours, ctx));
    });
}

}  // namespace vdbsynth
