#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace vdbsynth {
namespace {

/// from_chars accepts no plus; "+-1" stays invalid.
std::string_view withoutPlus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

/// Power of ten of the first significant digit of a word that from_chars accepted: distinguishes a number
/// that is too small from one that is too large, which from_chars does not.
long long magnitude(std::string_view word) {
    const std::size_t mark = std::min(word.find_first_of("eE"), word.size());
    const std::string_view digits = word.substr(0, mark);
    const std::size_t point = std::min(digits.find('.'), digits.size());
    const std::size_t first = std::min(digits.find_first_of("123456789"), digits.size());
    long long exponent = 0;
    if (mark < word.size()) {
        const std::string_view power = withoutPlus(word.substr(mark + 1));
        // An exponent beyond long long exceeds what any digits in memory could balance.
        constexpr long long kFar = 1LL << 60;
        if (!parseWhole(power, exponent)) exponent = power[0] == '-' ? -kFar : kFar;
        exponent = std::clamp(exponent, -kFar, kFar);
    }
    return exponent + static_cast<long long>(point) - static_cast<long long>(first);
}

template <typename Real>
bool parseAny(std::string_view word, Real& value) {
    word = withoutPlus(word);
    Real read = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), read);
    if (error == std::errc::invalid_argument || end != word.data() + word.size()) return false;
    if (error == std::errc::result_out_of_range) {
        const Real size = magnitude(word) > 0 ? std::numeric_limits<Real>::infinity() : Real(0);
        read = word[0] == '-' ? -size : size;
    }
    value = read;
    return true;
}

template <typename Real>
bool parseFinite(std::string_view word, Real& value) {
    Real read = 0;
    if (!parseAny(word, read) || !std::isfinite(read)) return false;
    value = read;
    return true;
}

template <typename Integer>
bool parseInteger(std::string_view word, Integer& value) {
    word = withoutPlus(word);
    Integer read = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), read);
    if (error != std::errc() || end != word.data() + word.size()) return false;
    value = read;
    return true;
}

template <typename Real, typename... Format>
std::string text(Real value, Format... format) {
    char buffer[384];  // -1.8e308 with 17 digits after the point has 328 characters
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, format...);
    return error == std::errc() ? std::string(buffer, end) : std::string();
}

}  // namespace

bool parseReal(std::string_view word, double& value) {
    return parseFinite(word, value);
}

bool parseReal(std::string_view word, float& value) {
    return parseFinite(word, value);
}

bool parseAnyReal(std::string_view word, double& value) {
    return parseAny(word, value);
}

bool parseAnyReal(std::string_view word, float& value) {
    return parseAny(word, value);
}

bool parseWhole(std::string_view word, int& value) {
    return parseInteger(word, value);
}

bool parseWhole(std::string_view word, long& value) {
    return parseInteger(word, value);
}

bool parseWhole(std::string_view word, long long& value) {
    return parseInteger(word, value);
}

std::string exactText(double value) {
    return text(value);
}

std::string exactText(float value) {
    return text(value);
}

std::string roundedText(double value, int digits) {
    return text(value, std::chars_format::general, std::clamp(digits, 1, 17));
}

std::string fixedText(double value, int digits) {
    return text(value, std::chars_format::fixed, std::clamp(digits, 0, 17));
}

std::string countText(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace vdbsynth
