#pragma once
#include "libvdbsynth/base/run_context.h"

#include <chrono>
#include <string>
#include <vector>

namespace vdbsynth::cli {

enum class ProgressStyle {
    Off,
    Bar,
    Lines,  ///< a line a minute, for logs
    Json
};

/// How a line of ProgressStyle::Lines reads: "STAGE, 45 %, 2 min left".
std::string progressText(const Progress& progress, double seconds);

/// One stage as --report lists it.
struct StageRecord {
    std::string name;
    double seconds = 0;
    std::uint64_t peakBytes = 0;  ///< of the process, at the end of the stage
};

/// Shows progress on standard error (a redrawn bar, a line a minute, or one JSON object per line) and records
/// the times of the stages for --report.
class ProgressLog {
public:
    explicit ProgressLog(ProgressStyle style) : mStyle(style) {}
    void update(const Progress& progress);
    /// Removes the bar so that text can follow.
    void clear();
    /// Ends the last stage. @return all stages, in order
    const std::vector<StageRecord>& finish();

private:
    void endStage();
    void draw(const Progress& progress);

    using Clock = std::chrono::steady_clock;
    ProgressStyle mStyle;
    std::vector<StageRecord> mStages;
    std::string mCurrent;
    Clock::time_point mBegan = Clock::now(), mDrawn{}, mSaid = Clock::now();
    bool mVisible = false;
};

/// Largest resident memory of this process so far. [bytes]
std::uint64_t peakMemory();

}  // namespace vdbsynth::cli
