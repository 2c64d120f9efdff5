#pragma once
#include <string>

namespace vdbsynth {

/// Whole content of a file, unpacked if it is a gzip file, whatever its name.
/// @throw Error Io (missing, a directory, not readable), BadData (gzip truncated or corrupt)
std::string readWholeFile(const std::string& path);

/// Writes a file of these bytes (see io/output_set.h for writes that cannot damage an old file).
/// @throw Error Io (cannot be created, disk full)
void writeWholeFile(const std::string& path, const std::string& content);

}  // namespace vdbsynth
