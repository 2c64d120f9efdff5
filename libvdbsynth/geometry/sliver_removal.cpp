#include "libvdbsynth/geometry/sliver_removal.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/mesh_check.h"
#include "libvdbsynth/geometry/sliver_removal_steps.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kMostRounds = 30;  // real meshes need three to six

using Faces = std::vector<std::size_t>;

// The slivers of some faces, worst first; of equals the first.
Faces sliversOf(const SliverSurface& surface, const Faces& faces) {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t face : faces)
        if (surface.isSliver(face)) found.push_back({surface.sineOf(face), face});
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    Faces slivers;
    for (const auto& [sine, face] : found) slivers.push_back(face);
    return slivers;
}

// @return the faces that changed
Faces improve(SliverSurface& surface, const Faces& slivers, SliverResult& result, const RunContext& ctx) {
    Stage stage(ctx, "removing slivers", std::max<std::size_t>(1, slivers.size()));
    Faces changed;
    for (std::size_t face : slivers) {
        stage.advance();
        SliverChange change;
        if (!surface.isSliver(face) || !surface.bestChange(face, change)) continue;
        surface.apply(change);
        ++(change.flip ? result.flips : result.collapses);
        changed.insert(changed.end(), change.removed.begin(), change.removed.end());
    }
    return changed;
}

// Without the vertices that were used before and are not any more.
void keepUsed(Mesh& mesh, const std::vector<Triangle>& before, const std::vector<Triangle>& after) {
    std::vector<char> gone(mesh.points.size(), 0);
    for (const Triangle& t : before)
        for (std::uint32_t corner : t) gone[corner] = 1;
    for (const Triangle& t : after)
        for (std::uint32_t corner : t) gone[corner] = 0;
    std::vector<std::size_t> kept;
    std::vector<std::uint32_t> number(mesh.points.size(), 0);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (gone[i]) continue;
        number[i] = std::uint32_t(kept.size());
        mesh.points[kept.size()] = mesh.points[i];
        kept.push_back(i);
    }
    mesh.points.resize(kept.size());
    mesh.attributes = selectRows(mesh.attributes, kept);
    mesh.triangles = after;
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& corner : t) corner = number[corner];
    mesh.quads.clear();
}

}  // namespace

void validate(const SliverOptions& options) {
    requireOption(options.angle > 0 && options.angle <= 30, "angle", roundedText(options.angle, 6),
                  "above 0, to 30 degrees");
    requireOption(options.tolerance >= 0 && options.tolerance <= 1e30, "tolerance",
                  roundedText(options.tolerance, 6), "from 0 to 1e30 (world)");
}

SliverResult removeSlivers(Mesh& mesh, const SliverOptions& options, const RunContext& ctx) {
    validate(options);
    requireMesh(mesh, "the mesh to remove slivers from");
    throwIfCancelled(ctx);
    constexpr double kDegree = 3.14159265358979323846 / 180;
    std::vector<Vec3d> points;
    points.reserve(mesh.points.size());
    for (const Vec3f& p : mesh.points) points.push_back(cast<double>(p));
    const std::vector<Triangle> before = triangulated(mesh);
    SliverSurface surface(std::move(points), before, sine(options.angle * kDegree), options.tolerance);
    SliverResult result;
    Faces all(surface.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    Faces slivers = sliversOf(surface, all);
    result.before = slivers.size();
    for (int round = 0; round < kMostRounds; ++round) {
        const Faces changed = improve(surface, slivers, result, ctx);
        if (changed.empty()) break;
        slivers.insert(slivers.end(), changed.begin(), changed.end());
        slivers = sliversOf(surface, slivers);
    }
    result.left = slivers.size();
    keepUsed(mesh, before, surface.triangles());
    return result;
}

}  // namespace vdbsynth
