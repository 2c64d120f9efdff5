#include "libvdbsynth/render/preview.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/render/streaks.h"
#include "libvdbsynth/render/surface_colours.h"
#include "libvdbsynth/render/traced_surface.h"
#include "libvdbsynth/render/wires.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

constexpr std::size_t kRows = 48;  // of the picture that are drawn together, and two more for their edges
constexpr Vec3f kInk{0.012f, 0.014f, 0.018f};

struct Hit {
    bool surface = false;
    float depth = 0, opacity = 1;
    Vec3f place, normal;
    Vec3f colour;  // of transparent ones times their opacity
};

Vec3f unit(const Vec3d& v) {
    return normalized(cast<float>(v));
}

// The camera among the places of a surface.
Camera placed(const Camera& camera, const TracedSurface& surface) {
    Camera here = camera;
    here.eye = surface.placeHere(camera.eye);
    here.forward = normalized(surface.directionHere(camera.forward));
    here.right = normalized(surface.directionHere(camera.right));
    here.up = normalized(surface.directionHere(camera.up));
    return here;
}

// One thread's view of the scene.
class Tracer {
public:
    // @param floor  height of the ground along the up axis
    Tracer(const TracedSurface& surface, const PreviewOptions& options, const Camera& camera, float floor)
        : mSurface(surface),
          mOptions(options),
          mCamera(placed(camera, surface)),
          mEye(cast<float>(mCamera.eye)),
          mUp(unit(surface.directionHere(upVector(options.up)))),
          mLighting(surface, mCamera, mUp),
          mFloor(floor) {
        if (options.directions) mStreaks.emplace(options.directions);
        if (options.colours) mColours.emplace(options.colours);
        mGround = options.ground && dot(mUp, mEye) > mFloor + 1;
    }

    // x and y from 0 to 1, from the left and top.
    Hit trace(double x, double y) {
        Hit hit = met(x, y);
        if (hit.surface) shade(hit, skyOver(hit));
        return hit;
    }

    Lighting::Sky skyOver(const Hit& hit) const { return mLighting.skyOver(hit.place, hit.normal); }

    void shade(Hit& hit, const Lighting::Sky& sky) {
        hit.colour =
            mLighting.shaded(hit.place, hit.normal, normalized(mEye - hit.place), albedoAt(hit.place), sky);
    }

    // What is seen, without the colour of a surface.
    Hit met(double x, double y) {
        Hit hit;
        const Vec3f direction = unit(mCamera.through(x, y));
        if (mSurface.meets(mEye, direction, hit.depth)) {
            hit.surface = true;
            hit.place = mEye + direction * hit.depth;
            hit.normal = mSurface.normalAt(hit.place);
            if (dot(hit.normal, direction) > 0) hit.normal = -hit.normal;
            return hit;
        }
        hit.colour = mOptions.background.at(float(1 - y));
        const bool clear = mOptions.background.kind == Background::Kind::Transparent;
        if (clear) hit.opacity = 0;
        const float falling = -dot(direction, mUp);
        if (!mGround || falling <= 0.01f) return hit;
        const float way = (dot(mEye, mUp) - mFloor) / falling;
        const Vec3f light = mLighting.onGround(mEye + direction * way);
        if (clear)
            hit.opacity = 1 - (light.x + light.y + light.z) / 3;
        else
            hit.colour = {hit.colour.x * light.x, hit.colour.y * light.y, hit.colour.z * light.z};
        return hit;
    }

    // Without shading.
    float depthAt(double x, double y) const {
        float along = 0;
        const Vec3f direction = unit(mCamera.through(x, y));
        return mSurface.meets(mEye, direction, along) ? along * dot(direction, unit(mCamera.forward)) : 1e30f;
    }

private:
    Vec3f albedoAt(const Vec3f& place) {
        if (!mStreaks && !mColours) return kClay;
        const Vec3d world = transformed(mSurface.toWorld(), cast<double>(place));
        if (mStreaks) {
            const float streak = float(mStreaks->at(world));
            return streak < 0
                       ? kClay
                       : Vec3f{0.07f, 0.11f, 0.25f} * (1 - streak) + Vec3f{0.70f, 0.66f, 0.60f} * streak;
        }
        Vec3f colour;
        if (!mColours->at(world, colour)) return kClay;
        return Vec3f{lightOf(colour.x), lightOf(colour.y), lightOf(colour.z)} * 0.92f;
    }

    const TracedSurface& mSurface;
    const PreviewOptions& mOptions;
    Camera mCamera;
    Vec3f mEye, mUp;
    Lighting mLighting;
    std::optional<Streaks> mStreaks;
    std::optional<SurfaceColours> mColours;
    float mFloor = 0;
    bool mGround = false;
};

// Some rows of the picture, with the row before and the one after.
struct Strip {
    int width, first, rows;
    std::vector<Hit> hits;

    std::size_t index(int x, int y) const {
        return std::size_t(y - first) * std::size_t(width) + std::size_t(x);
    }
    const Hit& at(int x, int y) const { return hits[index(x, y)]; }
    bool holds(int x, int y) const { return x >= 0 && x < width && y >= first && y < first + rows; }
};

// The mean of what the places around see, at every second pixel along x and y: the sky changes slowly over a
// smooth surface. False where the pixel is one of these, or next to an edge.
bool skyBetween(const Strip& strip, const std::vector<Lighting::Sky>& skies, int x, int y,
                Lighting::Sky& mean) {
    const int alongX = x & 1, alongY = y & 1;
    if (!alongX && !alongY) return false;
    const Hit& here = strip.at(x, y);
    mean = {};
    for (const int dy : {-alongY, alongY})
        for (const int dx : {-alongX, alongX}) {
            if (!strip.holds(x + dx, y + dy)) return false;
            const Hit& there = strip.at(x + dx, y + dy);
            if (!there.surface || dot(here.normal, there.normal) < 0.97f ||
                std::abs(here.depth - there.depth) > 0.01f * here.depth)
                return false;
            const Lighting::Sky& sky = skies[strip.index(x + dx, y + dy)];
            mean.light = mean.light + sky.light * 0.25f;
            mean.open += 0.25f * sky.open;
        }
    return true;
}

void shadeStrip(Tracer& tracer, Strip& strip) {
    std::vector<Lighting::Sky> skies(strip.hits.size());
    const auto each = [&](const auto& act) {
        for (int y = strip.first; y < strip.first + strip.rows; ++y)
            for (int x = 0; x < strip.width; ++x)
                if (strip.at(x, y).surface) act(x, y, skies[strip.index(x, y)]);
    };
    each([&](int x, int y, Lighting::Sky& sky) {
        if (!(x & 1) && !(y & 1)) sky = tracer.skyOver(strip.at(x, y));
    });
    each([&](int x, int y, Lighting::Sky& sky) {
        if (((x & 1) || (y & 1)) && !skyBetween(strip, skies, x, y, sky))
            sky = tracer.skyOver(strip.at(x, y));
        tracer.shade(strip.hits[strip.index(x, y)], sky);
    });
}

bool isEdge(const Strip& strip, int x, int y) {
    const Hit& here = strip.at(x, y);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            if (!strip.holds(x + dx, y + dy)) continue;
            const Hit& there = strip.at(x + dx, y + dy);
            if (here.surface != there.surface) return true;
            if (!here.surface) continue;
            if (dot(here.normal, there.normal) < 0.88f ||
                std::abs(here.depth - there.depth) > 0.02f * here.depth)
                return true;
            const Vec3f change = here.colour - there.colour;
            if (dot(change, change) > 0.012f) return true;
        }
    return false;
}

class LevelSetDrawing final : public Drawing {
public:
    LevelSetDrawing(const openvdb::FloatGrid& grid, const PreviewOptions& options, const RunContext& ctx)
        : mOptions(options), mSurface(grid, ctx), mOutline(mSurface.outline()) {
        mFloor = float(mSurface.lowest(normalized(mSurface.directionHere(upVector(options.up)))));
    }

    const std::vector<Vec3d>& outline() const override { return mOutline; }

    Picture drawn(const Camera& camera, const RunContext& ctx) const override {
        const int width = mOptions.width, height = mOptions.height;
        const int channels = mOptions.background.kind == Background::Kind::Transparent ? 4 : 3;
        Picture picture{width, height, {}, channels};
        picture.pixels.resize(std::size_t(width) * std::size_t(height) * std::size_t(channels));
        const std::vector<float> wires = wiresOf(camera, ctx);
        Stage stage(ctx, "rendering", 1);
        parallelFor(ctx, std::size_t(height), kRows, [&](std::size_t begin, std::size_t end) {
            Tracer tracer(mSurface, mOptions, camera, mFloor);
            drawRows(tracer, int(begin), int(end), wires, picture);
        });
        stage.advance();
        return picture;
    }

private:
    std::vector<float> wiresOf(const Camera& camera, const RunContext& ctx) const {
        if (!mOptions.wires) return {};
        const int width = mOptions.width, height = mOptions.height;
        std::vector<float> depths(std::size_t(width) * std::size_t(height));
        const float voxel = float(1 / length(mSurface.directionHere(Vec3d{1, 0, 0})));
        parallelFor(ctx, std::size_t(height), kRows, [&](std::size_t begin, std::size_t end) {
            const Tracer tracer(mSurface, mOptions, camera, mFloor);
            for (std::size_t y = begin; y < end; ++y)
                for (std::size_t x = 0; x < std::size_t(width); ++x)
                    depths[y * std::size_t(width) + x] =
                        voxel * tracer.depthAt((double(x) + 0.5) / width, (double(y) + 0.5) / height);
        });
        return wireCoverage(*mOptions.wires, camera, width, height, depths, 1.5 * double(voxel));
    }

    void drawRows(Tracer& tracer, int begin, int end, const std::vector<float>& wires,
                  Picture& picture) const {
        const int width = mOptions.width, height = mOptions.height;
        Strip strip{width, std::max(0, begin - 1), 0, {}};
        strip.rows = std::min(height, end + 1) - strip.first;
        strip.hits.reserve(std::size_t(width) * std::size_t(strip.rows));
        for (int y = strip.first; y < strip.first + strip.rows; ++y)
            for (int x = 0; x < width; ++x)
                strip.hits.push_back(tracer.met((x + 0.5) / width, (y + 0.5) / height));
        shadeStrip(tracer, strip);
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < width; ++x) {
                Vec3f colour = strip.at(x, y).colour;
                float opacity = strip.at(x, y).opacity;
                if (mOptions.samples > 1 && isEdge(strip, x, y)) {
                    // Places that fill a square evenly, whatever their number [roberts2018].
                    double u = 0.5, v = 0.5;
                    for (int s = 1; s < mOptions.samples; ++s) {
                        u += 0.7548776662466927;
                        v += 0.5698402909980532;
                        u -= std::floor(u);
                        v -= std::floor(v);
                        const Hit hit = tracer.trace((x + u) / width, (y + v) / height);
                        colour = colour + hit.colour;
                        opacity += hit.opacity;
                    }
                    colour = colour * (1.f / float(mOptions.samples));
                    opacity /= float(mOptions.samples);
                }
                const std::size_t pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
                if (!wires.empty())
                    colour = colour * (1 - 0.8f * wires[pixel]) + kInk * (0.8f * wires[pixel]);
                std::uint8_t* out = &picture.pixels[pixel * std::size_t(picture.channels)];
                const float share = picture.channels == 4 ? 1 / std::max(opacity, 1e-4f) : 1;
                out[0] = shownByte(colour.x * share);
                out[1] = shownByte(colour.y * share);
                out[2] = shownByte(colour.z * share);
                if (picture.channels == 4) out[3] = std::uint8_t(std::clamp(opacity, 0.f, 1.f) * 255 + 0.5f);
            }
    }

    PreviewOptions mOptions;
    TracedSurface mSurface;
    std::vector<Vec3d> mOutline;
    float mFloor = 0;
};

}  // namespace

void requirePictureSize(int width, int height) {
    requireOption(width >= 16 && height >= 16 && width <= 8192 && height <= 8192, "width",
                  std::to_string(width) + ", height " + std::to_string(height),
                  "from 16 to 8192 pixels each");
}

void validate(const PreviewOptions& options) {
    requirePictureSize(options.width, options.height);
    const double squared = dot(options.view, options.view);
    requireOption(squared > 0 && std::isfinite(squared), "view",
                  roundedText(options.view.x, 6) + "," + roundedText(options.view.y, 6) + "," +
                      roundedText(options.view.z, 6),
                  "a direction");
    requireOption(options.samples >= 1 && options.samples <= 64, "samples", std::to_string(options.samples),
                  "from 1 to 64");
    requireOption(options.density > 0 && options.density <= 1e6, "density", roundedText(options.density, 6),
                  "above 0, at most 1000000");
    if (options.directions) Streaks(options.directions);
    if (options.colours) SurfaceColours(options.colours);
}

std::unique_ptr<Drawing> drawingOf(const openvdb::FloatGrid& grid, const PreviewOptions& options,
                                   const RunContext& ctx) {
    validate(options);
    return withThreads(ctx, [&]() -> std::unique_ptr<Drawing> {
        return std::make_unique<LevelSetDrawing>(grid, options, ctx);
    });
}

Picture renderPreview(const openvdb::FloatGrid& grid, const PreviewOptions& options, const RunContext& ctx) {
    const std::unique_ptr<Drawing> drawing = drawingOf(grid, options, ctx);
    const Framing framing =
        framed(drawing->outline(), {options.view}, options.up, double(options.width) / options.height);
    return withThreads(ctx, [&] { return drawing->drawn(framing.cameras.front(), ctx); });
}

}  // namespace vdbsynth
