// Calls at one time, as a host with threads of its own makes them.
#include <catch2/catch.hpp>

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/match/match.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

MakeOptions makeOptions(const std::string& kind, int resolution) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    return options;
}

std::string synthHash(const LevelSet& exemplar, const RunContext& ctx) {
    return levelSetHash(*synthesize(exemplar, {}, ctx).model.grid);
}

std::string analogyHash(const ModelPair& pair, const LevelSet& target, const RunContext& ctx) {
    AnalogyOptions options;
    options.direction.kind = DirectionSource::Kind::Around;
    return levelSetHash(*makeAnalogyModel({{&pair.plain, &pair.textured}}, target, options, ctx).model.grid);
}

std::string matchText(const LevelSet& model, const std::string& indexFolder, const RunContext& ctx) {
    MatchOptions options;
    options.at = {9, 11, 14};
    options.count = 20;
    options.indexCache = indexFolder;
    std::string text;
    for (const BlockMatch& match : matchModel(model, model, options, ctx).matches)
        text += std::to_string(match.position.x) + " " + std::to_string(match.position.y) + " " +
                std::to_string(match.position.z) + " " + std::to_string(match.cost) + "\n";
    return text;
}

using Call = std::function<std::string(const RunContext&)>;

struct Caller {
    Call call;
    int threads;
    std::string result;
    int elsewhere = 0;  // reports from another thread than the caller's
};

void runAtOnce(std::vector<Caller>& callers) {
    std::vector<std::thread> threads;
    for (Caller& caller : callers)
        threads.emplace_back([&caller] {
            RunContext ctx;
            ctx.threads = caller.threads;
            const std::thread::id me = std::this_thread::get_id();
            ctx.onProgress = [&, me](const Progress&) {
                caller.elsewhere += std::this_thread::get_id() != me;
            };
            ctx.onMessage = [&, me](MessageLevel, const std::string&) {
                caller.elsewhere += std::this_thread::get_id() != me;
            };
            try {
                caller.result = caller.call(ctx);
            } catch (const std::exception& error) {
                caller.result = error.what();
            }
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace

TEST_CASE("two calls at once: different numbers of threads, the bits of each alone, its own thread told",
          "[pipeline][determinism]") {
    const test::TemporaryFolder folder;
    const LevelSet balls = makeModel(makeOptions("balls", 32)), sponge = makeModel(makeOptions("sponge", 40));
    const LevelSet tori = makeModel(makeOptions("three-tori", 48));
    const ModelPair pair = makePair(makeOptions("dilation", 48));
    const std::vector<Call> calls{
        [&](const RunContext& ctx) { return synthHash(balls, ctx); },
        [&](const RunContext& ctx) { return analogyHash(pair, tori, ctx); },
        [&](const RunContext& ctx) { return matchText(sponge, folder.path(""), ctx); },
    };
    std::vector<std::string> alone;
    for (const Call& call : calls) alone.push_back(call({}));
    for (const auto& [first, second] :
         std::vector<std::pair<std::size_t, std::size_t>>{{0, 0}, {0, 1}, {1, 1}, {0, 2}, {2, 2}, {1, 2}}) {
        std::vector<Caller> callers{{calls[first], 1, {}}, {calls[second], 2, {}}, {calls[second], 0, {}}};
        runAtOnce(callers);
        INFO(first << " beside " << second);
        CHECK(callers[0].result == alone[first]);
        CHECK(callers[1].result == alone[second]);
        CHECK(callers[2].result == callers[1].result);
        for (const Caller& caller : callers) CHECK(caller.elsewhere == 0);
    }
}

TEST_CASE("two calls at once: one that is cancelled does not stop the other", "[pipeline][cancel]") {
    const LevelSet balls = makeModel(makeOptions("balls", 32));
    const std::string alone = synthHash(balls, {});
    std::atomic<bool> cancel{false};
    std::atomic<int> begun{0};
    int code = -1;
    std::string other;
    const auto told = [&](const Progress& progress) {
        if (progress.done == 0 && ++begun >= 4) cancel = true;
    };
    std::thread stopped([&] {
        RunContext ctx;
        ctx.threads = 1;
        ctx.cancel = &cancel;
        ctx.onProgress = told;
        code = test::thrownBy([&] { synthHash(balls, ctx); }).code;
    });
    std::thread goesOn([&] {
        RunContext ctx;
        ctx.threads = 2;
        ctx.onProgress = told;
        other = synthHash(balls, ctx);
    });
    stopped.join();
    goesOn.join();
    CHECK(code == int(ErrorCode::Cancelled));
    CHECK(other == alone);
}
