#include "libvdbsynth/pipeline/texture/texture_bake.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/texture/texture_output_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// All that is baked from.
struct Bake {
    const TextureShape& shape;
    const TextureResult& result;
    const std::vector<SampleImage>& images;
    const SampleMap& map;
    const std::vector<float>& uv;
    CornerCoordinates corners;
};

// A normal along the sample's axes as one along those of the target's coordinates. @param n  0..1 each
void rotateNormal(const Vec2f* uv, const Vec2f* at, float* n) {
    // The sample's direction of the target's u: d(at)/du of the affine map between both triangles.
    const Vec2f e1 = uv[1] - uv[0], e2 = uv[2] - uv[0], s1 = at[1] - at[0], s2 = at[2] - at[0];
    const float area = e1.x * e2.y - e1.y * e2.x;
    const Vec2f u = (s1 * e2.y - s2 * e1.y) * (1 / area), v = (s2 * e1.x - s1 * e2.x) * (1 / area);
    const float size = length(u);
    if (!(size > 0)) return;
    const Vec2f along = u * (1 / size);
    const float side = u.x * v.y - u.y * v.x < 0 ? -1.f : 1.f;
    const Vec2f across{-along.y * side, along.x * side}, tilt{2 * n[0] - 1, 2 * n[1] - 1};
    n[0] = 0.5f * (dot(tilt, along) + 1);
    n[1] = 0.5f * (dot(tilt, across) + 1);
}

std::array<Vec2f, 3> uvOf(const Bake& bake, const Triangle& t) {
    std::array<Vec2f, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) uv[k] = {bake.uv[2 * t[k]], bake.uv[2 * t[k] + 1]};
    return uv;
}

// The value of one pixel. @param values  room for all channels
void readPixel(const Bake& bake, std::size_t owner, const BakeWeights& w, std::vector<float>& values) {
    const Triangle& t = bake.shape.triangles[owner];
    const Vec2f* at = &bake.corners.coordinate[3 * owner];
    const std::int32_t sample = bake.corners.sample[owner];
    const std::size_t channels = values.size();
    bool mixed = sample < 0;
    for (std::uint32_t v : t) mixed = mixed || bake.result.sites.blended[bake.shape.siteOf[v]];
    if (mixed) {
        std::fill(values.begin(), values.end(), 0.f);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < channels; ++c)
                values[c] += std::clamp(w[k], 0.f, 1.f) *
                             bake.result.sites.values[bake.shape.siteOf[t[k]] * channels + c];
        return;
    }
    readCubic(bake.images[std::size_t(sample)], at[0] * w[0] + at[1] * w[1] + at[2] * w[2], values.data());
    if (bake.map.name == "normal" && bake.map.channels == 3)
        rotateNormal(uvOf(bake, t).data(), at, values.data() + bake.map.first);
}

}  // namespace

const SampleMap& bakedMap(const std::string& path, const TextureSample& sample) {
    std::string stem = fileNameOf(path);
    stem.erase(std::min(stem.rfind('.'), stem.size()));
    stem = withoutTile(stem);
    while (!stem.empty() && (stem.back() == '.' || stem.back() == '_' || stem.back() == '-')) stem.pop_back();
    const SampleMap* found = &sample.maps.front();
    for (const SampleMap& map : sample.maps)
        if (&map != found && stem.size() >= map.name.size() &&
            stem.compare(stem.size() - map.name.size(), map.name.size(), map.name) == 0)
            return map;
    return *found;
}

void bakeTexture(const TextureShape& shape, const TextureResult& result,
                 const std::vector<TextureSample>& samples, const std::string& path, int size, int bits,
                 OutputSet& outputs, const RunContext& ctx) {
    const Attribute* uv = findAttribute(shape.attributes, "uv");
    if (!uv || uv->width != 2 || shape.triangles.empty())
        throw Error(ErrorCode::Unusable, shape.name + ": has no texture coordinates to bake onto");
    const std::vector<SampleImage> images = imagesOf(samples);
    const Bake bake{shape,      result,
                    images,     bakedMap(path, samples.front()),
                    uv->values, cornersOf(shape, result, images, ctx)};
    const std::size_t tiles = bakeOntoUv(
        {shape.name, shape.triangles, uv->values}, path, {size, bits, bake.map.channels},
        [&](std::size_t triangle, const BakeWeights& weights, float* out) {
            std::vector<float> values(std::size_t(images.front().channels));
            readPixel(bake, triangle, weights, values);
            std::copy_n(&values[std::size_t(bake.map.first)], bake.map.channels, out);
        },
        outputs, ctx);
    message(ctx, MessageLevel::Note,
            path + ": holds the map " + bake.map.name +
                (tiles > 1 ? " in " + std::to_string(tiles) + " tiles" : ""));
}

}  // namespace vdbsynth
