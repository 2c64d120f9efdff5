#pragma once
#include "libvdbsynth/search/block_index_data.h"

#include <string>

namespace vdbsynth {

/// Name of the file that stores an index of this exemplar, mask and block: a content hash of all three and of
/// the format, so that a file is never mistaken for another's, and versions of the program share a folder.
/// @par Repeats same name for any number of threads
std::string blockIndexFileName(const BrickField& exemplar, const BrickField* mask, int block,
                               const RunContext& ctx);

/// Reads nodes, members and groups. The means are not in the file, since reading them takes as long as
/// computing them. `data` has its positions, exemplar and block already.
/// @return false if there is no such file
/// @throw Error BadData (truncated, damaged, of another version), Io (not readable); data is then unchanged
bool readBlockIndex(const std::string& path, BlockIndexData& data);

/// Writes the file for readBlockIndex; it appears complete or not at all.
/// @throw Error Io (no such folder, not writable, disk full)
void writeBlockIndex(const std::string& path, const BlockIndexData& data);

}  // namespace vdbsynth
