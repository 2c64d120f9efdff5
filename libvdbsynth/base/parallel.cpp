#include "libvdbsynth/base/parallel.h"

#include "libvdbsynth/base/error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace vdbsynth {
namespace {

// Debian's TBB is built without the thread sanitizer, which then cannot see that tasks begin after the
// preceding code and end before the following. This tells it so.
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
    HandOver handOver;
    handOver.give();
    // Chunks would be skipped silently if the caller's group is cancelled.
    tbb::task_group_context apart(tbb::task_group_context::isolated);
    const auto runRange = [&](const tbb::blocked_range<std::size_t>& range) {
        handOver.take();
        // A thread that waits inside a chunk must not begin another one: chunks may be large.
        tbb::this_task_arena::isolate([&] {
            for (auto chunk = range.begin(); chunk != range.end(); ++chunk) runChunk(chunk);
        });
        handOver.give();
    };
    runWithThreads(ctx, [&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1), runRange, tbb::simple_partitioner(),
                          apart);
    });
    handOver.take();
}

void runWithThreads(const RunContext& ctx, const std::function<void()>& work) {
    if (ctx.threads <= 0 || tbb::this_task_arena::max_concurrency() <= ctx.threads) {
        tbb::this_task_arena::isolate(work);
        return;
    }
    // One slot is kept for the calling thread, so that it never has to hand the work to another.
    tbb::task_arena arena(ctx.threads, /* reserved_for_masters= */ 1);
    arena.execute(work);
}

}  // namespace vdbsynth
