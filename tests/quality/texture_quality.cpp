// How good textures over points are, in numbers: one line a texture and method, as docs/texturing.md shows
// them.
//   texture_quality TARGET SAMPLE... [--method NAME] [--seed N]
// TARGET: plane:SIDE, sphere:POINTS, or a file of points or a mesh, whose vertices count.
#include "tests/quality/texture_measures.h"

#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/texture/point_hybrid.h"
#include "libvdbsynth/texture/point_matching.h"
#include "libvdbsynth/texture/point_parameterization.h"
#include "libvdbsynth/texture/surface_texture.h"
#include "tests/support/point_shapes.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

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

struct Made {
    TexturedSites sites;
    double texel;
};

Made make(const std::string& method, const TextureTarget& target, const SampleImage& sample,
          const SurfaceTextureOptions& options, const RunContext& ctx) {
    if (method == "parameterize") {
        PointParameterizationResult made = parameterizePoints(target, sample, {}, ctx);
        return {std::move(made.sites), made.texel};
    }
    if (method == "match" || method == "match4") {
        PointMatchingOptions own;
        own.levels = method == "match4" ? 4 : 1;
        PointMatchingResult made = matchPoints(target, sample, own, ctx);
        return {std::move(made.sites), made.texel};
    }
    if (method == "hybrid") {
        PointHybridResult made = texturePointsHybrid(target, sample, {}, ctx);
        return {std::move(made.sites), made.texel};
    }
    SurfaceTextureResult made = textureSurface(target, {sample}, options, ctx);
    return {std::move(made.sites), made.texel};
}

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
    RunContext ctx;
    SurfaceTextureOptions options;
    std::string method = "default";
    std::vector<std::string> samples;
    for (int i = 2; i < argc; ++i) {
        const std::string text = argv[i];
        const auto value = [&] { return i + 1 < argc ? std::atof(argv[++i]) : 0.0; };
        if (text == "--method" && i + 1 < argc)
            method = argv[++i];
        else if (text == "--seed")
            ctx.seed = std::uint64_t(value());
        else if (text == "--coherence")
            options.synthesis.coherence = value();
        else if (text == "--passes")
            options.synthesis.passes = int(value());
        else if (text == "--uniformity")
            options.synthesis.uniformity = value();
        else if (text == "--histogram")
            options.synthesis.histogram = value();
        else if (text == "--similar")
            options.synthesis.similar = int(value());
        else if (text == "--coarse-passes")
            options.synthesis.coarsePasses = int(value());
        else if (text == "--levels")
            options.synthesis.levels = int(value());
        else
            samples.push_back(text);
    }
    if (argc < 3 || samples.empty()) {
        std::fprintf(stderr,
                     "usage: texture_quality TARGET SAMPLE... [--method "
                     "default|parameterize|match|match4|hybrid] [--seed N] [--coherence X] [--passes N] "
                     "[--similar N] [--levels N] [--uniformity X] [--histogram X]\n");
        return 2;
    }
    const TextureTarget target = targetOf(argv[1]);
    std::printf("%-28s %8s %8s %8s %8s %8s %9s\n", "sample", "W1", "steps", "seams", "patches", "coherent",
                "points/s");
    for (const std::string& path : samples) {
        const SampleImage sample = test::sampleOf(readRaster(path));
        const double begun = secondsNow();
        const Made result = make(method, target, sample, options, ctx);
        const double seconds = secondsNow() - begun;
        const test::TextureNumbers numbers =
            test::textureNumbers(target, result.sites, sample, result.texel, ctx);
        std::printf("%-28s %8.3f %8.3f %8.3f %8.3f %8.3f %9.0f\n", path.substr(path.rfind('/') + 1).c_str(),
                    numbers.histogram, numbers.steps, numbers.seams, numbers.patches, numbers.coherent,
                    double(target.point.size()) / seconds);
        std::fflush(stdout);
    }
    return 0;
}
