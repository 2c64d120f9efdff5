// The target of a relief.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/pipeline/convert/domain_faces.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/relief/relief_steps.h"
#include "libvdbsynth/pipeline/texture/texture_steps.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/control_grids.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/grid_reader.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kSideCosine = 0.7f;  // of normal and axis, below which a surface runs along the axis

// 0 to 1 with level ends.
float smoothStep(float t) {
    t = std::clamp(t, 0.f, 1.f);
    return t * t * (3 - 2 * t);
}

void multiply(std::vector<float>& strength, const std::vector<Vec3f>& point, const BrickField& weight) {
    for (std::size_t i = 0; i < point.size(); ++i)
        strength[i] *= std::clamp(sampleTrilinear(weight, point[i]), 0.f, 1.f);
}

// What the mask's model leaves of the relief at every site.
void maskByModel(const ReliefOptions& options, PreparedTarget& prepared, const RunContext& ctx) {
    const double voxel = voxelSizeOf(*options.maskModel->grid);
    const double fade = std::max(options.fade, 1e-6 * voxel);
    const LevelSet model =
        withHalfWidth(*options.maskModel, std::max(double(kHalfWidth), options.fade / voxel + 2), ctx);
    const auto distance = scalarReader(*model.grid, GridSampling::Linear, "`mask`");
    for (std::size_t i = 0; i < prepared.target.point.size(); ++i) {
        const double inside = -distance(prepared.place.world(prepared.target.point[i])).value.z;
        prepared.target.strength[i] *= smoothStep(float(inside / fade));
    }
}

// A grid that came with the target. @throw Error Unusable
GridPtr attributeOf(const LevelSet& model, const std::string& name, const std::string& field) {
    std::string known;
    for (const GridPtr& grid : model.attributes) {
        if (grid->getName() == name) return grid;
        known += (known.empty() ? "" : ", ") + grid->getName();
    }
    throw Error(ErrorCode::Unusable, "`" + field + "`: the target has no " + name +
                                         (known.empty() ? "; it has no attributes" : "; it has " + known));
}

// What is painted on vertices, or in a grid.
void maskByAttribute(const LevelSet& model, const ReliefOptions& options, PreparedTarget& prepared) {
    const GridPtr grid = attributeOf(model, options.maskAttribute, "maskAttribute");
    GridReader colours = vectorReader(*grid, GridSampling::Linear);
    const GridReader numbers =
        colours ? GridReader{} : scalarReader(*grid, GridSampling::Linear, "`maskAttribute`");
    for (std::size_t i = 0; i < prepared.target.point.size(); ++i) {
        const Vec3d world = prepared.place.world(prepared.target.point[i]);
        double share = 0;
        if (colours) {
            const Vec3d c = colours(world).value;
            share = (c.x + c.y + c.z) / 3;
        } else {
            share = numbers(world).value.z;
        }
        prepared.target.strength[i] *= float(std::clamp(share, 0.0, 1.0));
    }
}

// The nearest voxel's coordinates, as those between voxels mean nothing where charts meet.
void maskByImage(const LevelSet& model, const ReliefOptions& options, PreparedTarget& prepared) {
    const GridPtr grid = attributeOf(model, "uv", "maskImage");
    const GridReader read = vectorReader(*grid, GridSampling::Nearest);
    if (!read) throw Error(ErrorCode::Unusable, "`maskImage`: the target's uv are no vectors");
    const SampleImage& image = *options.maskImage;
    std::vector<float> values(std::size_t(image.channels));
    for (std::size_t i = 0; i < prepared.target.point.size(); ++i) {
        const Vec3d uv = read(prepared.place.world(prepared.target.point[i])).value;
        readLinear(image, {float(uv.x * image.width), float(uv.y * image.height)}, values.data());
        float sum = 0;
        for (float v : values) sum += v;
        prepared.target.strength[i] *= std::clamp(sum / float(values.size()), 0.f, 1.f);
    }
}

void applyMasks(const LevelSet& model, const ReliefOptions& options, PreparedTarget& prepared,
                const RunContext& ctx) {
    if (!options.mask && !options.maskModel && options.maskAttribute.empty() && !options.maskImage) return;
    ReliefTarget& target = prepared.target;
    target.strength.assign(target.point.size(), 1);
    if (options.mask) {
        ControlFrame frame;
        frame.box = frame.period = {target.distance.box().min + prepared.corner,
                                    target.distance.box().max + prepared.corner};
        frame.like = model.grid.get();
        BrickField weight = sampledWeight(*options.mask, frame, 1, "`mask`", ctx);
        weight.translate(target.distance.box().min - weight.box().min);
        multiply(target.strength, target.point, weight);
    }
    if (options.maskModel) maskByModel(options, prepared, ctx);
    if (!options.maskAttribute.empty()) maskByAttribute(model, options, prepared);
    if (options.maskImage) maskByImage(model, options, prepared);
    if (std::all_of(target.strength.begin(), target.strength.end(), [](float share) { return share == 0; }))
        message(ctx, MessageLevel::Warning,
                "the mask leaves no part of the target: nothing is changed; `mask` has to meet its surface");
}

}  // namespace

Vec3f VoxelPlace::fromWorldDirection(const Vec3d& direction) const {
    // The transform is a rotation times the voxel's size, so its transpose goes back.
    Vec3f voxel;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) voxel[c] += float(toWorld[std::size_t(4 * c + r)] * direction[r]);
    return normalized(voxel);
}

VoxelPlace placeOf(const openvdb::FloatGrid& grid, const Index3& corner) {
    Affine shift = kIdentity;
    for (int axis = 0; axis < 3; ++axis) shift[std::size_t(12 + axis)] = corner[axis];
    return {multiplied(transformOf(grid), shift), voxelSizeOf(grid)};
}

TextureShape shapeAt(const std::vector<Vec3f>& point, const std::vector<Vec3f>& normal,
                     const VoxelPlace& place) {
    TextureShape shape;
    shape.origin = place.world({0, 0, 0});
    for (std::size_t i = 0; i < point.size(); ++i) {
        shape.site.push_back(cast<float>(place.world(point[i]) - shape.origin));
        const Vec3d tip = place.world(point[i] + normal[i]) - place.world(point[i]);
        shape.normal.push_back(cast<float>(normalized(tip)));
    }
    return shape;
}

std::vector<Vec3f> directionsAt(const std::vector<Vec3f>& point, const std::vector<Vec3f>& normal,
                                const VoxelPlace& place, const DirectionSource& source,
                                const RunContext& ctx) {
    std::vector<Vec3f> directions = siteDirections(shapeAt(point, normal, place), source, ctx);
    for (Vec3f& d : directions)
        if (dot(d, d) > 0) d = place.fromWorldDirection(cast<double>(d));
    return directions;
}

namespace {

// A target about an axis. [voxels]
struct Turned {
    Vec3f along, middle;
    double radius = 0;  // mean, where the surface runs along the axis; 0: nowhere

    bool isSide(const ReliefTarget& target, std::size_t site) const {
        return std::abs(dot(target.normal[site], along)) < kSideCosine;
    }
    Vec3f across(const Vec3f& point) const {
        const Vec3f off = point - middle;
        return off - along * dot(off, along);
    }
};

Turned turnedAbout(const ReliefTarget& target, const VoxelPlace& place, const Vec3d& axis) {
    Turned turned;
    turned.along = place.fromWorldDirection(axis);
    Vec3f low = target.point[0], high = low;
    for (const Vec3f& p : target.point)
        for (int a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], p[a]);
            high[a] = std::max(high[a], p[a]);
        }
    turned.middle = (low + high) * 0.5f;
    std::size_t count = 0;
    for (std::size_t i = 0; i < target.point.size(); ++i) {
        if (!turned.isSide(target, i)) continue;
        turned.radius += double(length(turned.across(target.point[i])));
        ++count;
    }
    if (count > 0) turned.radius /= double(count);
    return turned;
}

}  // namespace

double fittingFactor(const ReliefTarget& target, const VoxelPlace& place, const Vec3d& axis, double period) {
    const double radius = turnedAbout(target, place, axis).radius;
    if (radius == 0) return 1;
    const double periods = 2 * kPi * radius / period;
    return periods / std::max(1.0, std::round(periods));
}

void wrapAround(const PreparedTarget& prepared, const Vec3d& axis, double texel, double width,
                ReliefMap& map) {
    const ReliefTarget& target = prepared.target;
    const Turned turned = turnedAbout(target, prepared.place, axis);
    if (turned.radius == 0) return;
    const double periods = std::max(1.0, std::round(2 * kPi * turned.radius / (width * texel)));
    // Any two directions across the axis.
    const Vec3f seed = std::abs(turned.along.x) < 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    const Vec3f x = normalized(seed - turned.along * dot(seed, turned.along)), y = cross(turned.along, x);
    for (std::size_t i = 0; i < target.point.size(); ++i) {
        const Vec3f across = turned.across(target.point[i]);
        const Vec3f round = cross(turned.along, across);
        if (!turned.isSide(target, i) || !(length(round) > 1e-3f)) continue;
        const double angle = arcTangent(double(dot(across, y)), double(dot(across, x)));
        const double height = double(dot(target.point[i] - turned.middle, turned.along));
        const Vec3f tangent = normalized(round - target.normal[i] * dot(round, target.normal[i]));
        // v runs along normal x tangent, which is along the axis outside and against it inside a hole.
        const float up = dot(cross(target.normal[i], tangent), turned.along) < 0 ? -1.f : 1.f;
        map.coordinate[i] = {float(angle / (2 * kPi) * periods * width), up * float(height / texel)};
        map.tangent[i] = tangent;
    }
}

PreparedTarget preparedTarget(const LevelSet& model, float reach, const ReliefLabels& labels,
                              const ReliefOptions& options, const RunContext& ctx) {
    PreparedTarget prepared;
    prepared.cut = facesTouched(model);
    const IndexBox box = grownBox(model.domain, prepared.cut, int(std::ceil(reach)) + 4);
    prepared.corner = box.min;
    requireMemory(ctx, double(box.volume()) * 0.05 + 60.0 * double(reach) * double(activeVoxels(*model.grid)),
                  "a box of " + boxText(box), "use larger voxels or a smaller `strength`");
    prepared.target.distance = gatherWideBand(*model.grid, box, prepared.cut, reach, ctx);
    prepared.target.distance.translate(Index3{0, 0, 0} - prepared.target.distance.box().min);
    prepared.target.reach = reach;
    makeSites(prepared.target, ctx);
    prepared.place = placeOf(*model.grid, prepared.corner);
    const ReliefTarget& target = prepared.target;
    if (options.direction)
        prepared.target.direction =
            directionsAt(target.point, target.normal, prepared.place, *options.direction, ctx);
    if (labels) prepared.target.label = labels(shapeAt(target.point, target.normal, prepared.place));
    applyMasks(model, options, prepared, ctx);
    return prepared;
}

}  // namespace vdbsynth
