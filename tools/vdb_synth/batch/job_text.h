#pragma once
#include <nlohmann/json.hpp>

#include <string>

namespace vdbsynth::cli::batch {

/// Keeps keys in the order of the file: matrices vary in that order.
using Json = nlohmann::ordered_json;

/// A job file as JSON: a .yaml or .yml file is YAML, every other one is JSON. Words of YAML that stand for
/// true, false or nothing (null, ~) become these; all others become strings, as "0.10" or "off" are values of
/// options as they stand.
/// @throw Error Io (missing, a directory, not readable), BadData (does not parse, with the line; a key twice
/// in one object; nested deeper than 64; more than a million values, as a few lines of YAML can stand for)
/// @par Cost    O(bytes)   @par Repeats yes
Json readJobText(const std::string& path);

/// The same from text. @param yaml  the text is YAML @param path  for errors
Json parseJobText(const std::string& path, const std::string& text, bool yaml);

/// Of YAML only. @throw Error BadData
Json parseYaml(const std::string& path, const std::string& text);

}  // namespace vdbsynth::cli::batch
