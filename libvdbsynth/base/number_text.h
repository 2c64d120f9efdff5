#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace vdbsynth {

/// Numbers as text, for files, metadata and messages: the only functions that read and write them.
/// They ignore the locale of the host program (a decimal comma, a thousands separator) and
/// allocate nothing but the result.

/// Reads the whole of `word` as a number: digits, an optional sign (+ too), point and exponent, no white
/// space. A number too small for the type is 0.
/// @return false if it is not one, or not finite ("nan", "inf", 1e999); `value` then does not change
bool parseReal(std::string_view word, double& value);
bool parseReal(std::string_view word, float& value);

/// As parseReal, for columns in which a sample may be missing: "nan" and "inf" are numbers (any case), and
/// one too large for the type is infinite.
bool parseAnyReal(std::string_view word, double& value);
bool parseAnyReal(std::string_view word, float& value);

/// Reads the whole of `word` as a whole number in base 10, with an optional sign.
/// @return false if it is not one or does not fit the type; `value` then does not change
bool parseWhole(std::string_view word, int& value);
bool parseWhole(std::string_view word, long& value);
bool parseWhole(std::string_view word, long long& value);

/// The shortest decimal that reads back as the same number: 0.1, 1e+20, -0, nan, inf.
std::string exactText(double value);
std::string exactText(float value);

/// With `digits` significant digits (1 to 17), without zeros at the end, like printf's %.*g: for people.
std::string roundedText(double value, int digits);

/// How many of something, for messages: "1 point", "2 points".
std::string countText(std::size_t count, const std::string& what);

/// With `digits` (0 to 17) digits after the point, like printf's %.*f: for tables and measures.
std::string fixedText(double value, int digits);

}  // namespace vdbsynth
