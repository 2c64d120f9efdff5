#include "libvdbsynth/base/parallel.h"

#include "libvdbsynth/base/error.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace vdbsynth {
namespace {

// Debian's TBB is not built for the thread sanitizer, which then cannot see that tasks begin after what came
// before them and end before what comes after. This says so in words that it knows.
class HandOver {
public:
#if defined(__SANITIZE_THREAD__)
    void give() {
        mTurns.fetch_add(1, std::memory_order_release);
    }
    void take() {
        mTurns.load(std::memory_order_acquire);
    }

private:
    std::atomic<std::uint64_t> mTurns{0};
#else
    void give() {}
    void take() {}
#endif
};

}  // namespace

void parallelFor(const RunContext& ctx, std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body) {
    throwIfCancelled(ctx);
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t chunks = (count + grain - 1) / grain;
    const auto runChunk = [&](std::size_t chunk) {
        throwIfCancelled(ctx);
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
    };
    if (chunks == 1 || ctx.threads == 1) {
        for (std::size_t chunk = 0; chunk < chunks; ++chunk) runChunk(chunk);
        return;
    }
    const ThreadLimit limit(ctx);
    HandOver handOver;
    handOver.give();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            handOver.take();
            // A thread that waits inside a chunk must not begin another one: chunks may be large.
            tbb::this_task_arena::isolate([&] {
                for (auto chunk = range.begin(); chunk != range.end(); ++chunk) runChunk(chunk);
            });
            handOver.give();
        },
        tbb::simple_partitioner());
    handOver.take();
}

struct ThreadLimit::Impl {
    std::unique_ptr<tbb::global_control> control;
};

ThreadLimit::ThreadLimit(const RunContext& ctx) : mImpl(new Impl) {
    if (ctx.threads > 0)
        mImpl->control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                               std::size_t(ctx.threads));
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace vdbsynth
