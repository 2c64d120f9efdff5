// The search of an analogy beside FLANN's randomised kd-trees: grooves on a level set, its direction axis:z.
// Usage: analogy_bench B.vdb; prints one JSON object. Both ways are asked about the same voxels, those that
// an analogy works out, with B' as it is when the analogy is done; distances are those of whole features, not
// of reduced ones.
#include <flann/flann.hpp>
#include <nlohmann/json.hpp>

#include "libvdbsynth/analogy/volume_analogy_steps.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

using namespace vdbsynth;

namespace {

constexpr std::size_t kTimed = 20000, kCompared = 2000;
constexpr int kTrees = 4, kChecks = 128, kRuns = 3;

double seconds(const std::function<void()>& work) {
    const auto began = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

float squaredBetween(const float* a, const float* b, std::size_t length) {
    float sum = 0;
    for (std::size_t k = 0; k < length; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

// Whole features of the voxels of a model and its textured one.
std::vector<float> featuresOf(const FeatureShape& shape, const AnalogyVoxels& voxels,
                              const AnalogyPyramid& plain, const AnalogyPyramid& textured) {
    const FeatureFields fields{&plain.density[0], &plain.density[1], &textured.density[1]};
    std::vector<float> features(voxels.table.size() * shape.size());
    parallelFor({}, voxels.table.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float* out = features.data() + i * shape.size();
            const Vec3f at = middleOf(voxels.table[i]);
            sampleMade(shape, textured.density[0], at, voxels.frame[i], voxels.curvature[i], out);
            sampleRest(shape, fields, at, voxels.frame[i], voxels.curvature[i], out + shape.made());
        }
    });
    return features;
}

struct Search {
    double seconds = 0;                   // for one query, both threads at work
    std::vector<std::int32_t> rows = {};  // for those that are compared
};

template <typename Ask>
Search timed(std::size_t queries, const Ask& ask) {
    std::vector<double> runs;
    Search search;
    search.rows.resize(kCompared);
    for (int run = 0; run < kRuns; ++run)
        runs.push_back(seconds([&] {
            parallelFor({}, queries, 64, [&](std::size_t begin, std::size_t end) {
                for (std::size_t q = begin; q < end; ++q) {
                    const std::int32_t row = ask(q);
                    if (q < kCompared) search.rows[q] = row;
                }
            });
        }));
    std::sort(runs.begin(), runs.end());
    search.seconds = runs[kRuns / 2] / double(queries);
    return search;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    openvdb::initialize();
    MakeOptions make;
    make.exemplar.kind = "grooves";
    const ModelPair models = makePair(make);
    const LevelSet target = readVdbModel(argv[1]);
    DirectionSource direction;
    parseDirection("axis:z", direction);
    const PairFields fields = gatherPair({&models.plain, &models.textured}, 1, {});
    const FrameField pairFrames = framesOf(fields.plain, fields.place, direction, "the pair", {});
    const VolumeAnalogyOptions options;
    const int band = int(std::ceil(reachOf(*fields.plain, *fields.textured))) + ((options.half + 2) << 2) + 2;
    const CutFaces cut = facesTouched(target);
    const IndexBox box = grown(target.domain, cut, band);
    const auto plain =
        std::make_shared<const BrickField>(gatherWideBand(*target.grid, box, cut, float(band)));
    const FieldPlace place{target.grid.get(), {double(box.min.x), double(box.min.y), double(box.min.z)}, 1};
    const FrameField frames = framesOf(plain, place, direction, "the target", {});
    const AnalogyPair pair{fields.plain, fields.textured, &pairFrames, fields.inner};

    VolumeAnalogyResult made;
    const double ours = seconds([&] { made = makeAnalogy({pair}, *plain, frames, options); });
    double asked = 0;
    for (const AnalogyLevelStats& level : made.levels) asked += double(level.voxels) * options.sweeps;

    const FeatureShape shape{options.half, options.coarseHalf, options.causal, true};
    const std::vector<PairLevels> levels{
        {analogyPyramid(*fields.plain, 2, {}), analogyPyramid(*fields.textured, 2, {})}};
    const AnalogyTraining training({pair}, levels, 0, shape, options, {});
    const auto open = [&](float d) { return training.depths().open(d); };
    const AnalogyVoxels rowVoxels = [&] {
        AnalogyVoxels voxels =
            analogyVoxels(VoxelTable::where(*fields.plain, open), pairFrames, 0, true, true, {});
        return voxels;
    }();
    const BrickField distance =
        readAnalogy(made.sources, made.depths, plain->box(), {{fields.textured, {0, 0, 0}, 1}}, *plain);
    const AnalogyPyramid made2 = analogyPyramid(distance, 2, {}), plain2 = analogyPyramid(*plain, 2, {});
    const AnalogyVoxels queryVoxels =
        analogyVoxels(VoxelTable::where(*plain, open), frames, 0, true, true, {});
    const std::size_t length = shape.size();
    // Rows are those that may be copied, in the training's order.
    const std::vector<float> all = featuresOf(shape, rowVoxels, levels[0].plain, levels[0].textured);
    std::vector<float> rows;
    for (std::size_t r = 0; r < training.size(); ++r) {
        const std::int32_t v = rowVoxels.table.find(training.voxel(training.row(std::int32_t(r))));
        rows.insert(rows.end(), all.begin() + std::ptrdiff_t(std::size_t(v) * length),
                    all.begin() + std::ptrdiff_t((std::size_t(v) + 1) * length));
    }
    const std::vector<float> allQueries = featuresOf(shape, queryVoxels, plain2, made2);
    std::vector<float> queries, reduced;
    std::vector<std::int32_t> copied(kCompared, -1);
    std::vector<std::size_t> voxel;
    Random random(1, 1);
    for (std::size_t q = 0; q < kTimed; ++q) {
        const std::size_t v = random.below(std::uint32_t(queryVoxels.table.size()));
        voxel.push_back(v);
        const float* feature = allQueries.data() + v * length;
        queries.insert(queries.end(), feature, feature + length);
        std::vector<float> rest(training.reduced().count()), out(rest.size());
        training.reduced().ofRest(feature + shape.made(), plain->inside(queryVoxels.table[v]), rest.data());
        training.reduced().addMade(feature, rest.data(), out.data());
        reduced.insert(reduced.end(), out.begin(), out.end());
    }
    std::vector<std::size_t> sourceOf(queryVoxels.table.size(), made.sources.size());
    for (std::size_t s = 0; s < made.sources.size(); ++s) {
        const std::int32_t v = queryVoxels.table.find(made.sources.voxels()[s]);
        if (v >= 0) sourceOf[std::size_t(v)] = s;
    }
    for (std::size_t q = 0; q < kCompared; ++q)
        if (sourceOf[voxel[q]] < made.sources.size())
            // Moved to the target's depth since it was found, by less than a voxel.
            copied[q] = training.find(0, nearestVoxel(*made.sources.strongest(sourceOf[voxel[q]])));

    const Search index = timed(kTimed, [&](std::size_t q) {
        return training.index()
            .nearest(reduced.data() + q * training.reduced().count(), kOutside, float(options.epsilon))
            .row;
    });
    flann::Index<flann::L2<float>> trees(flann::Matrix<float>(rows.data(), training.size(), length),
                                         flann::KDTreeIndexParams(kTrees));
    const double built = seconds([&] { trees.buildIndex(); });
    const Search flann = timed(kTimed, [&](std::size_t q) {
        int row = -1;
        float squared = 0;
        flann::Matrix<int> rowsFound(&row, 1, 1);
        flann::Matrix<float> distances(&squared, 1, 1);
        trees.knnSearch(flann::Matrix<float>(queries.data() + q * length, 1, length), rowsFound, distances, 1,
                        flann::SearchParams(kChecks));
        return row;
    });
    std::vector<float> exact(kCompared);
    parallelFor({}, kCompared, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end; ++q) {
            exact[q] = 1e30f;
            for (std::size_t r = 0; r < training.size(); ++r)
                exact[q] = std::min(
                    exact[q], squaredBetween(queries.data() + q * length, rows.data() + r * length, length));
        }
    });
    const auto over = [&](const std::vector<std::int32_t>& found) {
        double sum = 0, best = 0;
        for (std::size_t q = 0; q < kCompared; ++q) {
            if (copied[q] < 0 || found[q] < 0) continue;
            sum += std::sqrt(double(squaredBetween(queries.data() + q * length,
                                                   rows.data() + std::size_t(found[q]) * length, length)));
            best += std::sqrt(double(exact[q]));
        }
        return sum / best;
    };
    const nlohmann::json result{{"seconds", ours},
                                {"voxels_asked", asked},
                                {"rows", training.size()},
                                {"feature_length", length},
                                {"flann_build_seconds", built},
                                {"flann_query_us", 1e6 * flann.seconds},
                                {"flann_seconds", flann.seconds * asked + built},
                                {"index_query_us", 1e6 * index.seconds},
                                {"distance_over_exact_copied", over(copied)},
                                {"distance_over_exact_index", over(index.rows)},
                                {"distance_over_exact_flann", over(flann.rows)}};
    std::printf("%s\n", result.dump().c_str());
    return 0;
}
