#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vdbsynth {

/// True if the bytes begin like a gzip file.
bool isGzip(const std::string& content);

/// Unpacks a gzip file (zlib), all of its members. @param path  for messages
/// @throw Error BadData (truncated, corrupt, over 64 GB unpacked)
std::string gunzip(const std::string& path, const std::string& content);

/// Unpacks one zlib stream to exactly `size` bytes. @throw Error BadData (corrupt, or another size)
std::string inflateZlib(const std::string& path, const std::string& content, std::size_t size);

/// Unpacks a stream of deflate without a header, as ZIP archives hold it, to exactly `size` bytes. A size
/// that `content` cannot hold is refused before memory is taken. @throw Error BadData (corrupt, or another
/// size)
std::string inflateRaw(const std::string& path, std::string_view content, std::size_t size);

/// Packs one piece of such a stream. Pieces are packed by themselves and joined in order; the last one ends
/// the stream. @par Repeats yes, for one version of zlib
std::string deflatePiece(std::string_view content, bool last);

/// The checksum of ZIP and gzip, and that of two pieces one after the other.
std::uint32_t crc32Of(std::string_view content);
std::uint32_t joinedCrc32(std::uint32_t first, std::uint32_t second, std::size_t secondSize);

}  // namespace vdbsynth
