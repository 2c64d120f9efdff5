#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace vdbsynth {

/// 128 bits of content hash (XXH3) as 32 hexadecimal digits. Not cryptographic.
std::string contentHash(const void* data, std::size_t bytes);

/// Content hash of a file, read in pieces.
/// @throw Error Io (missing, a directory, not readable)
std::string fileHash(const std::string& path);

/// 64-bit hash, for tables.
std::uint64_t hash64(const void* data, std::size_t bytes, std::uint64_t seed = 0) noexcept;

}  // namespace vdbsynth
