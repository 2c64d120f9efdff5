#include "libvdbsynth/base/parallel.h"

#include <catch2/catch.hpp>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("parallelFor: every element is visited once, in chunks that do not depend on threads",
          "[base][determinism]") {
    for (int threads : {1, 2, 8}) {
        RunContext ctx;
        ctx.threads = threads;
        std::vector<int> visits(1003, 0);
        std::vector<std::size_t> chunkOf(1003, 0), endOf(1003, 0);
        parallelFor(ctx, visits.size(), 10, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                ++visits[i];
                chunkOf[i] = begin;
                endOf[i] = end;
            }
        });
        for (std::size_t i = 0; i < visits.size(); ++i) {
            REQUIRE(visits[i] == 1);
            REQUIRE(chunkOf[i] == i / 10 * 10);
            REQUIRE(endOf[i] == std::min<std::size_t>(i / 10 * 10 + 10, 1003));
        }
    }
}

TEST_CASE("parallelFor: nothing to do calls nothing", "[base][fast]") {
    std::atomic<int> calls{0};
    parallelFor({}, 0, 5, [&](std::size_t, std::size_t) { ++calls; });
    CHECK(calls == 0);
}

TEST_CASE("parallelFor: a set cancel flag stops it with Cancelled", "[base][cancel]") {
    std::atomic<bool> cancel{false};
    RunContext ctx;
    ctx.cancel = &cancel;
    std::atomic<int> done{0};
    const auto work = [&](std::size_t, std::size_t) {
        ++done;
        cancel = true;
    };
    CHECK(test::thrownBy([&] { parallelFor(ctx, 1000, 1, work); }).code == int(ErrorCode::Cancelled));
    CHECK(done < 1000);
}

TEST_CASE("parallelFor: what the body throws reaches the caller", "[base][error]") {
    const auto work = [](std::size_t begin, std::size_t) {
        if (begin == 7) throw Error(ErrorCode::Solver, "seven");
    };
    CHECK(test::thrownBy([&] { parallelFor({}, 20, 1, work); }).message == "seven");
}

namespace {

// How many threads a loop of the context has at work at one time, at most.
int mostAtOnce(const RunContext& ctx) {
    std::atomic<int> now{0}, most{0};
    parallelFor(ctx, 64, 1, [&](std::size_t, std::size_t) {
        const int here = ++now;
        int before = most.load();
        while (before < here && !most.compare_exchange_weak(before, here)) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        --now;
    });
    return most;
}

RunContext contextOf(int threads) {
    RunContext ctx;
    ctx.threads = threads;
    return ctx;
}

// True if two threads of a loop meet. Waits for a second at most.
bool twoMeet() {
    std::atomic<int> at{0}, most{0};
    tbb::parallel_for(0, 2, [&](int) {
        const int here = ++at;
        if (here > most) most = here;
        for (int wait = 0; wait < 1000 && most < 2; ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --at;
    });
    return most == 2;
}

}  // namespace

TEST_CASE("withThreads: loops inside run on at most the context's threads", "[base][property]") {
    const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 8);
    tbb::task_arena host(8);
    host.execute([] {
        CHECK(mostAtOnce(contextOf(0)) > 3);
        for (int threads : {1, 2, 3}) {
            CHECK(mostAtOnce(contextOf(threads)) <= threads);
            withThreads(contextOf(threads), [&] {
                CHECK(tbb::this_task_arena::max_concurrency() == threads);
                CHECK(mostAtOnce(contextOf(0)) <= threads);
                CHECK(mostAtOnce(contextOf(8)) <= threads);
                withThreads(contextOf(8), [&] { CHECK(tbb::this_task_arena::max_concurrency() == threads); });
            });
        }
    });
}

TEST_CASE("withThreads: loops of the host on another thread keep their threads", "[base][property]") {
    const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 4);
    tbb::task_arena host(4);
    std::atomic<bool> begun{false}, done{false};
    bool met = false;
    std::thread other([&] {
        while (!begun) std::this_thread::yield();
        met = host.execute(twoMeet);
        done = true;
    });
    withThreads(contextOf(1), [&] {
        begun = true;
        while (!done) std::this_thread::yield();
    });
    other.join();
    CHECK(met);
}

TEST_CASE("withThreads: progress and messages come from the calling thread", "[base][property]") {
    // Hosts whose own arena is full, as many as there are workers.
    std::vector<std::thread> hosts;
    std::atomic<int> elsewhere{0}, told{0};
    for (int h = 0; h < 4; ++h)
        hosts.emplace_back([&, h] {
            RunContext ctx = contextOf(1 + h % 2);
            const std::thread::id caller = std::this_thread::get_id();
            const auto tell = [&, caller] {
                ++told;
                if (std::this_thread::get_id() != caller) ++elsewhere;
            };
            ctx.onProgress = [&](const Progress&) { tell(); };
            ctx.onMessage = [&](MessageLevel, const std::string&) { tell(); };
            for (int round = 0; round < 50; ++round)
                withThreads(ctx, [&] {
                    Stage stage(ctx, "work", 2);
                    parallelFor(ctx, 64, 1, [](std::size_t, std::size_t) {});
                    stage.advance();
                    message(ctx, MessageLevel::Note, "half");
                    withThreads(ctx, [&] { stage.advance(); });
                });
        });
    for (std::thread& host : hosts) host.join();
    CHECK(told == 4 * 50 * 4);
    CHECK(elsewhere == 0);
}

TEST_CASE("withThreads: results and exceptions reach the caller", "[base][error]") {
    for (int threads : {0, 1, 2}) {
        const RunContext ctx = contextOf(threads);
        CHECK(withThreads(ctx, [] { return std::string("made"); }) == "made");
        const test::Thrown thrown = test::thrownBy([&] {
            withThreads(ctx, [&] {
                parallelFor(ctx, 20, 1, [](std::size_t begin, std::size_t) {
                    if (begin == 7) throw Error(ErrorCode::Solver, "seven");
                });
            });
        });
        CHECK(thrown.code == int(ErrorCode::Solver));
        CHECK(thrown.message == "seven");
    }
}

TEST_CASE("parallelFor: a cancelled group of the host leaves no chunk out", "[base][property]") {
    tbb::task_group group;
    std::atomic<bool> begun{false}, cancelled{false};
    std::atomic<int> done{0};
    std::thread other([&] {
        while (!begun) std::this_thread::yield();
        group.cancel();
        cancelled = true;
    });
    group.run_and_wait([&] {
        begun = true;
        while (!cancelled) std::this_thread::yield();
        parallelFor({}, 100, 1, [&](std::size_t, std::size_t) { ++done; });
    });
    other.join();
    CHECK(done == 100);
}

TEST_CASE("parallelFor: a waiting thread takes up no other task of the host", "[base][property]") {
    const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 4);
    tbb::task_arena host(4);
    std::atomic<int> nested{0};
    host.execute([&] {
        thread_local bool inside = false;  // what a task of the host would hold a lock for
        for (int round = 0; round < 100; ++round)
            tbb::parallel_for(
                tbb::blocked_range<int>(0, 9),
                [&](const tbb::blocked_range<int>& task) {
                    if (inside) ++nested;
                    inside = true;
                    parallelFor({}, 4, 1, [&](std::size_t begin, std::size_t) {
                        std::this_thread::sleep_for(
                            std::chrono::microseconds(begin * (task.begin() % 3) * 100));
                    });
                    inside = false;
                },
                tbb::simple_partitioner());
    });
    CHECK(nested == 0);
}
