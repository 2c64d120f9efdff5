#pragma once
#include <string>

namespace vdbsynth {

/// Extension in lower case without its dot, empty if there is none.
std::string extensionOf(const std::string& path);
/// The same for a path to read, without a .gz, which does not determine the kind: "ply" of "a.ply.gz".
std::string readExtensionOf(const std::string& path);
/// Last part of a path.
std::string fileNameOf(const std::string& path);
/// Folder of a path, "." if it names none.
std::string folderOf(const std::string& path);

/// The file that another file refers to by name, in or below that file's folder.
/// @param name     a relative path, percent-decoded
/// @param problem  set if the name refers to no such file, to a text such as "is an address; ..."
std::string pathBelow(const std::string& folder, const std::string& name, std::string& problem);

/// True for a lower-case extension of any kind of file that can be read, with or without .gz.
bool isKnownExtension(const std::string& extension);
/// The extension of the kind of file that begins with given bytes, if its first bytes (or words) determine
/// it; empty for text that could be of several kinds.
std::string extensionOfContent(const std::string& start);

}  // namespace vdbsynth
