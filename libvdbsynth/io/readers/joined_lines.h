#pragma once
#include <string>

namespace vdbsynth {

/// The text of an OBJ file with LF at the end of every line, where it had CR, CR LF or CR CR LF, and without
/// lines that a backslash at their end (blanks may follow) continues: the next is joined to them, behind a
/// blank, and its line end is added behind the joined line, so that the following lines keep their numbers.
/// Comments and lines of names (as g, o, usemtl and mtllib) are not joined: there a backslash ends a
/// path of Windows.
/// @par Cost    O(text)   @par Repeats yes
std::string joinedLines(const std::string& text);

}  // namespace vdbsynth
