#pragma once
#include "libvdbsynth/base/run_context.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace vdbsynth {

/// Runs body(begin, end) over [0, count) in chunks of `grain` elements, on all of the context's threads. The
/// chunks do not depend on the number of threads, so a body that writes only to its own elements gives the
/// same bits for any number of them.
/// @param grain  elements per chunk, at least 1
/// @throw Error Cancelled (polled once per chunk), and whatever the body throws
/// @par Repeats  yes, for bodies as described
void parallelFor(const RunContext& ctx, std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Runs `work` on the calling thread and its parallel loops, OpenVDB's included, on at most ctx.threads
/// threads. Other loops of the process keep theirs. With 0, or if the caller's TBB arena has no more threads
/// than that, they run on the threads of that arena, so nested calls cost nothing. A thread that waits for
/// these loops takes no other work of the caller's meanwhile.
/// @throw whatever `work` throws
void runWithThreads(const RunContext& ctx, const std::function<void()>& work);

/// runWithThreads for work with a result.
template <typename Work>
auto withThreads(const RunContext& ctx, Work&& work) -> decltype(work()) {
    if constexpr (std::is_void_v<decltype(work())>) {
        runWithThreads(ctx, [&] { work(); });
    } else {
        std::optional<decltype(work())> result;
        runWithThreads(ctx, [&] { result.emplace(work()); });
        return std::move(*result);
    }
}

}  // namespace vdbsynth
