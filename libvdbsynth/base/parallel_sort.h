#pragma once
#include "libvdbsynth/base/parallel.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace vdbsynth {

/// Sorts by tbb::parallel_sort on the context's threads.
/// @param less  a strict weak ordering; elements that it calls equal keep no particular order, so give one
///              that distinguishes all elements if bits must repeat
/// @throw Error Cancelled (before it begins)
/// @par Cost    O(n log n), in place
/// @par Repeats same order for any number of threads, if the ordering distinguishes all elements
template <typename T, typename Less = std::less<T>>
void parallelSort(const RunContext& ctx, std::vector<T>& elements, Less less = {}) {
    throwIfCancelled(ctx);
#if defined(__SANITIZE_THREAD__)
    // Debian's TBB is not built for the thread sanitizer, which sees races in its hand-over of tasks.
    std::sort(elements.begin(), elements.end(), less);
#else
    runWithThreads(ctx, [&] { tbb::parallel_sort(elements.begin(), elements.end(), less); });
#endif
}

}  // namespace vdbsynth
