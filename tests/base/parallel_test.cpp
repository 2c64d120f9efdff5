#include "libvdbsynth/base/parallel.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <numeric>
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
