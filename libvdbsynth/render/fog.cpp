#include "libvdbsynth/render/fog.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/render/surface_colours.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

constexpr double kOpticalSide = 10;    // absorption across the cube of fog.h
constexpr double kLightSamples = 3e5;  // of the volumes of light
constexpr int kBrick = BrickField::kSide;

// e to -x, for x of at least 0: the same bits on every processor.
float decay(float x) {
    float y = std::max(0.f, 1 - x * (1.f / 256));
    for (int i = 0; i < 8; ++i) y *= y;
    return y;
}

struct Range {
    double begin = 0, end = 0;
    bool empty() const { return !(begin < end); }
};

// Densities in index space from the corner of their box, and the transform of their grid.
class Fog {
public:
    Fog(const openvdb::FloatGrid& grid, double density, const RunContext& ctx)
        : mTransform(grid.transform().copy()) {
        if (!grid.transform().isLinear())
            throw Error(ErrorCode::BadData,
                        "the fog: its transform is not linear; resample it to uniform voxels");
        if (grid.activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, "the fog: no active voxels");
        const IndexBox box = fromBBox(grid.evalActiveVoxelBoundingBox()).expanded(1);
        mCorner = toVec(Vec3d{double(box.min.x), double(box.min.y), double(box.min.z)});
        mField = gatherBricks(grid, box, 1, 1e30f, ctx);
        if (!mField.finite()) throw Error(ErrorCode::BadData, "the fog: holds NaN or infinite values");
        const openvdb::Vec3d sides = grid.voxelSize();
        mVoxel = std::min({sides[0], sides[1], sides[2]});
        mSize = box.size();
        measure(sides[0] * sides[1] * sides[2], density, ctx);
    }

    const std::vector<Vec3d>& outline() const { return mOutline; }
    const Index3& size() const { return mSize; }
    double voxel() const { return mVoxel; }
    Vec3d placeHere(const Vec3d& world) const {
        return fromVec(mTransform->worldToIndex(toVec(world)) - mCorner);
    }
    Vec3d directionHere(const Vec3d& world) const {
        return fromVec(mTransform->worldToIndex(toVec(world)) - mTransform->worldToIndex(openvdb::Vec3d(0)));
    }
    Vec3d worldOf(const Vec3d& place) const {
        return fromVec(mTransform->indexToWorld(toVec(place) + mCorner));
    }
    /// Absorption per world unit.
    float absorption(const Vec3f& p) const { return mAbsorption * std::max(0.f, sampleTrilinear(mField, p)); }

    Range within(const Vec3d& origin, const Vec3d& direction) const {
        Range range{0, 1e300};
        for (int axis = 0; axis < 3; ++axis) {
            const double d = direction[axis];
            if (std::abs(d) < 1e-300) {
                if (origin[axis] < 0 || origin[axis] > mSize[axis] - 1) return {};
                continue;
            }
            const double low = -origin[axis] / d, high = (mSize[axis] - 1 - origin[axis]) / d;
            range.begin = std::max(range.begin, std::min(low, high));
            range.end = std::min(range.end, std::max(low, high));
        }
        return range;
    }

    /// Where a ray leaves the empty brick at a place, no sooner than `way`; a place with fog is itself.
    double pastEmpty(const Vec3d& origin, const Vec3d& direction, double way) const {
        const Vec3d p = origin + direction * way;
        const Index3 brick{int(p.x) / kBrick, int(p.y) / kBrick, int(p.z) / kBrick};
        for (int axis = 0; axis < 3; ++axis)
            if (brick[axis] < 0 || brick[axis] >= mBricks[axis]) return way;
        if (mFull[latticeIndex(brick, mBricks)]) return way;
        double leave = 1e300;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = direction[axis];
            if (std::abs(d) < 1e-300) continue;
            leave = std::min(leave, ((brick[axis] + (d > 0)) * double(kBrick) - origin[axis]) / d);
        }
        return std::max(way, leave);
    }

private:
    void measure(double volume, double density, const RunContext& ctx) {
        mBricks = {(mSize.x + kBrick - 1) / kBrick, (mSize.y + kBrick - 1) / kBrick,
                   (mSize.z + kBrick - 1) / kBrick};
        const std::size_t count = latticeCount(mBricks);
        mFull.assign(count, 0);
        std::vector<double> sums(count), squares(count);
        parallelFor(ctx, count, 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                const Index3 low = latticeVoxel(b, mBricks) * kBrick;
                float value = 0;
                // A cell reaches the samples of the next brick.
                mFull[b] =
                    !mField.constantIn({low, low + Index3{kBrick, kBrick, kBrick}}, value) || value > 0;
                if (!mFull[b]) continue;
                forEachVoxel(IndexBox::cube(low, kBrick).intersection(mField.box()), [&](const Index3& p) {
                    const double d = std::max(0.0, double(mField.inside(p)));
                    sums[b] += d;
                    squares[b] += d * d;
                });
            }
        });
        double sum = 0, square = 0;
        for (std::size_t b = 0; b < count; ++b) {
            sum += sums[b];
            square += squares[b];
        }
        if (!(sum > 0)) throw Error(ErrorCode::EmptyInput, "the fog: no density above 0");
        const double dense = square / sum, cube = sum / dense * volume;
        const double side = exponential(logarithm2(cube) * (0.69314718055994530942 / 3));
        mAbsorption = float(kOpticalSide * density / (dense * side));
        lookForOutline(0.02 * dense);
    }

    void lookForOutline(double least) {
        for (std::size_t b = 0; b < mFull.size(); ++b) {
            if (!mFull[b]) continue;
            IndexBox held{{1 << 30, 1 << 30, 1 << 30}, {-1, -1, -1}};
            const Index3 low = latticeVoxel(b, mBricks) * kBrick;
            forEachVoxel(IndexBox::cube(low, kBrick).intersection(mField.box()), [&](const Index3& p) {
                if (!(double(mField.inside(p)) > least)) return;
                for (int axis = 0; axis < 3; ++axis) {
                    held.min[axis] = std::min(held.min[axis], p[axis]);
                    held.max[axis] = std::max(held.max[axis], p[axis]);
                }
            });
            if (held.empty()) continue;
            for (int c = 0; c < 8; ++c) {
                Vec3d p;
                for (int axis = 0; axis < 3; ++axis)
                    p[axis] = c >> axis & 1 ? held.max[axis] : held.min[axis];
                mOutline.push_back(worldOf(p));
            }
        }
        if (mOutline.empty()) mOutline.push_back(worldOf({mSize.x / 2.0, mSize.y / 2.0, mSize.z / 2.0}));
    }

    openvdb::math::Transform::Ptr mTransform;
    openvdb::Vec3d mCorner;
    BrickField mField;
    Index3 mSize, mBricks;
    std::vector<std::uint8_t> mFull;
    std::vector<Vec3d> mOutline;
    double mVoxel = 1;
    float mAbsorption = 1;
};

// The absorption between every place and the light, on every few voxels.
class Shade {
public:
    /// @param towards  [world] unit vector to the light
    Shade(const Fog& fog, const Vec3d& towards, const RunContext& ctx) : mFog(&fog) {
        const Index3& size = fog.size();
        while (double(size.x) * size.y * size.z / (double(mStep) * mStep * mStep) > kLightSamples) ++mStep;
        mSize = {(size.x + mStep - 1) / mStep + 1, (size.y + mStep - 1) / mStep + 1,
                 (size.z + mStep - 1) / mStep + 1};
        mTowards = fog.directionHere(towards);
        std::vector<float> values(latticeCount(mSize));
        const double stride = fog.voxel() * std::max(1.5, double(mStep));
        parallelFor(ctx, values.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Index3 p = latticeVoxel(i, mSize) * mStep;
                values[i] = alongRay({double(p.x), double(p.y), double(p.z)}, stride);
            }
        });
        mField = BrickField(IndexBox::fromSize(mSize), 0);
        mField.writeBox({0, 0, 0}, mSize, values.data());
    }

    float at(const Vec3f& place) const { return sampleTrilinear(mField, place * (1.f / float(mStep))); }

    /// Of a place outside the fog: what a ray from there meets.
    float through(const Vec3d& place) const {
        const Range range = mFog->within(place, mTowards);
        return range.empty() ? 0 : at(cast<float>(place + mTowards * range.begin));
    }

private:
    float alongRay(const Vec3d& origin, double stride) const {
        const Range range = mFog->within(origin, mTowards);
        float sum = 0;
        for (double way = range.begin + 0.5 * stride; way < range.end;) {
            const double next = mFog->pastEmpty(origin, mTowards, way);
            if (next > way) {
                way = next + 0.5 * stride;
                continue;
            }
            sum += mFog->absorption(cast<float>(origin + mTowards * way)) * float(stride);
            if (sum > 40) break;
            way += stride;
        }
        return sum;
    }

    const Fog* mFog;
    int mStep = 1;
    Index3 mSize;
    Vec3d mTowards;
    BrickField mField;
};

// What of the light is left after `absorbed`, scattered once and more often.
float scattered(float absorbed) {
    return 0.62f * decay(absorbed) + 0.27f * decay(0.35f * absorbed) + 0.11f * decay(0.1f * absorbed);
}

class FogDrawing final : public Drawing {
public:
    FogDrawing(const openvdb::FloatGrid& grid, const PreviewOptions& options, const RunContext& ctx)
        : mOptions(options), mFog(grid, options.density, ctx) {
        const Vec3d up = upVector(options.up);
        for (const Vec3d& p : mFog.outline()) mFloor = std::min(mFloor, dot(p, up));
    }

    const std::vector<Vec3d>& outline() const override { return mFog.outline(); }

    Picture drawn(const Camera& camera, const RunContext& ctx) const override {
        const int width = mOptions.width, height = mOptions.height;
        const int channels = mOptions.background.kind == Background::Kind::Transparent ? 4 : 3;
        Picture picture{width, height, {}, channels};
        picture.pixels.resize(std::size_t(width) * std::size_t(height) * std::size_t(channels));
        const Vec3d up = upVector(mOptions.up);
        const Shade sun(mFog, sunOf(camera, up), ctx), sky(mFog, up, ctx);
        Stage stage(ctx, "rendering", 1);
        parallelFor(ctx, std::size_t(height), 8, [&](std::size_t begin, std::size_t end) {
            std::optional<SurfaceColours> colours;
            if (mOptions.colours) colours.emplace(mOptions.colours);
            const View view{camera, up, sun, sky};
            for (std::size_t y = begin; y < end; ++y)
                for (int x = 0; x < width; ++x)
                    drawPixel(
                        view, colours, x, int(y),
                        &picture.pixels[(y * std::size_t(width) + std::size_t(x)) * std::size_t(channels)]);
        });
        stage.advance();
        return picture;
    }

private:
    struct View {
        const Camera& camera;
        Vec3d up;
        const Shade &sun, &sky;
    };

    static Vec3d sunOf(const Camera& camera, const Vec3d& up) {
        return normalized(camera.right * -0.75 + up * 0.95 - camera.forward * 0.35);
    }

    Vec3f ground(const View& view, const Vec3d& direction, const Vec3f& behind, float& opacity) const {
        const double falling = -dot(direction, view.up), above = dot(view.camera.eye, view.up) - mFloor;
        if (!mOptions.ground || above <= 0 || falling <= 0.01) return behind;
        const Vec3d place = mFog.placeHere(view.camera.eye + direction * (above / falling));
        const float key = decay(view.sun.through(place)), open = scattered(view.sky.through(place));
        const float light = 0.62f * key + 0.38f * open;
        opacity = 1 - light;
        return behind * light;
    }

    void drawPixel(const View& view, std::optional<SurfaceColours>& colours, int x, int y,
                   std::uint8_t* out) const {
        const double u = (x + 0.5) / mOptions.width, v = (y + 0.5) / mOptions.height;
        const Vec3d direction = normalized(view.camera.through(u, v));
        float passes = 1;
        const Vec3f fog = alongRay(view, direction, colours, passes);
        float shadow = 0;
        const bool clear = mOptions.background.kind == Background::Kind::Transparent;
        const Vec3f behind = ground(view, direction, mOptions.background.at(float(1 - v)), shadow);
        Vec3f colour = fog + behind * passes;
        if (clear) {
            const float opacity = 1 - passes * (1 - shadow);
            colour = fog * (1 / std::max(opacity, 1e-4f));
            out[3] = std::uint8_t(std::clamp(opacity, 0.f, 1.f) * 255 + 0.5f);
        }
        for (int c = 0; c < 3; ++c) out[c] = shownByte(colour[c]);
    }

    Vec3f alongRay(const View& view, const Vec3d& direction, std::optional<SurfaceColours>& colours,
                   float& passes) const {
        const Vec3d origin = mFog.placeHere(view.camera.eye), heading = mFog.directionHere(direction);
        const Range range = mFog.within(origin, heading);
        const Index3& size = mFog.size();
        const double stride = mFog.voxel() * std::max(1.0, std::max({size.x, size.y, size.z}) / 300.0);
        Vec3f sum;
        for (double way = range.begin + 0.5 * stride; way < range.end && passes > 0.004f;) {
            const double next = mFog.pastEmpty(origin, heading, way);
            if (next > way) {
                // On the same places as without the gap.
                way += stride * std::max(1.0, std::ceil((next - way) / stride));
                continue;
            }
            const Vec3f place = cast<float>(origin + heading * way);
            const float absorbed = mFog.absorption(place) * float(stride);
            way += stride;
            if (absorbed < 1e-5f) continue;
            const float left = decay(absorbed), key = scattered(view.sun.at(place)),
                        open = scattered(0.7f * view.sky.at(place));
            Vec3f light = Vec3f{1.02f, 0.97f, 0.90f} * (0.92f * key) +
                          Vec3f{0.50f, 0.56f, 0.66f} * (0.36f * open + 0.03f);
            Vec3f tint;
            if (colours && colours->at(mFog.worldOf(cast<double>(place)), tint))
                light = {light.x * lightOf(tint.x), light.y * lightOf(tint.y), light.z * lightOf(tint.z)};
            sum = sum + light * (passes * (1 - left));
            passes *= left;
        }
        return sum;
    }

    PreviewOptions mOptions;
    Fog mFog;
    double mFloor = 1e300;
};

}  // namespace

std::unique_ptr<Drawing> drawingOfFog(const openvdb::FloatGrid& fog, const PreviewOptions& options,
                                      const RunContext& ctx) {
    validate(options);
    return withThreads(
        ctx, [&]() -> std::unique_ptr<Drawing> { return std::make_unique<FogDrawing>(fog, options, ctx); });
}

}  // namespace vdbsynth
