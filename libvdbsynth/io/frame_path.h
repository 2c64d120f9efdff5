#pragma once
#include <string>

namespace vdbsynth {

/// True for a path with a place for the number of a frame: #### (as many digits at least as signs) or %04d.
bool namesFrames(const std::string& path);
/// The path of a frame; a path without such a place is itself. @param frame  at least 0
std::string atFrame(const std::string& path, int frame);

}  // namespace vdbsynth
