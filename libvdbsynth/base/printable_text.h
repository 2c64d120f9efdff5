#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace vdbsynth {

/// Text of a file or a path as a message may show it: valid UTF-8 stays, line ends and tabs become a space,
/// every other control character and every byte that is no UTF-8 becomes '?'. A terminal is so safe from
/// escapes, and a log stays one line of text.
/// @param most  bytes of the text to show; "..." stands for the rest
/// @par Cost    O(bytes)   @par Repeats yes
std::string printableText(std::string_view text, std::size_t most = std::string_view::npos);

}  // namespace vdbsynth
