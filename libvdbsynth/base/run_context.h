#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace vdbsynth {

/// How far a stage of work has come. `done` never falls within a stage; `total` is at least 1.
struct Progress {
    std::string stage;      ///< what is being done, for example "synthesis pass 2 of 3"
    std::size_t done = 0;   ///< units finished
    std::size_t total = 1;  ///< units in the stage
    bool reading = false;   ///< true while a file made by others is being parsed
};

enum class MessageLevel {
    Detail,  ///< shown with -v
    Note,    ///< a decision made for the user, for example a default resolution
    Warning  ///< a result that may not be what the user wants
};

/// Everything a run shares: progress, messages, cancel, seed and threads. Passed last to every
/// function that may take long. A default-constructed context is silent and uses all cores.
struct RunContext {
    /// Called by the thread that called the library, never by workers. May be empty.
    std::function<void(const Progress&)> onProgress;
    /// One line of words for a person. May be empty.
    std::function<void(MessageLevel, const std::string&)> onMessage;
    /// Set to true from any thread to stop; polled once per chunk of parallel work.
    const std::atomic<bool>* cancel = nullptr;
    std::uint64_t seed = 0;  ///< all randomness derives from (seed, element)
    /// Of this call only, not of the process; 0 means all that the caller's TBB arena has: one per core
    /// unless the caller says otherwise. Results do not depend on it. Contexts of calls at one time may
    /// differ.
    int threads = 0;
    std::uint64_t maxMemory = 0;  ///< bytes that one run may plan to use; 0 means no limit
};

/// @throw Error Cancelled when the context's cancel flag is set
void throwIfCancelled(const RunContext& ctx);

void message(const RunContext& ctx, MessageLevel level, const std::string& text);

/// @throw Error Memory "WHAT needs X GB, over `maxMemory` Y GB: HINT" if `bytes` is over ctx.maxMemory
void requireMemory(const RunContext& ctx, double bytes, const std::string& what, const std::string& hint);

/// Reports one stage of work from the calling thread; the destructor does not report.
class Stage {
public:
    Stage(const RunContext& ctx, std::string name, std::size_t total, bool reading = false);
    /// Adds finished units, reports when at least a hundredth of the stage has passed, polls cancel.
    void advance(std::size_t units = 1);

private:
    const RunContext& mContext;
    Progress mProgress;
    std::size_t mReported = 0;
};

}  // namespace vdbsynth
