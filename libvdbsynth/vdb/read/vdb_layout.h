#pragma once
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace vdbsynth {

/// One grid of a VDB file, as the file's own list has it.
struct VdbEntry {
    std::string name;  ///< with the suffix that tells grids of one name apart
    std::string type;  ///< of its tree, for example "Tree_float_5_4_3"
};

/// Follows a VDB file's own list of its grids, and compares counts, lengths and positions with the file's
/// size: OpenVDB believes them all, takes memory for them and reads on beyond the end.
/// @param bytes  at the file's beginning; where it stands afterwards is undefined
/// @param size   of the file [bytes]
/// @return its grids; none for a file that was written to a pipe, whose list has no positions
/// @throw Error BadData "PATH: ..." (another version, cut off, a damaged list)
/// @par Cost  reads metadata and descriptions, no voxels
std::vector<VdbEntry> vdbLayout(const std::string& path, std::istream& bytes, std::uint64_t size);

}  // namespace vdbsynth
