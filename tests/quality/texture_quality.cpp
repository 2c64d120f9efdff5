// How good textures over points are and how fast they are made, in numbers: a line a sample.
//   texture_quality TARGET SAMPLE... [--method NAME] [--seed N] [--speed] [--angles] [--crop N] ...
// TARGET: plane:SIDE, random:SIDE, sphere:POINTS, or a file of points or a mesh, whose vertices count.
// --angles measures how far charts are rotated from directions along z, --speed measures time only, --crop
// takes the sample's lower left N x N texels. tests/quality/textures.py runs it for the tables of
// docs/texturing.md.
#include "tests/quality/texture_measures.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/texture/histogram_blend.h"
#include "libvdbsynth/texture/point_hybrid.h"
#include "libvdbsynth/texture/point_matching.h"
#include "libvdbsynth/texture/point_parameterization.h"
#include "libvdbsynth/texture/surface_texture.h"
#include "tests/support/point_shapes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <string>
#include <vector>

using namespace vdbsynth;

namespace {

TextureTarget targetOf(const std::string& text) {
    TextureTarget target;
    const auto take = [&](test::PointShape shape) {
        target.point = std::move(shape.point);
        target.normal = std::move(shape.normal);
    };
    MeshFormat format;
    if (text.rfind("plane:", 0) == 0) {
        take(test::latticePlane(std::atoi(text.c_str() + 6)));
    } else if (text.rfind("random:", 0) == 0) {
        const double side = std::atof(text.c_str() + 7);
        take(test::randomPlane(std::size_t(side * side), side));
    } else if (text.rfind("sphere:", 0) == 0) {
        take(test::spiralSphere(std::size_t(std::atol(text.c_str() + 7)), 100));
    } else if (meshFormatOf(text, format) && format != MeshFormat::Ply) {
        const Mesh mesh = readMesh(text);
        target.point = mesh.points;
        target.normal.assign(mesh.points.size(), {0, 0, 0});
        for (const Triangle& t : triangulated(mesh)) {
            const Vec3f n =
                cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
            for (std::uint32_t corner : t) target.normal[corner] = target.normal[corner] + n;
        }
        for (Vec3f& n : target.normal) {
            n = normalized(n);
            if (!(dot(n, n) > 0)) n = {0, 0, 1};
        }
    } else {
        PointCloud cloud = readPoints(text).cloud;
        if (cloud.normals.empty()) estimateNormals(cloud);
        target.point = cloud.points;
        target.normal = cloud.normals;
    }
    return target;
}

struct Arguments {
    std::vector<std::string> samples;
    std::string method = "default";
    SurfaceTextureOptions options;
    int neighbours = 25, levels = 1, crop = 0;  // of the paper's methods, but `crop`
    bool coherent = false, speed = false, angles = false;
    std::uint64_t seed = 0;
};

struct Made {
    TexturedSites sites;
    double texel;
};

Made make(const Arguments& arguments, const TextureTarget& target, const SampleImage& sample,
          const RunContext& ctx) {
    const std::string& method = arguments.method;
    if (method == "parameterize") {
        PointParameterizationOptions own;
        own.neighbours = arguments.neighbours;
        if (arguments.speed)
            own.blend = SampleBlend::Weight;  // as published; Automatic measures the sample first
        PointParameterizationResult made = parameterizePoints(target, sample, own, ctx);
        return {std::move(made.sites), made.texel};
    }
    if (method == "match" || method == "match4") {
        PointMatchingOptions own;
        own.neighbours = arguments.neighbours;
        own.levels = method == "match4" ? 4 : arguments.levels;
        own.coherent = arguments.coherent;
        PointMatchingResult made = matchPoints(target, sample, own, ctx);
        return {std::move(made.sites), made.texel};
    }
    if (method == "hybrid") {
        PointHybridOptions own;
        own.parameterization.neighbours = arguments.neighbours;
        own.levels = arguments.levels;
        own.coherent = arguments.coherent;
        PointHybridResult made = texturePointsHybrid(target, sample, own, ctx);
        return {std::move(made.sites), made.texel};
    }
    SurfaceTextureResult made = textureSurface(target, {sample}, arguments.options, ctx);
    return {std::move(made.sites), made.texel};
}

SampleImage cropped(const SampleImage& image, int side) {
    if (side <= 0) return image;
    SampleImage part;
    part.width = std::min(side, image.width);
    part.height = std::min(side, image.height);
    part.channels = image.channels;
    for (int y = 0; y < part.height; ++y)
        part.values.insert(part.values.end(), image.texel(0, y),
                           image.texel(0, y) + part.width * part.channels);
    return part;
}

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Of all threads, which other work on the machine does not change much.
double processorNow() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

// False where a word is unknown.
bool readArguments(int argc, char** argv, Arguments& arguments) {
    CoordinateOptions& synthesis = arguments.options.synthesis;
    const std::map<std::string, std::function<void(double)>> numbers{
        {"--seed", [&](double v) { arguments.seed = std::uint64_t(v); }},
        {"--crop", [&](double v) { arguments.crop = int(v); }},
        {"--neighbours", [&](double v) { arguments.neighbours = int(v); }},
        {"--levels", [&](double v) { arguments.levels = synthesis.levels = int(v); }},
        {"--coherence", [&](double v) { synthesis.coherence = v; }},
        {"--passes", [&](double v) { synthesis.passes = int(v); }},
        {"--coarse-passes", [&](double v) { synthesis.coarsePasses = int(v); }},
        {"--similar", [&](double v) { synthesis.similar = int(v); }},
        {"--uniformity", [&](double v) { synthesis.uniformity = v; }},
        {"--histogram", [&](double v) { synthesis.histogram = v; }},
        {"--max-rotation", [&](double v) { synthesis.maxRotation = v; }},
        {"--blend",
         [&](double v) { arguments.options.blend = v > 0 ? SampleBlend::Histogram : SampleBlend::Off; }},
    };
    for (int i = 2; i < argc; ++i) {
        const std::string word = argv[i];
        const auto number = numbers.find(word);
        if (word == "--speed")
            arguments.speed = true;
        else if (word == "--angles")
            arguments.angles = true;
        else if (word == "--coherent")
            arguments.coherent = true;
        else if (word == "--method" && i + 1 < argc)
            arguments.method = argv[++i];
        else if (number != numbers.end() && i + 1 < argc)
            number->second(std::atof(argv[++i]));
        else if (word.rfind("--", 0) == 0)
            return false;
        else
            arguments.samples.push_back(word);
    }
    return !arguments.samples.empty();
}

constexpr double kPatchRadius = 16;  // [texels] half a window of 32
constexpr float kSteers = 0.82f;     // cosine of 35 degrees

// How far charts are rotated from directions along z. Left out are sites within kPatchRadius of a
// singularity, and where the direction is over 35 degrees off the surface, so that no field follows it
// (surface/direction_field.h).
void measureAngles(const std::string& path, const Arguments& arguments, TextureTarget target,
                   const RunContext& ctx) {
    const SampleImage sample = cropped(test::sampleOf(readRaster(path)), arguments.crop);
    target.direction.assign(target.point.size(), {0, 0, 1});
    const SurfaceTextureResult made = textureSurface(target, {sample}, arguments.options, ctx);
    const float far = float(kPatchRadius * made.texel);
    std::vector<double> angles;
    for (std::size_t i = 0; i < target.point.size(); ++i) {
        const Vec3f n = normalized(target.normal[i]), wanted = Vec3f{0, 0, 1} - n * n.z;
        bool counts = length(wanted) > kSteers;
        for (const Vec3f& s : made.singularities) counts = counts && length(s - target.point[i]) > far;
        if (!counts) continue;
        const double c = double(dot(made.sites.tangent[i], normalized(wanted)));
        angles.push_back(std::acos(std::clamp(c, -1.0, 1.0)) * 180 / kPi);
    }
    std::sort(angles.begin(), angles.end());
    const auto at = [&](double share) {
        return angles.empty() ? 0 : angles[std::size_t(share * double(angles.size() - 1))];
    };
    std::printf("%-28s %8.3f %8.2f %8.2f %8.2f\n", path.substr(path.rfind('/') + 1).c_str(),
                double(angles.size()) / double(target.point.size()), at(0.5), at(0.99), at(1));
}

void measure(const std::string& path, const Arguments& arguments, const TextureTarget& target,
             const RunContext& ctx) {
    const SampleImage sample = cropped(test::sampleOf(readRaster(path)), arguments.crop);
    const double begun = secondsNow(), processorBegun = processorNow();
    const Made result = make(arguments, target, sample, ctx);
    const double seconds = secondsNow() - begun, processor = processorNow() - processorBegun;
    std::printf("%-28s", path.substr(path.rfind('/') + 1).c_str());
    if (!arguments.speed) {
        const test::TextureNumbers n = test::textureNumbers(target, result.sites, sample, result.texel, ctx);
        std::printf(" %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f", n.histogram, n.steps, n.seams, n.patches, n.wide,
                    n.coherent);
    }
    const double points = double(target.point.size());
    std::printf(" %9.0f %9.0f\n", points / seconds, points / processor);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    if (argc < 3 || !readArguments(argc, argv, arguments)) {
        std::fprintf(
            stderr,
            "usage: texture_quality TARGET|loss SAMPLE... [--method "
            "default|parameterize|match|match4|hybrid] [--speed] [--angles] [--crop N] [--seed N] "
            "[--neighbours N] "
            "[--levels N] [--coherent] [--coherence X] [--passes N] [--coarse-passes N] [--similar N] "
            "[--uniformity X] [--histogram X] [--max-rotation DEGREES] [--blend 0|1]\n");
        return 2;
    }
    try {
        RunContext ctx;
        ctx.seed = arguments.seed;
        if (std::string(argv[1]) == "loss") {
            for (const std::string& path : arguments.samples)
                std::printf("%-28s %8.3f\n", path.substr(path.rfind('/') + 1).c_str(),
                            blendLoss(test::sampleOf(readRaster(path)), ctx));
            return 0;
        }
        const TextureTarget target = targetOf(argv[1]);
        if (arguments.angles) {
            std::printf("%-28s %8s %8s %8s %8s\n", "sample", "counted", "median", "99 %", "largest");
            for (const std::string& path : arguments.samples) measureAngles(path, arguments, target, ctx);
            return 0;
        }
        std::printf("%-28s", "sample");
        if (!arguments.speed)
            std::printf(" %8s %8s %8s %8s %8s %8s", "W1", "steps", "seams", "patches", "wide", "coherent");
        std::printf(" %9s %9s\n", "points/s", "by a core");
        for (const std::string& path : arguments.samples) measure(path, arguments, target, ctx);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
