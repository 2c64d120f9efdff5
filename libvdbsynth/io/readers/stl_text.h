#pragma once
#include "libvdbsynth/io/readers/mesh_content.h"

#include <string>

namespace vdbsynth {

/// True if an STL file is of the ascii kind: its first word is "solid" or "facet" in any case, behind blanks,
/// empty lines or the mark of UTF-8, and what follows is text. A binary file may begin with "solid" too. Also
/// true for UTF-16, which readStlText refuses by name.
bool isStlText(const std::string& content);

/// Ascii STL as programs write it: keywords in any case, in one word or two ("end loop"), one or several
/// solids, lines or none, decimal commas, facets of up to 100 corners.
/// What is guessed or left out is a message.
/// @throw Error BadData
MeshContent readStlText(const std::string& path, const std::string& content, const RunContext& ctx = {});

}  // namespace vdbsynth
