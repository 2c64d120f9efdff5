#include "libvdbsynth/pipeline/relief/relief_bake.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/relief/relief_steps.h"
#include "libvdbsynth/pipeline/texture/uv_bake.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kStep = 0.5f;  // [voxels] along a normal

// A target's vertices in the result's voxels.
struct BakedMesh {
    std::vector<Triangle> triangles;
    std::vector<Vec3f> point, normal;
    const std::vector<float>& uv;
};

std::vector<Vec3f> smoothNormals(const std::vector<Vec3f>& point, const std::vector<Triangle>& triangles) {
    std::vector<Vec3f> normal(point.size());
    for (const Triangle& t : triangles) {
        const Vec3f n = cross(point[t[1]] - point[t[0]], point[t[2]] - point[t[0]]);
        for (std::uint32_t v : t) normal[v] = normal[v] + n;
    }
    for (Vec3f& n : normal) n = normalized(n);
    return normal;
}

// Where a line from a place meets the zero level, nearest to it; 0 if nowhere.
float heightAlong(const BrickField& field, const Vec3f& place, const Vec3f& normal, float reach) {
    const auto at = [&](float height) { return sampleTrilinear(field, place + normal * height); };
    const float middle = at(0);
    float before[2] = {middle, middle};
    for (float h = kStep; h <= reach + kStep; h += kStep)
        for (int side = 0; side < 2; ++side) {
            const float to = side == 0 ? h : -h, value = at(to);
            // Outward from inside to outside, inward the other way: the surface that the place belongs to.
            if (side == 0 ? before[0] < 0 && value >= 0 : before[1] >= 0 && value < 0) {
                const float from = side == 0 ? h - kStep : kStep - h;
                return from + (to - from) * before[side] / (before[side] - value);
            }
            before[side] = value;
        }
    return 0;
}

struct Frame {
    Vec3f u, v, normal;
    Vec3f local(const Vec3f& vector) const { return {dot(vector, u), dot(vector, v), dot(vector, normal)}; }
};

Frame frameOf(const BakedMesh& mesh, const Triangle& t, const Vec3f& normal) {
    const float du1 = mesh.uv[2 * t[1]] - mesh.uv[2 * t[0]], du2 = mesh.uv[2 * t[2]] - mesh.uv[2 * t[0]],
                dv1 = mesh.uv[2 * t[1] + 1] - mesh.uv[2 * t[0] + 1],
                dv2 = mesh.uv[2 * t[2] + 1] - mesh.uv[2 * t[0] + 1];
    const float area = du1 * dv2 - du2 * dv1;
    const Vec3f e1 = mesh.point[t[1]] - mesh.point[t[0]], e2 = mesh.point[t[2]] - mesh.point[t[0]];
    const Vec3f along = (e1 * dv2 - e2 * dv1) * (area < 0 ? -1.f : 1.f);
    const Vec3f u = normalized(along - normal * dot(along, normal));
    return {u, cross(normal, u) * (area < 0 ? -1.f : 1.f), normal};
}

struct Baker {
    const BakedMesh& mesh;
    const BrickField& field;
    BakedRelief what;
    float reach;  // [voxels]
    float unit;   // [world] of a voxel
    bool png;

    void operator()(std::size_t triangle, const BakeWeights& w, float* out) const {
        const Triangle& t = mesh.triangles[triangle];
        Vec3f place, normal;
        for (std::size_t k = 0; k < 3; ++k) {
            place = place + mesh.point[t[k]] * w[k];
            normal = normal + mesh.normal[t[k]] * w[k];
        }
        normal = normalized(normal);
        const float height = heightAlong(field, place, normal, reach);
        if (what == BakedRelief::Displacement) {
            out[0] = png ? 0.5f + 0.5f * std::clamp(height / reach, -1.f, 1.f) : height * unit;
            return;
        }
        const Frame frame = frameOf(mesh, t, normal);
        const Vec3f on = place + normal * height, gradient = normalized(sampleGradient(field, on));
        const Vec3f local = frame.local(what == BakedRelief::Normal ? gradient : (on - place) * unit);
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = what == BakedRelief::Normal ? 0.5f + 0.5f * local[axis] : local[axis];
    }
};

}  // namespace

void validate(const ReliefBakeOptions& options) {
    if (options.size < 16 || options.size > 16384)
        throw Error(ErrorCode::InvalidOption, "`bakeSize`: is not between 16 and 16384");
    if (options.bits != 8 && options.bits != 16)
        throw Error(ErrorCode::InvalidOption, "`bakeBits`: is neither 8 nor 16");
    if (!(options.reach > 0)) throw Error(ErrorCode::InvalidOption, "`reach`: is not above 0");
}

BakedRelief bakedReliefOf(const std::string& path) {
    std::string stem = fileNameOf(path);
    stem.erase(std::min(stem.rfind('.'), stem.size()));
    stem = withoutTile(stem);
    while (!stem.empty() && (stem.back() == '.' || stem.back() == '_' || stem.back() == '-')) stem.pop_back();
    const auto ends = [&](const std::string& word) {
        return stem.size() >= word.size() && stem.compare(stem.size() - word.size(), word.size(), word) == 0;
    };
    return ends("vector")   ? BakedRelief::Vector
           : ends("normal") ? BakedRelief::Normal
                            : BakedRelief::Displacement;
}

void bakeRelief(const Mesh& target, const LevelSet& result, const std::string& name, const std::string& path,
                const ReliefBakeOptions& options, OutputSet& outputs, const RunContext& ctx) {
    validate(options);
    const BakedRelief what = bakedReliefOf(path);
    const bool png = extensionOf(path) != "exr";
    if (png && what == BakedRelief::Vector)
        throw Error(ErrorCode::InvalidOption, path + ": vectors are written as .exr");
    const Attribute* uv = findAttribute(target.attributes, "uv");
    if (!uv || uv->width != 2)
        throw Error(ErrorCode::Unusable, name + ": has no texture coordinates to bake onto");
    const IndexBox box = solidBox(*result.grid, "the result").expanded(8);
    const BrickField field = gatherNarrowBand(*result.grid, box, ctx);
    const VoxelPlace place = placeOf(*result.grid, box.min);
    BakedMesh mesh{triangulated(target), {}, {}, uv->values};
    const Vec3d origin = place.world({0, 0, 0});
    for (const Vec3f& p : target.points) {
        const Vec3d off = target.origin + cast<double>(p) - origin;
        mesh.point.push_back(place.fromWorldDirection(off) * float(length(off) / place.voxelSize));
    }
    mesh.normal = smoothNormals(mesh.point, mesh.triangles);
    const Baker baker{mesh, field, what, float(options.reach / place.voxelSize), float(place.voxelSize), png};
    bakeOntoUv({name, mesh.triangles, uv->values}, path,
               {options.size, options.bits, what == BakedRelief::Displacement ? 1 : 3}, baker, outputs, ctx);
    message(ctx, MessageLevel::Note,
            path + ": holds " +
                (what == BakedRelief::Normal   ? "normals"
                 : what == BakedRelief::Vector ? "displacement along u, v and normal (world)"
                 : png ? "displacement: half is 0, white " + roundedText(options.reach, 4) + " (world)"
                       : "displacement along the normal (world)"));
}

}  // namespace vdbsynth
