#include "libvdbsynth/pipeline/texture/uv_bake.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/math/vec2.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace vdbsynth {
namespace {

const std::string kTileWord = "<UDIM>";
constexpr int kMostTiles = 100, kTilesAcross = 10, kFirstTile = 1001;
constexpr std::int32_t kNobody = -1;

using Tile = std::pair<int, int>;  // v, u

// A triangle on the picture.
struct BakedTriangle {
    Vec2f uv[3];
    double area;  // twice, signed
};

double crossOf(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    return (double(b.x) - a.x) * (double(c.y) - a.y) - (double(b.y) - a.y) * (double(c.x) - a.x);
}

BakeWeights weightsAt(const BakedTriangle& t, const Vec2f& p) {
    const double a = crossOf(t.uv[1], t.uv[2], p) / t.area, b = crossOf(t.uv[2], t.uv[0], p) / t.area;
    return {float(a), float(b), float(1 - a - b)};
}

bool inside(const BakeWeights& w) {
    return w[0] >= 0 && w[1] >= 0 && w[2] >= 0;
}

std::vector<BakedTriangle> trianglesOf(const UvSurface& surface) {
    std::vector<BakedTriangle> triangles;
    for (const Triangle& t : surface.triangles) {
        BakedTriangle made{};
        for (std::size_t k = 0; k < 3; ++k) made.uv[k] = {surface.uv[2 * t[k]], surface.uv[2 * t[k] + 1]};
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

Vec2f pixelCentre(int size, const Tile& tile, int x, int y) {
    return {float(tile.second) + (float(x) + 0.5f) / float(size),
            float(tile.first) + (float(y) + 0.5f) / float(size)};
}

// The triangle that each pixel lies in, the first of several; rows from the bottom.
std::vector<std::int32_t> ownersOf(const std::vector<BakedTriangle>& all, int size, const Tile& tile,
                                   const std::vector<std::int32_t>& triangles) {
    std::vector<std::int32_t> owners(std::size_t(size) * std::size_t(size), kNobody);
    for (std::int32_t t : triangles) {
        const BakedTriangle& triangle = all[std::size_t(t)];
        const UvBox box = boxOf(triangle);
        const auto pixel = [&](float at, int from) {
            return int(std::clamp(std::floor((at - float(from)) * float(size)), 0.f, float(size - 1)));
        };
        for (int y = pixel(box.low, tile.first); y <= pixel(box.high, tile.first); ++y)
            for (int x = pixel(box.left, tile.second); x <= pixel(box.right, tile.second); ++x) {
                std::int32_t& owner = owners[std::size_t(y) * std::size_t(size) + std::size_t(x)];
                if (owner == kNobody && inside(weightsAt(triangle, pixelCentre(size, tile, x, y)))) owner = t;
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

// [size x size x channels], rows from the top.
std::vector<float> pixelsOf(const std::vector<BakedTriangle>& all, int side, const Tile& tile, int channels,
                            const std::vector<std::int32_t>& owners, const BakedPixel& pixel,
                            const RunContext& ctx) {
    const std::size_t size = std::size_t(side), width = std::size_t(channels);
    std::vector<float> pixels(size * size * width, 0.f);
    parallelFor(ctx, size, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < size; ++x) {
                const std::int32_t owner = owners[y * size + x];
                if (owner == kNobody) continue;
                const Vec2f place = pixelCentre(side, tile, int(x), int(y));
                pixel(std::size_t(owner), weightsAt(all[std::size_t(owner)], place),
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

}  // namespace

std::string withoutTile(const std::string& stem) {
    const std::size_t word = stem.find(kTileWord);
    return word == std::string::npos ? stem : stem.substr(0, word);
}

std::size_t bakeOntoUv(const UvSurface& surface, const std::string& path, const BakePicture& picture,
                       const BakedPixel& pixel, OutputSet& outputs, const RunContext& ctx) {
    const std::vector<BakedTriangle> all = trianglesOf(surface);
    std::size_t outside = 0;
    const auto tiles = tilesOf(all, path.find(kTileWord) != std::string::npos, outside);
    if (tiles.empty())
        throw Error(ErrorCode::Unusable,
                    surface.name + ": no face has texture coordinates inside the picture");
    if (tiles.size() > std::size_t(kMostTiles))
        throw Error(ErrorCode::Unusable, surface.name + ": its texture coordinates span " +
                                             std::to_string(tiles.size()) +
                                             " tiles; at most 100 are written");
    const int size = picture.size;
    requireMemory(ctx, double(size) * size * (12 + 4.0 * picture.channels) * 2, path, "lower `bakeSize`");
    if (outside > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + std::to_string(outside) +
                    " triangles reach beyond the picture; <UDIM> in its name writes one for each tile");
    for (const auto& [tile, triangles] : tiles) {
        throwIfCancelled(ctx);
        std::vector<std::int32_t> owners = ownersOf(all, size, tile, triangles);
        pad(owners, size);
        const std::vector<float> pixels = pixelsOf(all, size, tile, picture.channels, owners, pixel, ctx);
        const std::string temporary = outputs.add(tilePath(path, tile));
        if (extensionOf(path) == "exr")
            writeImageExr(temporary, size, size, picture.channels, pixels);
        else
            writeImagePng(temporary, size, size, picture.channels, picture.bits, pixels);
    }
    return tiles.size();
}

}  // namespace vdbsynth
