#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace vdbsynth {

/// Appends decoded base64 to `bytes`, from `at` to the end of the text, or until there are `most` bytes.
/// Padding and white space are skipped; "-" and "_" of addresses are "+" and "/".
/// @return the number of characters used
/// @throw Error BadData "PATH: its base64 is invalid"
std::size_t decodeBase64(const std::string& path, std::string_view text, std::size_t at, std::size_t most,
                         std::string& bytes);

}  // namespace vdbsynth
