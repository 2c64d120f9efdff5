#include "libvdbsynth/pipeline/texture/texture_bake.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/texture/texture_output_steps.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vdbsynth {
namespace {

const std::string kTileWord = "<UDIM>";
constexpr int kMostTiles = 100, kTilesAcross = 10, kFirstTile = 1001;
constexpr std::int32_t kNobody = -1;

using Tile = std::pair<int, int>;  // v, u

// A triangle on the picture and in the sample.
struct BakedTriangle {
    Vec2f uv[3];
    double area;  // twice, signed
};

struct Weights {
    float of[3];
    bool inside() const { return of[0] >= 0 && of[1] >= 0 && of[2] >= 0; }
};

double crossOf(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    return (double(b.x) - a.x) * (double(c.y) - a.y) - (double(b.y) - a.y) * (double(c.x) - a.x);
}

Weights weightsAt(const BakedTriangle& t, const Vec2f& p) {
    const double a = crossOf(t.uv[1], t.uv[2], p) / t.area, b = crossOf(t.uv[2], t.uv[0], p) / t.area;
    return {{float(a), float(b), float(1 - a - b)}};
}

// All that is baked from.
struct Bake {
    const TextureShape& shape;
    const TextureResult& result;
    const std::vector<SampleImage>& images;
    const SampleMap& map;
    std::vector<BakedTriangle> triangles;
    CornerCoordinates corners;
    int size;
};

std::vector<BakedTriangle> trianglesOf(const TextureShape& shape) {
    const std::vector<float>& uv = findAttribute(shape.attributes, "uv")->values;
    std::vector<BakedTriangle> triangles;
    for (const Triangle& t : shape.triangles) {
        BakedTriangle made{};
        for (std::size_t k = 0; k < 3; ++k) made.uv[k] = {uv[2 * t[k]], uv[2 * t[k] + 1]};
        made.area = crossOf(made.uv[0], made.uv[1], made.uv[2]);
        triangles.push_back(made);
    }
    return triangles;
}

struct UvBox {
    float left, low, right, high;
};

UvBox boxOf(const BakedTriangle& t) {
    const auto [left, right] = std::minmax({t.uv[0].x, t.uv[1].x, t.uv[2].x});
    const auto [low, high] = std::minmax({t.uv[0].y, t.uv[1].y, t.uv[2].y});
    return {left, low, right, high};
}

// The triangles of each tile; those outside of all tiles are counted.
std::map<Tile, std::vector<std::int32_t>> tilesOf(const std::vector<BakedTriangle>& triangles, bool several,
                                                  std::size_t& outside) {
    std::map<Tile, std::vector<std::int32_t>> tiles;
    constexpr float kEdge = 1e-5f;  // what ends at a border does not reach beyond it
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (triangles[t].area == 0) continue;
        const UvBox box = boxOf(triangles[t]);
        const int across = several ? kTilesAcross : 1, up = several ? kMostTiles : 1;
        if (box.left < -kEdge || box.low < -kEdge || box.right > float(across) + kEdge ||
            box.high > float(up) + kEdge)
            ++outside;
        const auto first = [](float low, int most) {
            return int(std::clamp(std::floor(low + kEdge), 0.f, float(most)));
        };
        const auto end = [](float high, int most) {
            return int(std::clamp(std::ceil(high - kEdge), 0.f, float(most)));
        };
        for (int v = first(box.low, up); v < end(box.high, up); ++v)
            for (int u = first(box.left, across); u < end(box.right, across); ++u)
                tiles[{v, u}].push_back(std::int32_t(t));
    }
    return tiles;
}

Vec2f pixelCentre(const Bake& bake, const Tile& tile, int x, int y) {
    return {float(tile.second) + (float(x) + 0.5f) / float(bake.size),
            float(tile.first) + (float(y) + 0.5f) / float(bake.size)};
}

// The triangle that each pixel lies in, the first of several; rows from the bottom.
std::vector<std::int32_t> ownersOf(const Bake& bake, const Tile& tile,
                                   const std::vector<std::int32_t>& triangles) {
    std::vector<std::int32_t> owners(std::size_t(bake.size) * std::size_t(bake.size), kNobody);
    for (std::int32_t t : triangles) {
        const BakedTriangle& triangle = bake.triangles[std::size_t(t)];
        const UvBox box = boxOf(triangle);
        const auto pixel = [&](float at, int from) {
            return int(
                std::clamp(std::floor((at - float(from)) * float(bake.size)), 0.f, float(bake.size - 1)));
        };
        for (int y = pixel(box.low, tile.first); y <= pixel(box.high, tile.first); ++y)
            for (int x = pixel(box.left, tile.second); x <= pixel(box.right, tile.second); ++x) {
                std::int32_t& owner = owners[std::size_t(y) * std::size_t(bake.size) + std::size_t(x)];
                if (owner == kNobody && weightsAt(triangle, pixelCentre(bake, tile, x, y)).inside())
                    owner = t;
            }
    }
    return owners;
}

// Pixels beside a chart continue it, by the triangle of the first neighbour that has one.
void pad(std::vector<std::int32_t>& owners, int size) {
    const int steps[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    for (int round = 0; round < kBakePadding; ++round) {
        const std::vector<std::int32_t> before = owners;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                std::int32_t& owner = owners[std::size_t(y) * std::size_t(size) + std::size_t(x)];
                for (int k = 0; k < 8 && owner == kNobody; ++k) {
                    const int i = x + steps[k][0], j = y + steps[k][1];
                    if (i >= 0 && j >= 0 && i < size && j < size)
                        owner = before[std::size_t(j) * std::size_t(size) + std::size_t(i)];
                }
            }
    }
}

// A normal along the sample's axes as one along those of the target's coordinates. @param n  0..1 each
void turnNormal(const BakedTriangle& t, const Vec2f* at, float* n) {
    // The sample's direction of the target's u: d(at)/du of the affine map between both triangles.
    const Vec2f e1 = t.uv[1] - t.uv[0], e2 = t.uv[2] - t.uv[0], s1 = at[1] - at[0], s2 = at[2] - at[0];
    const Vec2f u = (s1 * e2.y - s2 * e1.y) * float(1 / t.area),
                v = (s2 * e1.x - s1 * e2.x) * float(1 / t.area);
    const float size = length(u);
    if (!(size > 0)) return;
    const Vec2f along = u * (1 / size);
    const float side = u.x * v.y - u.y * v.x < 0 ? -1.f : 1.f;
    const Vec2f across{-along.y * side, along.x * side}, tilt{2 * n[0] - 1, 2 * n[1] - 1};
    n[0] = 0.5f * (dot(tilt, along) + 1);
    n[1] = 0.5f * (dot(tilt, across) + 1);
}

// The value of one pixel. @param values  room for all channels
void readPixel(const Bake& bake, std::int32_t owner, const Vec2f& place, std::vector<float>& values) {
    const BakedTriangle& triangle = bake.triangles[std::size_t(owner)];
    const Triangle& t = bake.shape.triangles[std::size_t(owner)];
    const Vec2f* at = &bake.corners.coordinate[3 * std::size_t(owner)];
    const std::int32_t sample = bake.corners.sample[std::size_t(owner)];
    const Weights w = weightsAt(triangle, place);
    const std::size_t channels = values.size();
    bool mixed = sample < 0;
    for (std::uint32_t v : t) mixed = mixed || bake.result.sites.blended[bake.shape.siteOf[v]];
    if (mixed) {
        std::fill(values.begin(), values.end(), 0.f);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < channels; ++c)
                values[c] += std::clamp(w.of[k], 0.f, 1.f) *
                             bake.result.sites.values[bake.shape.siteOf[t[k]] * channels + c];
        return;
    }
    readCubic(bake.images[std::size_t(sample)], at[0] * w.of[0] + at[1] * w.of[1] + at[2] * w.of[2],
              values.data());
    if (bake.map.name == "normal" && bake.map.channels == 3)
        turnNormal(triangle, at, values.data() + bake.map.first);
}

// [size x size x channels of the map], rows from the top.
std::vector<float> pixelsOf(const Bake& bake, const Tile& tile, const std::vector<std::int32_t>& owners,
                            const RunContext& ctx) {
    const std::size_t size = std::size_t(bake.size), width = std::size_t(bake.map.channels);
    std::vector<float> pixels(size * size * width, 0.f);
    parallelFor(ctx, size, 16, [&](std::size_t begin, std::size_t end) {
        std::vector<float> values(std::size_t(bake.images.front().channels));
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < size; ++x) {
                if (owners[y * size + x] == kNobody) continue;
                readPixel(bake, owners[y * size + x], pixelCentre(bake, tile, int(x), int(y)), values);
                std::copy_n(&values[std::size_t(bake.map.first)], width,
                            &pixels[((size - 1 - y) * size + x) * width]);
            }
    });
    return pixels;
}

std::string tilePath(std::string path, const Tile& tile) {
    const std::size_t at = path.find(kTileWord);
    if (at == std::string::npos) return path;
    return path.replace(at, kTileWord.size(),
                        std::to_string(kFirstTile + tile.second + kTilesAcross * tile.first));
}

void noteBake(const Bake& bake, const std::string& path, std::size_t tiles, std::size_t outside,
              const RunContext& ctx) {
    if (outside > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + std::to_string(outside) +
                    " triangles reach beyond the picture; <UDIM> in its name writes one for each tile");
    message(ctx, MessageLevel::Note,
            path + ": holds the map " + bake.map.name +
                (tiles > 1 ? " in " + std::to_string(tiles) + " tiles" : ""));
}

}  // namespace

const SampleMap& bakedMap(const std::string& path, const TextureSample& sample) {
    std::string stem = fileNameOf(path);
    stem.erase(std::min(stem.rfind('.'), stem.size()));
    const std::size_t word = stem.find(kTileWord);
    if (word != std::string::npos) stem.erase(word);
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
    const Bake bake{shape,
                    result,
                    images,
                    bakedMap(path, samples.front()),
                    trianglesOf(shape),
                    cornersOf(shape, result, images, ctx),
                    size};
    std::size_t outside = 0;
    const auto tiles = tilesOf(bake.triangles, path.find(kTileWord) != std::string::npos, outside);
    if (tiles.empty())
        throw Error(ErrorCode::Unusable, shape.name + ": no face has texture coordinates inside the picture");
    if (tiles.size() > std::size_t(kMostTiles))
        throw Error(ErrorCode::Unusable, shape.name + ": its texture coordinates span " +
                                             std::to_string(tiles.size()) +
                                             " tiles; at most 100 are written");
    requireMemory(ctx, double(size) * size * (12 + 4.0 * bake.map.channels) * 2, path, "lower `bakeSize`");
    noteBake(bake, path, tiles.size(), outside, ctx);
    for (const auto& [tile, triangles] : tiles) {
        throwIfCancelled(ctx);
        std::vector<std::int32_t> owners = ownersOf(bake, tile, triangles);
        pad(owners, size);
        const std::vector<float> pixels = pixelsOf(bake, tile, owners, ctx);
        const std::string temporary = outputs.add(tilePath(path, tile));
        if (extensionOf(path) == "exr")
            writeImageExr(temporary, size, size, bake.map.channels, pixels);
        else
            writeImagePng(temporary, size, size, bake.map.channels, bits, pixels);
    }
}

}  // namespace vdbsynth
