#pragma once
#include <cstdint>
#include <string>

namespace vdbsynth {

/// The smallest memory limit [bytes] of this process's control group and of all groups above it, as
/// containers and job schedulers set them (version 1, 2, or both at once).
/// @param root  folder that contains proc and sys; empty for the machine's own
/// @return 2^64 - 1 if there is no limit or nothing can be read
std::uint64_t controlGroupLimit(const std::string& root = "");

/// The machine's memory [bytes], or the limit of its control groups if that is less.
std::uint64_t presentMemory();

}  // namespace vdbsynth
