#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/io/output_set.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace vdbsynth {

/// [pixels] by which a baked picture extends beyond its charts.
inline constexpr int kBakePadding = 8;

/// A mesh with texture coordinates. All are borrowed.
struct UvSurface {
    std::string name;  ///< for messages
    const std::vector<Triangle>& triangles;
    const std::vector<float>& uv;  ///< [vertices x 2]
};

struct BakePicture {
    int size = 1024;  ///< [pixels] side
    int bits = 8;     ///< of .png: 8 or 16; .exr holds floats
    int channels = 1;
};

/// Of a triangle's corners; their sum is 1. Beyond its edges, in the padding, some are below 0.
using BakeWeights = std::array<float, 3>;
/// Writes the channels of a pixel [0..1 for .png]. Called from many threads.
using BakedPixel = std::function<void(std::size_t triangle, const BakeWeights& weights, float* out)>;

/// Bakes a picture onto a mesh's texture coordinates: every pixel inside a triangle, the first of several, is
/// read there; charts are padded by kBakePadding pixels, the rest is 0. Where <UDIM> is in the path, a
/// picture for each tile that a triangle reaches, 1001 + u + 10 v; else what lies beyond 0..1 is left out
/// with a warning.
/// @return number of pictures
/// @throw Error Unusable (no face inside, more than 100 tiles), Memory, Io, Cancelled
/// @par Repeats same bits for any number of threads
std::size_t bakeOntoUv(const UvSurface& surface, const std::string& path, const BakePicture& picture,
                       const BakedPixel& pixel, OutputSet& outputs, const RunContext& ctx = {});

/// A file's name before <UDIM>.
std::string withoutTile(const std::string& stem);

}  // namespace vdbsynth
