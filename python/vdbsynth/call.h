#pragma once
#include "python/vdbsynth/keywords.h"

#include "libvdbsynth/base/run_context.h"

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace vdbsynth::python {

/// A call of the library from Python: its context, and who hears of it. Keywords of every function that may
/// take long; describe (option_keywords.h) lists them.
struct Call {
    RunContext context;  ///< seed, threads and memory
    py::object onProgress = py::none(), onMessage = py::none(), cancel = py::none();

    /// Runs work on a thread of its own, without the interpreter's lock. The calling thread delivers progress
    /// and messages meanwhile, looks for signals and asks `cancel` 20 times a second.
    /// @return what the work returns
    /// @throw Error as the work; Memory, Solver (what else it throws), Cancelled (`cancel` is set);
    /// KeyboardInterrupt, and whatever a callback raises: the work ends first, within the library's cancel
    template <typename Work>
    auto run(const Work& work) {
        using Result = std::invoke_result_t<Work, const RunContext&>;
        if constexpr (std::is_void_v<Result>) {
            execute([&](const RunContext& ctx) { work(ctx); });
        } else {
            std::optional<Result> result;
            execute([&](const RunContext& ctx) { result.emplace(work(ctx)); });
            return std::move(*result);
        }
    }

private:
    void execute(const std::function<void(const RunContext&)>& work);
};

}  // namespace vdbsynth::python
