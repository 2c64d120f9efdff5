#include "libvdbsynth/render/preview.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/RayIntersector.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

using Intersector = openvdb::tools::LevelSetRayIntersector<openvdb::FloatGrid>;
using Ray = Intersector::RayType;

struct Camera {
    Vec3d eye, forward, right, up;
    double tangent = 0;  // of half the vertical field of view
};

Camera aimAt(const Vec3d& low, const Vec3d& high, const PreviewOptions& options) {
    const Vec3d centre = (low + high) * 0.5;
    Camera camera;
    const Vec3d back = normalized(options.view);
    camera.forward = -back;
    const Vec3d up = std::abs(back.z) > 0.999 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    camera.right = normalized(cross(camera.forward, up));
    camera.up = cross(camera.right, camera.forward);
    camera.tangent = 0.32;
    // The nearest distance at which every corner of the box is in the picture, with a margin of 4 %.
    const double aspect = double(options.width) / options.height;
    double distance = 0;
    for (int c = 0; c < 8; ++c) {
        const Vec3d corner =
            Vec3d{c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z} - centre;
        const double side =
            std::max(std::abs(dot(corner, camera.right)) / aspect, std::abs(dot(corner, camera.up)));
        distance = std::max(distance, 1.04 * side / camera.tangent - dot(corner, camera.forward));
    }
    camera.eye = centre + back * distance;
    return camera;
}

struct Hit {
    bool surface = false;
    Vec3d colour;  // linear light
    Vec3d normal;
    double depth = 0;
};

// Brightness along lines of a vector field.
class Streaks {
public:
    explicit Streaks(const openvdb::Vec3SGrid& field) : mField(&field), mAccessor(field.getConstAccessor()) {}

    /// 0..1, or negative where the field has no direction.
    double at(const Vec3d& position) {
        const openvdb::Vec3d start = mField->worldToIndex(toVec(position));
        Vec3d first;
        if (!along(start, first)) return -1;
        double sum = 0;
        int count = 0;
        for (const double way : {1.0, -1.0}) {
            openvdb::Vec3d p = start;
            Vec3d heading = first * way;
            for (int s = 0; s < kSteps; ++s) {
                sum += noise(p);
                ++count;
                p += toVec(heading * kStep);
                Vec3d next;
                if (!along(p, next)) break;
                heading = dot(next, heading) < 0 ? -next : next;
            }
        }
        // The mean of many varies little; rescale it to the whole range.
        return std::clamp(0.5 + (sum / count - 0.5) * 1.4 * std::sqrt(count * kStep), 0.0, 1.0);
    }

private:
    static constexpr int kSteps = 12;
    static constexpr double kStep = 0.5;  // [voxels]

    bool along(const openvdb::Vec3d& p, Vec3d& direction) {
        openvdb::Vec3f value;
        if (!mAccessor.probeValue(openvdb::Coord::round(p), value)) return false;
        const openvdb::Vec3d index =
            mField->worldToIndex(mField->indexToWorld(openvdb::Vec3d(0)) + openvdb::Vec3d(value)) -
            openvdb::Vec3d(0);
        direction = fromVec(index);
        const double size = length(direction);
        if (!(size > 0)) return false;
        direction = direction * (1 / size);
        return true;
    }

    static double noise(const openvdb::Vec3d& p) {
        const openvdb::Coord voxel = openvdb::Coord::round(p);
        const auto part = [](int v) { return std::uint64_t(std::uint32_t(v)) & 0x1fffff; };
        return Random(1, part(voxel.x()) << 42 | part(voxel.y()) << 21 | part(voxel.z())).uniform();
    }

    const openvdb::Vec3SGrid* mField;
    openvdb::Vec3SGrid::ConstAccessor mAccessor;
};

class Scene {
public:
    Scene(const openvdb::FloatGrid& grid, const Camera& camera, double voxel,
          const openvdb::Vec3SGrid* directions)
        : mIntersector(grid),
          mCamera(camera),
          mVoxel(voxel),
          mLight(normalized(camera.right * -0.55 + camera.up * 0.75 - camera.forward * 0.6)) {
        if (directions) mStreaks.emplace(*directions);
    }

    Hit trace(double u, double v) {
        Hit hit;
        const Vec3d direction = normalized(mCamera.forward + mCamera.right * u + mCamera.up * v);
        openvdb::Vec3d position, normal;
        double time = 0;
        const Ray ray(toVec(mCamera.eye), toVec(direction));
        if (!mIntersector.intersectsWS(ray, position, normal, time)) {
            const double t = std::clamp(0.5 + v / (2 * mCamera.tangent), 0.0, 1.0);
            hit.colour = Vec3d{0.80, 0.83, 0.87} * (1 - t) + Vec3d{0.95, 0.96, 0.97} * t;
            return hit;
        }
        hit.surface = true;
        hit.normal = normalized(fromVec(normal));
        if (dot(hit.normal, direction) > 0) hit.normal = -hit.normal;
        hit.depth = time;
        hit.colour = shade(fromVec(position), hit.normal, direction);
        return hit;
    }

private:
    Vec3d shade(const Vec3d& position, const Vec3d& normal, const Vec3d& direction) {
        const double facing = dot(normal, mLight);
        double key = 0;
        if (facing > 0) {
            openvdb::Vec3d point;
            const Ray shadow(toVec(position + normal * (1.5 * mVoxel)), toVec(mLight), 0.1 * mVoxel);
            key = mIntersector.intersectsWS(shadow, point) ? 0 : facing;
        }
        const double sky = 0.5 + 0.5 * dot(normal, mCamera.up);
        const double rim = std::max(0.0, 1 + dot(normal, direction));
        Vec3d albedo{0.80, 0.62, 0.46};
        const double streak = mStreaks ? mStreaks->at(position) : -1;
        if (streak >= 0) albedo = Vec3d{0.10, 0.16, 0.36} * (1 - streak) + Vec3d{0.92, 0.88, 0.80} * streak;
        const Vec3d light = Vec3d{1.0, 0.96, 0.90} * (0.95 * key) + Vec3d{0.30, 0.36, 0.45} * (0.75 * sky) +
                            Vec3d{0.16, 0.13, 0.11} + Vec3d{0.10, 0.11, 0.13} * (rim * rim);
        return {albedo.x * light.x, albedo.y * light.y, albedo.z * light.z};
    }

    Intersector mIntersector;
    Camera mCamera;
    double mVoxel;
    Vec3d mLight;
    std::optional<Streaks> mStreaks;
};

const openvdb::Vec3SGrid* vectorsOf(const GridConstPtr& grid) {
    if (!grid) return nullptr;
    if (!grid->isType<openvdb::Vec3SGrid>())
        throw Error(ErrorCode::BadData, "`directions`: grid " + grid->getName() + " holds " +
                                            grid->valueType() + "; vectors of floats are needed");
    return static_cast<const openvdb::Vec3SGrid*>(grid.get());
}

// Gamma 2 for 2.2: a square root has the same bits on every processor.
std::uint8_t encode(double light) {
    return std::uint8_t(std::clamp(std::sqrt(std::max(0.0, light)), 0.0, 1.0) * 255 + 0.5);
}

bool isEdge(const std::vector<Hit>& hits, int width, int height, int x, int y) {
    const Hit& here = hits[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
            const Hit& there = hits[std::size_t(ny) * std::size_t(width) + std::size_t(nx)];
            if (here.surface != there.surface) return true;
            if (!here.surface) continue;
            if (dot(here.normal, there.normal) < 0.9 ||
                std::abs(here.depth - there.depth) > 0.02 * here.depth)
                return true;
            const Vec3d change = here.colour - there.colour;
            if (dot(change, change) > 0.01) return true;
        }
    return false;
}

void requireSize(int width, int height) {
    requireOption(width >= 16 && height >= 16 && width <= 8192 && height <= 8192, "width",
                  std::to_string(width) + ", height " + std::to_string(height),
                  "from 16 to 8192 pixels each");
}

}  // namespace

void validate(const PreviewOptions& options) {
    requireSize(options.width, options.height);
    const double squared = dot(options.view, options.view);
    requireOption(squared > 0 && std::isfinite(squared), "view",
                  roundedText(options.view.x, 6) + "," + roundedText(options.view.y, 6) + "," +
                      roundedText(options.view.z, 6),
                  "a direction");
    requireOption(options.samples >= 1 && options.samples <= 64, "samples", std::to_string(options.samples),
                  "from 1 to 64");
    vectorsOf(options.directions);
}

void validate(const SliceOptions& options, const IndexBox& box) {
    requireSize(options.width, options.height);
    requireOption(options.axis >= 0 && options.axis <= 2, "axis", std::to_string(options.axis),
                  "0, 1 or 2 for x, y or z");
    requireOption(options.fraction >= 0 && options.fraction <= 1, "fraction",
                  roundedText(options.fraction, 6), "from 0 to 1");
    requireBox(box, "box");
}

Picture renderPreview(const openvdb::FloatGrid& grid, const PreviewOptions& options, const RunContext& ctx) {
    validate(options);
    const openvdb::Vec3SGrid* directions = vectorsOf(options.directions);
    const IndexBox box = solidBox(grid, "the model");
    // The corners of the solid's box in world space; a rotated grid gives the box around them.
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (int c = 0; c < 8; ++c) {
        const Vec3d corner{c & 1 ? box.max.x + 0.5 : box.min.x - 0.5,
                           c & 2 ? box.max.y + 0.5 : box.min.y - 0.5,
                           c & 4 ? box.max.z + 0.5 : box.min.z - 0.5};
        const Vec3d world = fromVec(grid.indexToWorld(toVec(corner)));
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], world[axis]);
            high[axis] = std::max(high[axis], world[axis]);
        }
    }
    const Camera camera = aimAt(low, high, options);
    const int width = options.width, height = options.height;
    std::vector<Hit> hits(std::size_t(width) * std::size_t(height));
    Picture picture{width, height, std::vector<std::uint8_t>(hits.size() * 3)};
    const auto toPlane = [&](double px, double py, double& u, double& v) {
        u = (2 * px / width - 1) * camera.tangent * width / height;
        v = (1 - 2 * py / height) * camera.tangent;
    };
    Stage stage(ctx, "rendering", 2);
    behindWall(ErrorCode::Unusable, "the model cannot be rendered", [&] {
        const Scene scene(grid, camera, voxelSizeOf(grid), directions);
        parallelFor(ctx, std::size_t(height), 4, [&](std::size_t begin, std::size_t end) {
            Scene mine = scene;
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < width; ++x) {
                    double u, v;
                    toPlane(x + 0.5, y + 0.5, u, v);
                    hits[std::size_t(y) * std::size_t(width) + std::size_t(x)] = mine.trace(u, v);
                }
        });
        stage.advance();
        parallelFor(ctx, std::size_t(height), 4, [&](std::size_t begin, std::size_t end) {
            Scene mine = scene;
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < width; ++x) {
                    const std::size_t pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
                    Vec3d colour = hits[pixel].colour;
                    if (options.samples > 1 && isEdge(hits, width, height, x, y)) {
                        Random random(0, pixel);
                        for (int s = 1; s < options.samples; ++s) {
                            double u, v;
                            toPlane(x + random.uniform(), y + random.uniform(), u, v);
                            colour = colour + mine.trace(u, v).colour;
                        }
                        colour = colour * (1.0 / options.samples);
                    }
                    for (int c = 0; c < 3; ++c)
                        picture.pixels[pixel * 3 + std::size_t(c)] = encode(colour[c]);
                }
        });
    });
    stage.advance();
    return picture;
}

Picture renderSlice(const openvdb::FloatGrid& grid, const IndexBox& box, const SliceOptions& options,
                    const RunContext& ctx) {
    validate(options, box);
    const int axis = options.axis, across = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
    const double slice = box.min[axis] + options.fraction * (box.max[axis] - box.min[axis]);
    const double scale =
        std::max(double(box.size()[across]) / options.width, double(box.size()[up]) / options.height) *
        1.04;  // voxels per pixel
    const double voxel = voxelSizeOf(grid);
    Picture picture{options.width, options.height,
                    std::vector<std::uint8_t>(std::size_t(options.width) * std::size_t(options.height) * 3)};
    parallelFor(ctx, std::size_t(options.height), 8, [&](std::size_t begin, std::size_t end) {
        const auto accessor = grid.getConstAccessor();
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < options.width; ++x) {
                Vec3d p;
                p[axis] = slice;
                p[across] =
                    0.5 * (box.min[across] + box.max[across]) + (x + 0.5 - 0.5 * options.width) * scale;
                p[up] = 0.5 * (box.min[up] + box.max[up]) - (y + 0.5 - 0.5 * options.height) * scale;
                const double value = double(openvdb::tools::BoxSampler::sample(accessor, toVec(p))) / voxel;
                const double line = std::abs(value - std::floor(value + 0.5)) / std::max(scale, 1e-9);
                Vec3d colour = value < 0 ? Vec3d{0.85, 0.55, 0.30} : Vec3d{0.55, 0.68, 0.85};
                colour = colour * (1 - 0.12 * std::min(std::abs(value), 3.0));
                if (line < 0.7 && std::abs(value) < 2.9) colour = colour * 0.85;
                if (std::abs(value) / scale < 1.0) colour = Vec3d{0, 0, 0};
                const std::size_t pixel = std::size_t(y) * std::size_t(options.width) + std::size_t(x);
                for (int c = 0; c < 3; ++c) picture.pixels[pixel * 3 + std::size_t(c)] = encode(colour[c]);
            }
    });
    return picture;
}

}  // namespace vdbsynth
