#include "libvdbsynth/io/readers/mesh_content.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/local_points.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

// As a float too.
bool isFinite(const Vec3d& p) {
    const auto fits = [](double value) { return std::abs(value) <= double(FLT_MAX); };
    return fits(p.x) && fits(p.y) && fits(p.z);
}

void checkCorners(const std::string& path, const MeshContent& content) {
    for (const std::uint32_t corner : content.polygons.corners) {
        if (corner >= content.points.size())
            throw Error(ErrorCode::BadData, path + ": a face uses vertex " + std::to_string(corner) + " of " +
                                                std::to_string(content.points.size()) + " (counting from 0)");
        if (!isFinite(content.points[corner]))
            throw Error(ErrorCode::BadData, path + ": a face uses vertex " + std::to_string(corner) +
                                                " (counting from 0), which has a coordinate that is not a "
                                                "finite number");
    }
}

// Of the points; those that stay keep their order.
void dropUnfinite(const std::string& path, MeshContent& content, const RunContext& ctx) {
    std::vector<std::size_t> rows;
    std::vector<std::uint32_t> place(content.points.size(), 0);
    for (std::size_t i = 0; i < content.points.size(); ++i) {
        place[i] = std::uint32_t(rows.size());
        if (isFinite(content.points[i])) rows.push_back(i);
    }
    const std::size_t dropped = content.points.size() - rows.size();
    if (dropped == 0) return;
    message(ctx, MessageLevel::Note,
            path + ": " + std::to_string(dropped) +
                " vertices without finite coordinates, which no face uses, left out");
    for (std::size_t i = 0; i < rows.size(); ++i) content.points[i] = content.points[rows[i]];
    content.points.resize(rows.size());
    content.attributes = selectRows(content.attributes, rows);
    for (std::uint32_t& corner : content.polygons.corners) corner = place[corner];
}

void sayFaces(const std::string& path, const PolygonList& polygons, std::size_t crossing,
              const RunContext& ctx) {
    const auto small = std::count_if(polygons.sizes.begin(), polygons.sizes.end(),
                                     [](std::uint32_t size) { return size < 3; });
    if (small > 0)
        message(
            ctx, MessageLevel::Note,
            path + ": " + countText(std::size_t(small), "face") + " with fewer than three corners left out");
    if (crossing > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + std::to_string(crossing) + " of " + std::to_string(polygons.sizes.size()) +
                    " faces cross themselves or are far from flat; their triangles may overlap. "
                    "Triangulating the mesh in the program that wrote it helps");
}

}  // namespace

Mesh meshOf(const std::string& path, MeshContent content, const RunContext& ctx) {
    checkCorners(path, content);
    dropUnfinite(path, content, ctx);
    Mesh mesh;
    sayFaces(path, content.polygons, appendPolygons(mesh, content.polygons, content.points), ctx);
    if (mesh.faceCount() == 0)
        throw Error(ErrorCode::EmptyInput, path + ": no faces; a mesh with at least one face is needed");
    LocalPoints local = localPoints(content.points);
    mesh.points = std::move(local.points);
    mesh.origin = local.origin;
    mesh.attributes = std::move(content.attributes);
    return mesh;
}

}  // namespace vdbsynth
