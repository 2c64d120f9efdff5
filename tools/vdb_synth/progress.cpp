#include "tools/vdb_synth/progress.h"

#include "libvdbsynth/base/printable_text.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

#include <sys/resource.h>

namespace vdbsynth::cli {

namespace {

// Of a stage, as fast as it went so far; nothing where that says little.
std::string timeLeft(double seconds, double fraction) {
    constexpr double kLeastSeconds = 1, kLeastShare = 0.05;
    if (seconds < kLeastSeconds || fraction < kLeastShare || fraction >= 1) return "";
    const long left = std::lround(seconds * (1 - fraction) / fraction);
    if (left < 1) return "";
    if (left < 100) return ", " + std::to_string(left) + " s left";
    return ", " + std::to_string((left + 30) / 60) + " min left";
}

constexpr std::chrono::seconds kBetweenLines{60};

}  // namespace

std::string progressText(const Progress& progress, double seconds) {
    const double fraction = double(progress.done) / double(progress.total);
    return printableText(progress.stage.substr(0, 60)) + ", " + std::to_string(int(fraction * 100)) + " %" +
           timeLeft(seconds, fraction);
}

std::uint64_t peakMemory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

void ProgressLog::endStage() {
    if (mCurrent.empty()) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - mBegan).count();
    if (!mStages.empty() && mStages.back().name == mCurrent)
        mStages.back().seconds += seconds;
    else
        mStages.push_back({mCurrent, seconds, 0});
    mStages.back().peakBytes = peakMemory();
}

void ProgressLog::update(const Progress& progress) {
    if (progress.stage != mCurrent) {
        endStage();
        mCurrent = progress.stage;
        mBegan = Clock::now();
        mDrawn = {};
    }
    draw(progress);
}

void ProgressLog::draw(const Progress& progress) {
    const bool last = progress.done == progress.total;
    const auto now = Clock::now();
    if (mStyle == ProgressStyle::Off || (!last && now - mDrawn < std::chrono::milliseconds(100))) return;
    mDrawn = now;
    const double seconds = std::chrono::duration<double>(now - mBegan).count();
    if (mStyle == ProgressStyle::Lines) {
        if (now - mSaid < kBetweenLines) return;
        mSaid = now;
        std::fprintf(stderr, "vdb_synth: %s\n", progressText(progress, seconds).c_str());
        return;
    }
    const double fraction = double(progress.done) / double(progress.total);
    if (mStyle == ProgressStyle::Json) {
        const nlohmann::json line{
            {"stage", progress.stage}, {"done", progress.done}, {"total", progress.total}};
        std::fprintf(stderr, "%s\n",
                     line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
        return;
    }
    constexpr int kWidth = 30;
    std::string bar(kWidth, ' ');
    for (int i = 0; i < int(fraction * kWidth); ++i) bar[std::size_t(i)] = '#';
    std::fprintf(stderr, "\r\033[K[%s] %3d %% %s%s", bar.c_str(), int(fraction * 100),
                 printableText(progress.stage.substr(0, 60)).c_str(), timeLeft(seconds, fraction).c_str());
    std::fflush(stderr);
    mVisible = true;
}

void ProgressLog::clear() {
    if (!mVisible) return;
    std::fprintf(stderr, "\r\033[K");
    std::fflush(stderr);
    mVisible = false;
}

const std::vector<StageRecord>& ProgressLog::finish() {
    endStage();
    mCurrent.clear();
    clear();
    return mStages;
}

}  // namespace vdbsynth::cli
