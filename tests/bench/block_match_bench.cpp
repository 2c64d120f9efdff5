// Exact best blocks beside the rival: all squared differences at once by FFT (FFTW, single precision, all
// threads), the plan and what does not depend on the query made beforehand. Both answer the same queries, cut
// from another seed's sample, half with one octant masked; what they find is compared. Beside them a scan
// that gives up early, and Faiss where it fits. VDBSYNTH_BENCH_QUERIES is how many, VDBSYNTH_BENCH_WAY asks
// ours for one of its ways, bounds or correlation.
#include <benchmark/benchmark.h>
#include <faiss/IndexFlat.h>
#include <fftw3.h>

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/search/block_cost.h"
#include "libvdbsynth/search/block_index.h"
#include "libvdbsynth/search/block_index_data.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <map>
#include <memory>
#include <thread>

namespace vdbsynth {
namespace {

struct Row {
    std::string name, kind;
    double featureInBlocks;  // 0: the kind's own
};
const std::vector<Row> kRows{{"balls_0.4", "balls", 0.8}, {"balls_0.75", "balls", 1.5},
                             {"balls_1", "balls", 2},     {"balls_1.5", "balls", 3},
                             {"sponge", "sponge", 0},     {"terrain", "terrain", 0}};

struct Query {
    std::vector<float> samples;
    std::vector<std::uint8_t> known;  // empty: everywhere
};

// What a row works on: exemplar, queries, our index, the rival's transforms.
struct Setting {
    std::shared_ptr<const BrickField> exemplar;
    std::vector<Query> queries;
    int block = 16;
};

BrickField sampleOf(const Row& row, int side, int block, std::uint64_t seed) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = row.kind;
    options.exemplar.size = {side, side, side};
    options.exemplar.feature = row.featureInBlocks * block;
    RunContext ctx;
    ctx.seed = seed;
    const LevelSet model = makeModel(options, ctx);
    return gatherWideBand(*model.grid, model.domain, kAllCut, std::max(8.f, float(block) / 2));
}

std::vector<Query> cutQueries(const BrickField& other, int block, int count) {
    std::vector<Query> queries;
    const Index3 size = other.box().size();
    for (std::uint64_t i = 0; queries.size() < std::size_t(count) && i < 100000; ++i) {
        Random random(7, i);
        const Index3 corner{int(random.below(std::uint32_t(size.x - block + 1))),
                            int(random.below(std::uint32_t(size.y - block + 1))),
                            int(random.below(std::uint32_t(size.z - block + 1)))};
        Query query;
        query.samples.resize(std::size_t(block) * block * block);
        other.readBox(corner, {block, block, block}, query.samples.data());
        const auto [low, high] = std::minmax_element(query.samples.begin(), query.samples.end());
        if (*low >= 0 || *high <= 0) continue;  // synthesis asks for blocks with a surface
        if (queries.size() % 2 == 1) {
            query.known.assign(query.samples.size(), 1);
            const int half = block / 2;
            for (int x = half; x < block; ++x)
                for (int y = half; y < block; ++y)
                    for (int z = half; z < block; ++z)
                        query.known[std::size_t((x * block + y) * block + z)] = 0;
        }
        queries.push_back(std::move(query));
    }
    return queries;
}

Setting& settingFor(const Row& row, int side, int block) {
    static std::map<std::string, Setting> made;
    const std::string key = row.name + "/" + std::to_string(side);
    if (made.count(key)) return made[key];
    made.clear();  // one at a time: they are large
    Setting& setting = made[key];
    setting.block = block;
    setting.exemplar = std::make_shared<const BrickField>(sampleOf(row, side, block, 1));
    const char* count = std::getenv("VDBSYNTH_BENCH_QUERIES");
    setting.queries = cutQueries(sampleOf(row, side, block, 2), block, count ? std::atoi(count) : 200);
    return setting;
}

// Exhaustive squared differences by correlation: sum of E^2 m, less twice that of E q m, plus that of q^2 m.
class Exhaustive {
public:
    Exhaustive(const BrickField& exemplar, int block) : mSize(exemplar.box().size()), mBlock(block) {
        fftwf_init_threads();
        fftwf_plan_with_nthreads(int(std::thread::hardware_concurrency()));
        mReal = fftwf_alloc_real(std::size_t(mSize.x) * std::size_t(mSize.y) * std::size_t(mSize.z));
        mSpectrum = fftwf_alloc_complex(spectrumSize());
        mForward = fftwf_plan_dft_r2c_3d(mSize.x, mSize.y, mSize.z, mReal, mSpectrum, FFTW_MEASURE);
        mBackward = fftwf_plan_dft_c2r_3d(mSize.x, mSize.y, mSize.z, mSpectrum, mReal, FFTW_MEASURE);
        mSamples.resize(std::size_t(exemplar.box().volume()));
        exemplar.readBox({0, 0, 0}, mSize, mSamples.data());
        std::copy(mSamples.begin(), mSamples.end(), mReal);
        mExemplar = transformed();
    }
    ~Exhaustive() {
        fftwf_destroy_plan(mForward);
        fftwf_destroy_plan(mBackward);
        fftwf_free(mReal);
        fftwf_free(mSpectrum);
    }

    // The energies under a mask do not depend on the query: made once for every mask that occurs.
    void prepare(const std::vector<std::uint8_t>& known) {
        if (mEnergies.count(known)) return;
        std::vector<float> squares(mSamples.size());
        for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = mSamples[i] * mSamples[i];
        std::copy(squares.begin(), squares.end(), mReal);
        const std::vector<std::complex<float>> energy = transformed();
        placeBlock([&](std::size_t i) { return known.empty() ? 1.f : float(known[i]); });
        fftwf_execute(mForward);
        multiply(energy);
        fftwf_execute(mBackward);
        std::vector<float> sums(mReal, mReal + mSamples.size());
        mEnergies[known] = std::move(sums);
    }

    BlockMatch match(const Query& query) {
        placeBlock(
            [&](std::size_t i) { return query.known.empty() || query.known[i] ? query.samples[i] : 0.f; });
        fftwf_execute(mForward);
        multiply(mExemplar);
        fftwf_execute(mBackward);
        const std::vector<float>& energy = mEnergies.at(query.known);
        const float scale = 1.f / float(mSamples.size());
        float best = 1e30f;
        std::size_t at = 0;
        for (int x = 0; x <= mSize.x - mBlock; ++x)
            for (int y = 0; y <= mSize.y - mBlock; ++y) {
                const std::size_t row =
                    (std::size_t(x) * std::size_t(mSize.y) + std::size_t(y)) * std::size_t(mSize.z);
                for (std::size_t i = row; i <= row + std::size_t(mSize.z - mBlock); ++i) {
                    const float cost = (energy[i] - 2 * mReal[i]) * scale;
                    if (cost < best) {
                        best = cost;
                        at = i;
                    }
                }
            }
        const int z = int(at % std::size_t(mSize.z)), rest = int(at / std::size_t(mSize.z));
        return {{rest / mSize.y, rest % mSize.y, z}, 0};
    }

private:
    std::size_t spectrumSize() const {
        return std::size_t(mSize.x) * std::size_t(mSize.y) * std::size_t(mSize.z / 2 + 1);
    }
    std::vector<std::complex<float>> transformed() {
        fftwf_execute(mForward);
        const auto* begin = reinterpret_cast<const std::complex<float>*>(mSpectrum);
        return {begin, begin + spectrumSize()};
    }
    template <typename Value>
    void placeBlock(const Value& value) {
        std::fill(mReal, mReal + mSamples.size(), 0.f);
        std::size_t i = 0;
        for (int x = 0; x < mBlock; ++x)
            for (int y = 0; y < mBlock; ++y)
                for (int z = 0; z < mBlock; ++z, ++i)
                    mReal[(std::size_t(x) * std::size_t(mSize.y) + std::size_t(y)) * std::size_t(mSize.z) +
                          std::size_t(z)] = value(i);
    }
    void multiply(const std::vector<std::complex<float>>& by) {
        auto* spectrum = reinterpret_cast<std::complex<float>*>(mSpectrum);
        for (std::size_t i = 0; i < by.size(); ++i) {
            const float a = spectrum[i].real(), b = -spectrum[i].imag(), c = by[i].real(), d = by[i].imag();
            spectrum[i] = {a * c - b * d, a * d + b * c};
        }
    }

    Index3 mSize;
    int mBlock;
    float* mReal;
    fftwf_complex* mSpectrum;
    fftwf_plan mForward, mBackward;
    std::vector<float> mSamples;
    std::vector<std::complex<float>> mExemplar;
    std::map<std::vector<std::uint8_t>, std::vector<float>> mEnergies;
};

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<BlockQuery> blockQueries(const Setting& setting) {
    std::vector<BlockQuery> queries(setting.queries.size());
    for (std::size_t i = 0; i < queries.size(); ++i) {
        queries[i].samples = setting.queries[i].samples.data();
        queries[i].known = setting.queries[i].known.empty() ? nullptr : setting.queries[i].known.data();
    }
    return queries;
}

// One iteration answers all queries, in parallel where that is how it would be used.
void benchOurs(benchmark::State& state, const Row& row, int side, int block) {
    Setting& setting = settingFor(row, side, block);
    BlockIndexOptions options;
    options.block = block;
    const double began = seconds();
    const BlockIndex index = BlockIndex::build(setting.exemplar, options);
    state.counters["build_seconds"] = seconds() - began;
    state.counters["queries"] = double(setting.queries.size());
    const std::vector<BlockQuery> queries = blockQueries(setting);
    BlockSearchOptions search;
    if (const char* way = std::getenv("VDBSYNTH_BENCH_WAY"))
        search.way = std::string(way) == "bounds" ? BlockSearchWay::Bounds : BlockSearchWay::Correlation;
    std::vector<std::vector<BlockMatch>> matches;
    BlockSearchCounts counts;
    // What the first query that needs transforms waits for belongs to the index.
    BlockSearchOptions transforms;
    transforms.way = BlockSearchWay::Correlation;
    if (search.way != BlockSearchWay::Bounds) {
        const double before = seconds();
        index.match(queries.front(), transforms);
        state.counters["transforms_seconds"] = seconds() - before;
    }
    for (auto _ : state) matches = index.matchAll(queries, search, {}, &counts);
    state.counters["transforms"] =
        double(counts.transforms) / double(state.iterations()) / double(queries.size());
    state.counters["index_MB"] = double(index.memoryBytes()) / 1e6;
    // Both costs by the one function: ours may not be dearer than what the rival finds.
    Exhaustive rival(*setting.exemplar, block);
    int worse = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(20, matches.size()); ++i) {
        const Query& query = setting.queries[i];
        rival.prepare(query.known);
        const std::uint8_t* known = query.known.empty() ? nullptr : query.known.data();
        const double theirs = blockCost(*setting.exemplar, rival.match(query).position, block,
                                        query.samples.data(), known, countKnown(known, block), 1e30);
        worse += matches[i].front().cost > theirs;
    }
    state.counters["dearer_than_rival"] = worse;
}

void benchRival(benchmark::State& state, const Row& row, int side, int block) {
    Setting& setting = settingFor(row, side, block);
    Exhaustive rival(*setting.exemplar, block);
    for (const Query& query : setting.queries) rival.prepare(query.known);
    state.counters["queries"] = double(setting.queries.size());
    for (auto _ : state)
        for (const Query& query : setting.queries) benchmark::DoNotOptimize(rival.match(query));
}

// Settling for a tenth more difference: how close the answers are, and how many of the exact ones are found.
void benchNear(benchmark::State& state, const Row& row, int side, int block) {
    Setting& setting = settingFor(row, side, block);
    BlockIndexOptions options;
    options.block = block;
    const BlockIndex index = BlockIndex::build(setting.exemplar, options);
    const std::vector<BlockQuery> queries = blockQueries(setting);
    BlockSearchOptions search;
    search.tolerance = 0.1;
    state.counters["queries"] = double(queries.size());
    std::vector<std::vector<BlockMatch>> matches;
    for (auto _ : state) matches = index.matchAll(queries, search);
    const auto exact = index.matchAll(queries);
    double ratio = 0, recall = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const double a = std::sqrt(matches[i].front().cost), b = std::sqrt(exact[i].front().cost);
        ratio += a == b ? 1 : a / b;
        recall += matches[i].front().position == exact[i].front().position;
    }
    state.counters["exactness_ratio"] = ratio / double(queries.size());
    state.counters["recall"] = recall / double(queries.size());
}

// A scan over all positions that leaves a block once it costs more than the best so far. Both threads, few
// queries: one takes as long as all of ours.
void benchBrute(benchmark::State& state, const Row& row, int side, int block) {
    Setting& setting = settingFor(row, side, block);
    const std::size_t count = std::min<std::size_t>(4, setting.queries.size());
    state.counters["queries"] = double(count);
    for (auto _ : state)
        parallelFor({}, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                BlockQuery query;
                query.samples = setting.queries[i].samples.data();
                query.known = setting.queries[i].known.empty() ? nullptr : setting.queries[i].known.data();
                benchmark::DoNotOptimize(matchBlocksLinearly(*setting.exemplar, block, query));
            }
        });
}

// Faiss's exhaustive index over all blocks as vectors, all queries at once as one product of matrices. It
// knows no masks, so it answers those queries that have none.
void benchFaiss(benchmark::State& state, const Row& row, int side, int block) {
    Setting& setting = settingFor(row, side, block);
    const IndexBox positions = blockPositions(*setting.exemplar, block);
    const std::size_t dimension = std::size_t(block) * std::size_t(block) * std::size_t(block);
    const double gigabytes = double(positions.volume()) * double(dimension) * 4 / 1e9;
    if (gigabytes > 4) {
        state.SkipWithError("its index would not fit: every block is a vector of its own");
        return;
    }
    faiss::IndexFlatL2 index{faiss::Index::idx_t(dimension)};
    std::vector<float> rows(std::size_t(positions.size().z) * dimension);
    const double began = seconds();
    for (int x = 0; x <= positions.max.x; ++x)
        for (int y = 0; y <= positions.max.y; ++y) {
            for (int z = 0; z <= positions.max.z; ++z)
                setting.exemplar->readBox({x, y, z}, {block, block, block},
                                          rows.data() + std::size_t(z) * dimension);
            index.add(faiss::Index::idx_t(positions.size().z), rows.data());
        }
    state.counters["build_seconds"] = seconds() - began;
    state.counters["index_MB"] = gigabytes * 1000;
    std::vector<float> queries;
    for (const Query& query : setting.queries)
        if (query.known.empty()) queries.insert(queries.end(), query.samples.begin(), query.samples.end());
    const auto count = faiss::Index::idx_t(queries.size() / dimension);
    state.counters["queries"] = double(count);
    std::vector<float> distances(std::size_t(count), 0);
    std::vector<faiss::Index::idx_t> found(std::size_t(count), 0);
    for (auto _ : state) index.search(count, queries.data(), 1, distances.data(), found.data());
}

}  // namespace
}  // namespace vdbsynth

int main(int argc, char** argv) {
    using namespace vdbsynth;
    for (const Row& row : kRows)
        for (const auto& [side, block] : {std::pair{64, 8}, std::pair{128, 16}, std::pair{256, 32}}) {
            const std::string name = row.name + "/" + std::to_string(side) + "/" + std::to_string(block);
            const auto times = [&](int iterations, const std::string& who, auto* bench) {
                benchmark::RegisterBenchmark((who + "/" + name).c_str(), bench, row, side, block)
                    ->Unit(benchmark::kMillisecond)
                    ->Iterations(iterations)
                    ->UseRealTime();
            };
            times(5, "fftw", benchRival);
            times(5, "ours", benchOurs);
            times(5, "near", benchNear);
            times(1, "brute", benchBrute);
            times(1, "faiss", benchFaiss);
        }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
