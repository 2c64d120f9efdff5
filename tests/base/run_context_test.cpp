#include "libvdbsynth/base/run_context.h"

#include <catch2/catch.hpp>

#include <vector>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("Stage: progress starts at 0, never falls and ends at the total", "[base][property]") {
    std::vector<Progress> seen;
    RunContext ctx;
    ctx.onProgress = [&](const Progress& progress) { seen.push_back(progress); };
    Stage stage(ctx, "work", 1000);
    for (int i = 0; i < 1000; ++i) stage.advance();
    REQUIRE(seen.size() > 50);
    CHECK(seen.size() < 300);
    CHECK(seen.front().done == 0);
    CHECK(seen.back().done == 1000);
    for (std::size_t i = 1; i < seen.size(); ++i) CHECK(seen[i].done >= seen[i - 1].done);
}

TEST_CASE("Stage: a cancelled context throws before any work", "[base][cancel]") {
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { Stage(ctx, "work", 3); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("requireMemory: over the limit says how much and what helps", "[base][error]") {
    RunContext ctx;
    ctx.maxMemory = 1000000000;
    CHECK_NOTHROW(requireMemory(ctx, 9e8, "a grid", "use less"));
    const test::Thrown thrown =
        test::thrownBy([&] { requireMemory(ctx, 4e12, "a grid", "use larger voxels"); });
    CHECK(thrown.code == int(ErrorCode::Memory));
    CHECK(thrown.message == "a grid needs about 4e+03 GB, over `maxMemory` 1 GB; use larger voxels");
    ctx.maxMemory = 0;
    CHECK_NOTHROW(requireMemory(ctx, 4e15, "a grid", ""));
}
