#pragma once
#include <string>

namespace vdbsynth::cli {

/// Text with &, <, > and quotes as HTML has them, for content and values of attributes.
std::string htmlText(const std::string& text);

/// Bytes as base64, for addresses that begin with data:.
std::string base64Text(const std::string& bytes);

}  // namespace vdbsynth::cli
