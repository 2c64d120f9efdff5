#include "libvdbsynth/pipeline/texture/texture_sample.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace vdbsynth {
namespace {

// Attributes that texturing writes itself, and those with a meaning of their own.
const std::set<std::string> kTakenNames{"Cd",
                                        "Alpha",
                                        "uv",
                                        "N",
                                        "P",
                                        "x",
                                        "y",
                                        "z",
                                        "nx",
                                        "ny",
                                        "nz",
                                        "red",
                                        "s",
                                        "t",
                                        "green",
                                        "blue",
                                        "source_u",
                                        "source_v",
                                        "source_exemplar",
                                        "source_tangent",
                                        "source_blended",
                                        "surface",
                                        ""};

Raster readImage(const std::string& path, const RunContext& ctx) {
    Raster raster = readRaster(path, {}, ctx);
    const auto sides = [&] { return std::to_string(raster.size.x) + " x " + std::to_string(raster.size.y); };
    if (raster.size.z > 1)
        throw Error(ErrorCode::Unusable,
                    path + ": holds " + std::to_string(raster.size.z) + " slices; a sample is one image");
    if (std::min(raster.size.x, raster.size.y) < kSmallestSample)
        throw Error(ErrorCode::Unusable, path + ": has " + sides() + " pixels; a sample has at least " +
                                             std::to_string(kSmallestSample) + " a side");
    const RasterRange range = rangeOf(raster);
    if (range.infinite > 0) throw Error(ErrorCode::BadData, path + ": holds infinite values");
    if (range.missing > 0)
        throw Error(ErrorCode::Unusable,
                    path + ": " + std::to_string(range.missing / std::size_t(raster.channels)) + " of its " +
                        sides() + " pixels have no data (alpha 0 or NaN); crop them off or paint them");
    return raster;
}

// The lowest row first, values of integer formats from 0 to 1; `wanted` channels of one repeat it.
void copyInto(const Raster& raster, SampleImage& image, int first, int wanted) {
    const float white = raster.white > 0 ? float(raster.white) : 1;
    for (int y = 0; y < image.height; ++y) {
        const int row = raster.rowsFromTop ? image.height - 1 - y : y;
        for (int x = 0; x < image.width; ++x) {
            const float* from = &raster.values[raster.index(x, row, 0) * std::size_t(raster.channels)];
            float* to = &image.values[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) *
                                      std::size_t(image.channels)];
            for (int c = 0; c < wanted; ++c) to[first + c] = from[raster.channels == 1 ? 0 : c] / white;
        }
    }
}

TextureSample readOne(const SampleFiles& files, const RunContext& ctx) {
    std::vector<Raster> rasters{readImage(files.colour, ctx)};
    TextureSample sample;
    sample.name = fileNameOf(files.colour);
    sample.maps.push_back({"Cd", 0, 3, rasters[0].white});
    for (const auto& [name, path] : files.maps) {
        rasters.push_back(readImage(path, ctx));
        const Raster& map = rasters.back();
        if (map.size.x != rasters[0].size.x || map.size.y != rasters[0].size.y)
            throw Error(ErrorCode::ShapeMismatch,
                        path + ": has " + std::to_string(map.size.x) + " x " + std::to_string(map.size.y) +
                            " pixels; the map " + name + " of " + files.colour + " must have its " +
                            std::to_string(rasters[0].size.x) + " x " + std::to_string(rasters[0].size.y));
        const SampleMap& last = sample.maps.back();
        sample.maps.push_back({name, last.first + last.channels, map.channels, map.white});
    }
    SampleImage& image = sample.image;
    image.width = rasters[0].size.x;
    image.height = rasters[0].size.y;
    image.channels = sample.maps.back().first + sample.maps.back().channels;
    requireMemory(ctx, double(image.texels()) * double(image.channels) * 12, files.colour, "shrink it first");
    image.values.resize(image.texels() * std::size_t(image.channels));
    for (std::size_t m = 0; m < rasters.size(); ++m)
        copyInto(rasters[m], image, sample.maps[m].first, sample.maps[m].channels);
    return sample;
}

void decideTiling(TextureSample& sample, Tiling tiling, const RunContext& ctx) {
    const double mismatch = borderMismatch(sample.image);
    sample.image.tileable =
        tiling == Tiling::Yes || (tiling == Tiling::Auto && mismatch <= kTileableMismatch);
    message(ctx, MessageLevel::Detail,
            sample.name + ": its opposite borders differ " + roundedText(mismatch, 3) +
                " times as much as most neighbouring rows; it is used as " +
                (sample.image.tileable ? "tileable" : "not tileable"));
}

// Mean squared difference between two columns (or rows).
double difference(const SampleImage& image, bool columns, int a, int b) {
    const int count = columns ? image.height : image.width;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const float* p = columns ? image.texel(a, i) : image.texel(i, a);
        const float* q = columns ? image.texel(b, i) : image.texel(i, b);
        for (int c = 0; c < image.channels; ++c) sum += double(p[c] - q[c]) * double(p[c] - q[c]);
    }
    return sum / count;
}

double mismatchAcross(const SampleImage& image, bool columns) {
    const int count = columns ? image.width : image.height;
    std::vector<double> inside;
    for (int i = 0; i + 1 < count; ++i) inside.push_back(difference(image, columns, i, i + 1));
    const double border = difference(image, columns, 0, count - 1);
    if (border == 0 || inside.empty()) return 0;
    const auto high = inside.begin() + std::ptrdiff_t((inside.size() - 1) * 9 / 10);
    std::nth_element(inside.begin(), high, inside.end());
    return *high > 0 ? border / *high : std::numeric_limits<double>::infinity();
}

}  // namespace

double borderMismatch(const SampleImage& image) {
    return std::max(mismatchAcross(image, true), mismatchAcross(image, false));
}

void requireMapNames(const std::vector<SampleFiles>& files) {
    for (const SampleFiles& sample : files) {
        std::set<std::string> names = kTakenNames;
        for (const auto& [name, path] : sample.maps)
            if (!names.insert(name).second)
                throw Error(ErrorCode::InvalidOption,
                            "`channel` " + name + "=" + path + ": the name is " +
                                (kTakenNames.count(name) ? "taken by texturing itself" : "given twice") +
                                "; choose another");
    }
}

std::vector<TextureSample> readTextureSamples(const std::vector<SampleFiles>& files, Tiling tiling,
                                              const RunContext& ctx) {
    requireMapNames(files);
    std::vector<TextureSample> samples;
    for (const SampleFiles& of : files) {
        samples.push_back(readOne(of, ctx));
        decideTiling(samples.back(), tiling, ctx);
        const auto &maps = samples.back().maps, &wanted = samples.front().maps;
        const bool same = std::equal(maps.begin(), maps.end(), wanted.begin(), wanted.end(),
                                     [](const SampleMap& a, const SampleMap& b) {
                                         return a.name == b.name && a.channels == b.channels;
                                     });
        if (!same)
            throw Error(ErrorCode::ShapeMismatch,
                        of.colour + ": all samples must have the same maps in the same order as " +
                            files.front().colour + ", each with as many channels");
    }
    return samples;
}

}  // namespace vdbsynth
