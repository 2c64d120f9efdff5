#pragma once
#include <string>
#include <vector>

namespace vdbsynth::cli::batch {

/// Files beside or below a model that its text may refer to: of .obj the .mtl files and their pictures, of
/// .gltf buffers and pictures. A word of the text counts if such a file exists, so more may be found than a
/// reader opens, which costs a run too many but never one too few. Packed models (.gz) are not looked into.
/// @return paths in order of their names; empty for other kinds of files and for text over 256 MB
/// @par Cost    O(bytes of the text)
std::vector<std::string> referredFiles(const std::string& path);

}  // namespace vdbsynth::cli::batch
