#include "libvdbsynth/pipeline/texture/texture_repeat.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/textured_mesh.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vdbsynth {
namespace {

// `vdbsynth:sample WIDTH HEIGHT tile|mirror NAME` for each sample, `vdbsynth:map NAME` for each further map,
// `vdbsynth:texel LENGTH` and `vdbsynth:reading smooth|nearest`.
const std::string kSampleKey = "vdbsynth:sample ", kMapKey = "vdbsynth:map ", kTexelKey = "vdbsynth:texel ",
                  kReadingKey = "vdbsynth:reading ";

const char* const kColumns[] = {"source_u", "source_v", "source_exemplar", "source_tangent"};
const char* const kBlended = "source_blended";
constexpr int kLargest = 1 << 24;  // [texels] side of a sample

// The next word of a line, cut off it.
std::string cutWord(std::string& line) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string word = line.substr(0, end);
    line.erase(0, std::min(end + 1, line.size()));
    return word;
}

void readComments(const std::string& path, TextureMap& map) {
    for (std::string line : plyComments(path)) {
        bool good = true;
        if (line.compare(0, kTexelKey.size(), kTexelKey) == 0) {
            good = parseReal(line.substr(kTexelKey.size()), map.result.texel) && map.result.texel > 0;
        } else if (line.compare(0, kReadingKey.size(), kReadingKey) == 0) {
            map.result.smooth = line.substr(kReadingKey.size()) != "nearest";
        } else if (line.compare(0, kSampleKey.size(), kSampleKey) == 0) {
            line.erase(0, kSampleKey.size());
            RememberedSample sample;
            good = parseWhole(cutWord(line), sample.width) && parseWhole(cutWord(line), sample.height) &&
                   sample.width > 0 && sample.height > 0 && sample.width <= kLargest &&
                   sample.height <= kLargest;
            sample.tileable = cutWord(line) == "tile";
            sample.name = line;
            map.samples.push_back(sample);
        } else if (line.compare(0, kMapKey.size(), kMapKey) == 0) {
            map.maps.push_back(line.substr(kMapKey.size()));
        }
        if (!good) throw Error(ErrorCode::BadData, path + ": its comment \"" + line + "\" is damaged");
    }
    if (map.samples.empty())
        throw Error(ErrorCode::BadData,
                    path + ": does not say which samples it was textured with (comments vdbsynth:sample)");
}

const Attribute& column(const std::string& path, const Attributes& attributes, const std::string& name) {
    const Attribute* found = findAttribute(attributes, name);
    if (!found || found->width != (name == "source_tangent" ? 3u : 1u))
        throw Error(ErrorCode::BadData, path + ": has no " + name + ", so it is not what texture wrote");
    return *found;
}

// As it was written, so that the same sample gives the same bits; mended if another program changed it.
Vec3f tangentOf(const Vec3f& normal, const float* values) {
    constexpr float kClose = 1e-3f;
    const Vec3f tangent{values[0], values[1], values[2]};
    const bool sound = std::abs(length(tangent) - 1) < kClose && std::abs(dot(normal, tangent)) < kClose;
    return sound ? tangent : tangentNear(normal, tangent);
}

void readCoordinates(const std::string& path, TextureMap& map) {
    const Attributes& all = map.shape.attributes;
    const Attribute &u = column(path, all, kColumns[0]), &v = column(path, all, kColumns[1]),
                    &exemplar = column(path, all, kColumns[2]), &tangent = column(path, all, kColumns[3]);
    TexturedSites& sites = map.result.sites;
    const std::size_t count = map.shape.site.size();
    sites.sample.assign(count, TexturedSites::kNone);
    sites.coordinate.resize(count);
    sites.tangent.resize(count);
    sites.blended.assign(count, 0);
    for (std::size_t e = map.shape.points.size(); e-- > 0;) {
        const std::size_t site = map.shape.siteOf[e];
        const float number = exemplar.values[e];
        if (!(number >= -1 && number < float(map.samples.size()) && number == std::floor(number)))
            throw Error(ErrorCode::BadData, path + ": a source_exemplar of " +
                                                roundedText(double(number), 6) + "; it has " +
                                                std::to_string(map.samples.size()) + " samples");
        constexpr float kFarthest = 1e7f;  // [texels] so that they fit whole numbers
        if (!(std::abs(u.values[e]) < kFarthest && std::abs(v.values[e]) < kFarthest))
            throw Error(ErrorCode::BadData, path + ": a source_u or source_v beyond 10 million pixels");
        sites.sample[site] = std::int32_t(number);
        sites.coordinate[site] = {u.values[e], v.values[e]};
        sites.tangent[site] = tangentOf(map.shape.normal[site], &tangent.values[3 * e]);
    }
}

void noteBlended(const TextureMap& map, const RunContext& ctx) {
    const Attribute* blended = findAttribute(map.shape.attributes, kBlended);
    if (!blended || blended->width != 1) return;
    const auto count =
        std::count_if(blended->values.begin(), blended->values.end(), [](float v) { return v != 0; });
    if (count > 0)
        message(ctx, MessageLevel::Note,
                map.shape.name + ": " + std::to_string(count) +
                    " of its points were blends of several places; each takes the strongest one");
}

void noteLostMaps(const TextureMap& map, const TextureSample& sample, const RunContext& ctx) {
    for (const std::string& name : map.maps)
        if (std::none_of(sample.maps.begin(), sample.maps.end(),
                         [&](const SampleMap& given) { return given.name == name; }))
            message(ctx, MessageLevel::Note,
                    map.shape.name + ": its map " + name + " is left out; `channel` gives it again");
}

// Coordinates times the ratio of each sample's size, and the values there, read as texture reads them.
void readAgain(TextureResult& result, const std::vector<TextureSample>& samples,
               const std::vector<Vec2f>& ratio, const RunContext& ctx) {
    TexturedSites& sites = result.sites;
    const std::size_t channels = std::size_t(samples[0].image.channels), count = sites.sample.size();
    sites.values.assign(count * channels, 0);
    parallelFor(ctx, count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (sites.sample[i] < 0) continue;
            const std::size_t s = std::size_t(sites.sample[i]);
            Vec2f& at = sites.coordinate[i];
            at = {at.x * ratio[s].x, at.y * ratio[s].y};
            if (result.smooth)
                readCubic(samples[s].image, at, &sites.values[i * channels]);
            else
                std::copy_n(nearestTexel(samples[s].image, at), channels, &sites.values[i * channels]);
        }
    });
}

}  // namespace

bool isTextureMap(const std::string& path) {
    if (readExtensionOf(path) != "ply") return false;
    const std::vector<std::string> comments = plyComments(path);
    return std::any_of(comments.begin(), comments.end(), [](const std::string& line) {
        return line.compare(0, kSampleKey.size(), kSampleKey) == 0;
    });
}

std::vector<std::string> sampleComments(const TextureResult& result,
                                        const std::vector<TextureSample>& samples) {
    std::vector<std::string> lines{kTexelKey + exactText(result.texel),
                                   kReadingKey + (result.smooth ? "smooth" : "nearest")};
    for (const TextureSample& sample : samples)
        lines.push_back(kSampleKey + std::to_string(sample.image.width) + ' ' +
                        std::to_string(sample.image.height) +
                        (sample.image.tileable ? " tile " : " mirror ") + sample.name);
    for (std::size_t m = 1; m < samples.front().maps.size(); ++m)
        lines.push_back(kMapKey + samples.front().maps[m].name);
    return lines;
}

TextureMap readTextureMap(const std::string& path, const RunContext& ctx) {
    TextureMap map;
    readComments(path, map);
    const bool points = holdsPoints(path);
    map.shape = loadTarget(path, points ? TargetKind::Points : TargetKind::Mesh, {}, ctx);
    readCoordinates(path, map);
    noteBlended(map, ctx);
    // What the samples give anew.
    std::vector<std::string> gone = map.maps;
    gone.insert(gone.end(), std::begin(kColumns), std::end(kColumns));
    gone.push_back(kBlended);
    Attributes& attributes = map.shape.attributes;
    attributes.erase(std::remove_if(attributes.begin(), attributes.end(),
                                    [&](const Attribute& a) {
                                        return std::find(gone.begin(), gone.end(), a.name) != gone.end();
                                    }),
                     attributes.end());
    return map;
}

void repeatTexture(TextureMap& map, std::vector<TextureSample>& samples, const RunContext& ctx) {
    if (samples.size() != map.samples.size())
        throw Error(ErrorCode::ShapeMismatch, map.shape.name + ": was textured with " +
                                                  std::to_string(map.samples.size()) + " samples; " +
                                                  std::to_string(samples.size()) + " are given after it");
    noteLostMaps(map, samples.front(), ctx);
    std::vector<Vec2f> ratio;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        SampleImage& image = samples[s].image;
        const RememberedSample& old = map.samples[s];
        image.tileable = old.tileable;
        ratio.push_back({float(image.width) / float(old.width), float(image.height) / float(old.height)});
        if (image.width == old.width && image.height == old.height) continue;
        message(ctx, MessageLevel::Note,
                samples[s].name + ": has " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " pixels and " + old.name + " had " +
                    std::to_string(old.width) + " x " + std::to_string(old.height) +
                    "; coordinates are scaled by " + roundedText(double(ratio[s].x), 4) + " and " +
                    roundedText(double(ratio[s].y), 4));
    }
    map.result.texel /= double(std::sqrt(ratio[0].x * ratio[0].y));
    readAgain(map.result, samples, ratio, ctx);
}

}  // namespace vdbsynth
