#include "libvdbsynth/render/shading.h"

#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

constexpr Vec3f kKeyColour{1.30f, 1.21f, 1.08f}, kBehindColour{0.30f, 0.34f, 0.40f};
constexpr Vec3f kZenith{0.74f, 0.80f, 0.90f}, kHorizon{0.56f, 0.57f, 0.60f}, kFloor{0.34f, 0.31f, 0.28f};
constexpr float kSharpness = 7;  // of the shadow: one over the tangent of the light's half-angle
constexpr float kCone = 0.62f;   // tangent of half the angle of a direction's cone
constexpr double kShown = 4096;  // entries of the tables

Vec3f scaled(const Vec3f& a, const Vec3f& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

double power(double base, double exponent) {
    return base <= 0 ? 0 : exponential(exponent * logarithm2(base) * 0.69314718055994530942);
}

// sRGB's curve, tabulated over the square root of the light, where it is nearly straight.
std::vector<float> makeShown() {
    std::vector<float> table;
    for (int i = 0; i <= int(kShown); ++i) {
        const double root = i / kShown, light = root * root;
        table.push_back(
            float(255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * power(light, 1 / 2.4) - 0.055)));
    }
    return table;
}

std::vector<float> makeLight() {
    std::vector<float> table;
    for (int i = 0; i <= int(kShown); ++i) {
        const double shown = i / kShown;
        table.push_back(float(shown <= 0.04045 ? shown / 12.92 : power((shown + 0.055) / 1.055, 2.4)));
    }
    return table;
}

float smooth(float t) {
    return t * t * (3 - 2 * t);
}

Vec3f unit(const Vec3d& v) {
    return normalized(cast<float>(v));
}

}  // namespace

std::uint8_t shownByte(float light) {
    static const std::vector<float> table = makeShown();
    // From 0.7 on 1 is approached as 1 / x is zero.
    constexpr float kKnee = 0.7f;
    if (light > kKnee) light = 1 - (1 - kKnee) / (1 + (light - kKnee) / (1 - kKnee));
    const float at = std::sqrt(std::clamp(light, 0.f, 1.f)) * float(kShown);
    const std::size_t i = std::min(std::size_t(at), table.size() - 2);
    return std::uint8_t(table[i] + (table[i + 1] - table[i]) * (at - float(i)) + 0.5f);
}

float lightOf(float shown) {
    static const std::vector<float> table = makeLight();
    const float at = std::clamp(shown, 0.f, 1.f) * float(kShown);
    const std::size_t i = std::min(std::size_t(at), table.size() - 2);
    return table[i] + (table[i + 1] - table[i]) * (at - float(i));
}

Vec3f Background::at(float height) const {
    if (kind == Kind::Transparent) return {0, 0, 0};
    if (kind == Kind::Plain) return {lightOf(colour.x), lightOf(colour.y), lightOf(colour.z)};
    const float t = smooth(std::clamp(height, 0.f, 1.f));
    return Vec3f{0.55f, 0.57f, 0.60f} * (1 - t) + Vec3f{0.72f, 0.75f, 0.79f} * t;
}

Lighting::Lighting(const TracedSurface& surface, const Camera& camera, const Vec3f& up)
    : mSurface(&surface), mUp(up) {
    const Vec3f right = unit(camera.right), back = -unit(camera.forward), screenUp = unit(camera.up);
    // From above also where the camera looks up, but never from below the picture.
    const Vec3f level = back - up * dot(back, up);
    const bool steep = dot(level, level) < 0.02f || dot(back, up) < -0.2f;
    mSun = steep ? normalized(right * -0.55f + screenUp * 0.6f + back * 0.75f)
                 : normalized(right * -0.75f + up * 1.05f + normalized(level) * 0.55f);
    mBehind = steep ? normalized(right * 0.8f - screenUp * 0.3f + back * 0.2f)
                    : normalized(right * 0.85f + up * 0.35f - normalized(level) * 0.75f);
    // An upright cube, turned as the camera is.
    const Vec3f x = steep ? right : normalized(cross(up, normalized(level))), y = cross(up, x);
    std::size_t n = 0, edge = kFirstEdge;
    for (const Index3& step : kAllNeighbours) {
        const int many = std::abs(step.x) + std::abs(step.y) + std::abs(step.z);
        const std::size_t place = many == 2 ? edge++ : n++;
        mDirections[place] = normalized(x * float(step.x) + y * float(step.y) + up * float(step.z));
        mColours[place] = skyColour(dot(mDirections[place], up));
    }
    const float reach = surface.reach();
    mWays = {std::max(1.5f, 0.02f * reach), std::max(4.f, 0.07f * reach), std::max(9.f, 0.2f * reach),
             std::max(18.f, 0.5f * reach)};
}

Vec3f Lighting::skyColour(float height) const {
    if (height < 0) return kHorizon * (1 + height) + kFloor * -height;
    return kHorizon * (1 - height) + kZenith * height;
}

float Lighting::sunAt(const Vec3f& place) const {
    const float end = 2.2f * mSurface->reach() + length(place - mSurface->middle());
    float passes = 1, way = 0.6f, before = 1e20f;
    for (int step = 0; step < 128 && way < end; ++step) {
        const float distance = mSurface->farDistance(place + mSun * way);
        // The nearest point between two steps, from where their balls meet.
        const float back = std::min(distance * distance / (2 * before), 0.85f * distance);
        const float aside = std::sqrt(std::max(0.f, distance * distance - back * back));
        passes = std::min(passes, kSharpness * aside / std::max(0.3f, way - back));
        if (passes < 0.004f) return 0;
        if (distance > 2.5f * mSurface->reach()) break;
        before = std::max(distance, 1e-3f);
        // Smaller steps where a part of the light is hidden.
        const bool partly = kSharpness * distance < 1.4f * way;
        way += std::max(0.4f + 0.006f * way, distance * (partly ? 0.4f : 0.8f));
    }
    return smooth(std::clamp(passes, 0.f, 1.f));
}

Lighting::Sky Lighting::skyAt(const Vec3f& place, const Vec3f& normal, std::size_t directions) const {
    Sky sky;
    float weights = 0;
    const Vec3f from = place + normal * 0.7f;
    // Nothing hides a cone nearer than this.
    const float free = mSurface->farDistance(from) / (1 + kCone);
    for (std::size_t i = 0; i < directions; ++i) {
        const float weight = dot(mDirections[i], normal) - 0.05f;
        if (weight <= 0) continue;
        float seen = 1;
        for (const float way : mWays) {
            if (way <= free) continue;
            const float distance = mSurface->farDistance(from + mDirections[i] * way);
            // Far parts hide less of it.
            seen = std::min(seen, 1 - (1 - distance / (way * kCone)) * (way == mWays[3] ? 0.75f : 1.f));
            if (seen <= 0) break;
        }
        seen = smooth(std::clamp(seen, 0.f, 1.f));
        weights += weight;
        sky.open += weight * seen;
        // What is hidden sends back a little of the light, in the model's warm colour.
        sky.light = sky.light + (mColours[i] * seen + Vec3f{0.13f, 0.115f, 0.10f} * (1 - seen)) * weight;
    }
    if (weights > 0) {
        sky.open /= weights;
        sky.light = sky.light * (1 / weights);
    }
    return sky;
}

Vec3f Lighting::shaded(const Vec3f& place, const Vec3f& normal, const Vec3f& towards, const Vec3f& albedo,
                       const Sky& sky) const {
    const float facing = dot(normal, mSun);
    const float key = facing > 0 ? facing * sunAt(place + normal * 0.9f) : 0;
    const float behind = std::max(0.f, dot(normal, mBehind)) * sky.open;
    const Vec3f diffuse = kKeyColour * key + sky.light * (0.3f + 0.36f * sky.open) + kBehindColour * behind;
    // A rough gloss: the distribution of Trowbridge and Reitz, Schlick's Fresnel.
    const Vec3f half = normalized(mSun + towards);
    const float nh = std::max(0.f, dot(normal, half)), nv = std::max(0.05f, dot(normal, towards));
    constexpr float kRough = 0.34f * 0.34f;
    const float lobe = nh * nh * (kRough - 1) + 1;
    const auto schlick = [](float cosine) {
        const float c = 1 - std::clamp(cosine, 0.f, 1.f), square = c * c;
        return 0.04f + 0.96f * square * square * c;
    };
    const float gloss =
        kRough / (3.14159265f * lobe * lobe) * schlick(dot(half, towards)) / (4 * std::max(0.25f, nv));
    const Vec3f mirrored = normal * (2 * dot(normal, towards)) - towards;
    const Vec3f reflected = skyColour(dot(mirrored, mUp)) * (0.5f * sky.open * schlick(nv));
    return scaled(albedo, diffuse) + kKeyColour * (gloss * key * 1.2f) + reflected;
}

Vec3f Lighting::onGround(const Vec3f& place) const {
    const Sky sky = skyAt(place, mUp, mDirections.size());
    const float facing = std::max(0.f, dot(mSun, mUp));
    const float key = facing * sunAt(place + mUp * 0.9f), open = 0.15f + 0.85f * sky.open;
    const Vec3f light = kKeyColour * (0.85f * key) + kZenith * (0.75f * open);
    const Vec3f full = kKeyColour * (0.85f * facing) + kZenith * 0.75f;
    return {light.x / full.x, light.y / full.y, light.z / full.z};
}

}  // namespace vdbsynth
