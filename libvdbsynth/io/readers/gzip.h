#pragma once
#include <string>

namespace vdbsynth {

/// True if the bytes begin like a gzip file.
bool isGzip(const std::string& content);

/// Unpacks a gzip file (zlib), all of its members. @param path  for messages
/// @throw Error BadData (truncated, corrupt, over 64 GB unpacked)
std::string gunzip(const std::string& path, const std::string& content);

/// Unpacks one zlib stream to exactly `size` bytes. @throw Error BadData (corrupt, or another size)
std::string inflateZlib(const std::string& path, const std::string& content, std::size_t size);

}  // namespace vdbsynth
