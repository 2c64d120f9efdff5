#pragma once
#include "libvdbsynth/base/run_context.h"

#include <cstddef>
#include <functional>
#include <memory>

namespace vdbsynth {

/// Runs body(begin, end) over [0, count) in chunks of `grain` elements, on all of the context's
/// threads. The chunks do not depend on the number of threads, so a body that writes only to the
/// slots of its own elements gives the same bits for any number of them.
/// @param grain  elements in a chunk, at least 1
/// @throw Error Cancelled (polled once per chunk), and whatever the body throws
/// @par Repeats  yes, for bodies as described
void parallelFor(const RunContext& ctx, std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Holds the process to the context's number of threads (also inside OpenVDB) while it lives.
class ThreadLimit {
public:
    explicit ThreadLimit(const RunContext& ctx);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

}  // namespace vdbsynth
