#pragma once
#include <string>

namespace vdbsynth {

/// True if bytes begin as a gzip file does.
bool isGzip(const std::string& content);

/// Unpacks a gzip file (zlib), all of its members. @param path  for messages
/// @throw Error BadData (truncated, corrupt, over 64 GB unpacked)
std::string gunzip(const std::string& path, const std::string& content);

}  // namespace vdbsynth
