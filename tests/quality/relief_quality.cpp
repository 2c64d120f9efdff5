// What relief gives, in numbers, a line each: NAME VALUE...
//   relief_quality right                                      answers that are known
//   relief_quality statistics SAMPLE TARGET [--base-radius R] [--whole-sample] [--resolution N] [--scale S]
//   relief_quality mismatch                                   the default beside the exhaustive method
// tests/quality/reliefs.py runs it for the tables of docs/relief.md.
#include "tests/quality/relief_measures.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/texture/texture_sample.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace vdbsynth;

namespace {

struct Arguments {
    std::vector<std::string> paths;
    double baseRadius = 0, scale = 1;
    bool wholeSample = false;
    int resolution = 128;
};

ReliefSource sourceOf(const std::string& path, LevelSet& scan, int resolution) {
    ReliefSource source;
    const std::string extension = extensionOf(path);
    if (extension == "png" || extension == "jpg") {
        const SampleImage image = readTextureSamples({{path, {}}}, Tiling::Auto).front().image;
        source.heights = {image.width, image.height, 1, image.tileable, {}};
        for (std::size_t i = 0; i < image.texels(); ++i) {
            float sum = 0;
            for (int c = 0; c < image.channels; ++c)
                sum += image.values[i * std::size_t(image.channels) + std::size_t(c)];
            source.heights.values.push_back(sum / float(image.channels));
        }
        return source;
    }
    ModelOptions model;
    model.resolution = resolution;
    scan = loadModel(path, model);
    source.scan = &scan;
    return source;
}

void statistics(const Arguments& arguments) {
    ModelOptions model;
    model.resolution = arguments.resolution;
    LevelSet scan;
    const ReliefSource source = sourceOf(arguments.paths.at(0), scan, arguments.resolution);
    const LevelSet target = loadModel(arguments.paths.at(1), model);
    ReliefOptions options;
    options.baseRadius = arguments.baseRadius;
    options.wholeSample = arguments.wholeSample;
    options.scale = arguments.scale;
    const auto start = std::chrono::steady_clock::now();
    const ReliefResult result = transferRelief({source}, target, {}, options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const quality::Heights sample = quality::sampleHeights(source, options);
    const quality::Heights made = quality::madeHeights(result.model, target);
    const ReliefStatistics &before = sample.statistics, &after = made.statistics;
    std::printf("statistics %g %g %g %g %g %g", before.sq, after.sq,
                quality::wasserstein(sample, made) / before.sq, after.ssk - before.ssk,
                after.sku - before.sku, seconds);
    for (std::size_t i = 0; i < std::min(before.octaves.size(), after.octaves.size()); ++i)
        std::printf(" %g:%g:%g", before.octaves[i].shortest, before.octaves[i].deviation,
                    after.octaves[i].deviation);
    std::printf("\n");
}

}  // namespace

int main(int count, char** words) try {
    Arguments arguments;
    for (int i = 2; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--whole-sample") {
            arguments.wholeSample = true;
        } else if (word.rfind("--", 0) == 0 && i + 1 < count) {
            const double value = std::atof(words[++i]);
            if (word == "--base-radius") arguments.baseRadius = value;
            if (word == "--scale") arguments.scale = value;
            if (word == "--resolution") arguments.resolution = int(value);
        } else {
            arguments.paths.push_back(word);
        }
    }
    const std::string task = count > 1 ? words[1] : "";
    if (task == "right") {
        quality::printRightAnswers();
    } else if (task == "mismatch") {
        quality::printMismatch();
    } else if (task == "statistics" && arguments.paths.size() == 2) {
        statistics(arguments);
    } else {
        std::fprintf(stderr, "usage: relief_quality right | mismatch | statistics SAMPLE TARGET [options]\n");
        return 2;
    }
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "relief_quality: %s\n", e.what());
    return 1;
}
