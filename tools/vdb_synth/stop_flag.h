#pragma once
#include <atomic>

namespace vdbsynth::cli {

/// True once SIGINT or SIGTERM came in.
const std::atomic<bool>* stopFlag();

}  // namespace vdbsynth::cli
