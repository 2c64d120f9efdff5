#pragma once
#include "tests/support/makers.h"

#include <atomic>

// Run contexts for the tests of threads and of cancelling.
namespace vdbsynth::test {

inline RunContext onThreads(int threads) {
    RunContext ctx;
    ctx.threads = threads;
    return ctx;
}

/// What `work(ctx)` throws when it was cancelled before it began.
template <typename Work>
Thrown thrownWhenCancelled(Work&& work) {
    const std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    return thrownBy([&] { work(ctx); });
}

}  // namespace vdbsynth::test
