#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace vdbsynth {

/// Progress of a stage of work. `done` never decreases within a stage; `total` is at least 1.
struct Progress {
    std::string stage;      ///< name of the work, for example "synthesis pass 2 of 3"
    std::size_t done = 0;   ///< units finished
    std::size_t total = 1;  ///< units in the stage
    bool reading = false;   ///< true while an input file is being parsed
};

enum class MessageLevel {
    Detail,  ///< shown with -v
    Note,    ///< a decision made for the user, for example a default resolution
    Warning  ///< a result that may not be what the user wants
};

/// Everything that a run shares: progress, messages, cancellation, seed and threads. An argument of every
/// function that may take long. A default-constructed context is silent and uses all cores.
struct RunContext {
    /// Called by the thread that called the library, never by workers. May be empty.
    std::function<void(const Progress&)> onProgress;
    /// One line of text for a person. May be empty.
    std::function<void(MessageLevel, const std::string&)> onMessage;
    /// Set to true from any thread to stop; polled once per chunk of parallel work.
    const std::atomic<bool>* cancel = nullptr;
    std::uint64_t seed = 0;  ///< all randomness derives from (seed, element)
    /// For this call only, not for the process; 0: all threads of the caller's TBB arena, by default one per
    /// core. Results do not depend on it. Contexts of concurrent calls may differ.
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
    /// Adds finished units, reports after each hundredth of the stage, polls for cancellation.
    void advance(std::size_t units = 1);

private:
    const RunContext& mContext;
    Progress mProgress;
    std::size_t mReported = 0;
};

}  // namespace vdbsynth
