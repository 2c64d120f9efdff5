#pragma once
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth {

/// Counts the meanings of the metadata `vdbsynth:...` of a VDB file and its grids, except the source map's,
/// which count their own. It grows when a version writes entries that older ones would misread.
inline constexpr int kMetadataFormat = 1;
/// The file's entry that holds it. Files without the entry are of format 1.
inline constexpr const char* kMetadataFormatKey = "vdbsynth:format";

/// What to say of a file's metadata that this version may misread: a sentence to follow "PATH: "; empty where
/// they are of a format that it knows.
/// @param metadata  names and values of the file's own entries
/// @par Cost    O(entries)   @par Repeats yes
std::string unknownMetadata(const std::vector<std::pair<std::string, std::string>>& metadata);

}  // namespace vdbsynth
