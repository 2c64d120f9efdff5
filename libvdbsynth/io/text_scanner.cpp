#include "libvdbsynth/io/text_scanner.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vdbsynth {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

TextScanner::TextScanner(const std::string& path, std::string_view text, char comment, std::size_t start)
    : mPath(path), mText(text), mAt(start), mComment(comment) {}

void TextScanner::skipSpace(bool acrossLines) {
    while (mAt < mText.size()) {
        const char c = mText[mAt];
        if (c == mComment) {
            while (mAt < mText.size() && mText[mAt] != '\n') ++mAt;
        } else if (c == '\n') {
            if (!acrossLines) return;
            ++mAt;
        } else if (isBlank(c)) {
            ++mAt;
        } else {
            return;
        }
    }
}

bool TextScanner::atEnd() {
    skipSpace(true);
    return mAt >= mText.size();
}

std::string_view TextScanner::word() {
    skipSpace(true);
    return wordOnLine();
}

std::string_view TextScanner::wordOnLine() {
    skipSpace(false);
    const std::size_t begin = mAt;
    while (mAt < mText.size() && !isBlank(mText[mAt]) && mText[mAt] != '\n' && mText[mAt] != mComment) ++mAt;
    return mText.substr(begin, mAt - begin);
}

void TextScanner::skipLine() {
    while (mAt < mText.size() && mText[mAt] != '\n') ++mAt;
    if (mAt < mText.size()) ++mAt;
}

float TextScanner::real() {
    const std::string_view text = word();
    float value = 0;
    if (text.empty()) fail("the file ends where a number should be; it is truncated");
    if (!parseReal(text, value)) fail("\"" + std::string(text.substr(0, 40)) + "\" is not a number");
    if (!std::isfinite(value)) fail("a coordinate is not a finite number");
    return value;
}

std::int64_t TextScanner::whole() {
    const std::string_view text = word();
    std::int64_t value = 0;
    if (text.empty()) fail("the file ends where a whole number should be; it is truncated");
    if (!parseWhole(text, value)) fail("\"" + std::string(text.substr(0, 40)) + "\" is not a whole number");
    return value;
}

std::size_t TextScanner::line() const {
    return std::size_t(
               std::count(mText.begin(), mText.begin() + std::ptrdiff_t(std::min(mAt, mText.size())), '\n')) +
           1;
}

void TextScanner::fail(const std::string& what) const {
    throw Error(ErrorCode::BadData, mPath + ":" + std::to_string(line()) + ": " + what);
}

bool parseReal(std::string_view word, float& value) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range) {
        // Too small for a float is zero; too large stays an error of the caller (not finite).
        double wide = 0;
        const auto [wideEnd, wideError] = std::from_chars(word.data(), word.data() + word.size(), wide);
        value = wideError == std::errc() && std::abs(wide) < 1 ? 0.f : HUGE_VALF;
        return wideEnd == word.data() + word.size();
    }
    return error == std::errc() && end == word.data() + word.size();
}

bool parseWhole(std::string_view word, std::int64_t& value) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
}

void appendReal(std::string& text, float value) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    (void)error;  // 32 characters hold every float
    text.append(buffer, std::size_t(end - buffer));
}

}  // namespace vdbsynth
