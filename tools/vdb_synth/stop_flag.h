#pragma once
#include <atomic>

namespace vdbsynth::cli {

/// True once SIGINT or SIGTERM was received.
const std::atomic<bool>* stopFlag();

}  // namespace vdbsynth::cli
