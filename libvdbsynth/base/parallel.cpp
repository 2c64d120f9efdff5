#include "libvdbsynth/base/parallel.h"

#include "libvdbsynth/base/error.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbsynth {

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
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (auto chunk = range.begin(); chunk != range.end(); ++chunk) runChunk(chunk);
        },
        tbb::simple_partitioner());
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
