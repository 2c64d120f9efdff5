#pragma once
#include <string>

namespace vdbsynth {

/// Extension in lower case without its dot, empty if there is none.
std::string extensionOf(const std::string& path);
/// The same of a path to read, where .gz says nothing about the kind: "ply" of "a.ply.gz".
std::string readExtensionOf(const std::string& path);
/// Last part of a path.
std::string fileNameOf(const std::string& path);
/// Folder of a path, "." if it names none.
std::string folderOf(const std::string& path);

}  // namespace vdbsynth
