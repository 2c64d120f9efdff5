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

/// The file that a name in another file means, beside or below that file's folder.
/// @param name     a relative path, percent-decoded
/// @param problem  set to what is wrong with a name that means no such file, as "is an address; ..."
std::string pathBelow(const std::string& folder, const std::string& name, std::string& problem);

/// True for an extension in lower case of any kind of file that is read, perhaps with .gz.
bool isKnownExtension(const std::string& extension);
/// The extension of the kind of file that begins so, for what tells it by its first bytes (or words); empty
/// for text that could be several.
std::string extensionOfContent(const std::string& start);

}  // namespace vdbsynth
