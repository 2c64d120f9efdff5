#include "libvdbsynth/io/readers/text_scanner.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
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

double TextScanner::real() {
    const std::string_view text = word();
    double value = 0;
    if (text.empty()) fail("the file ends where a number should be; it is truncated");
    if (!parseAnyReal(text, value)) fail("\"" + std::string(text.substr(0, 40)) + "\" is not a number");
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

}  // namespace vdbsynth
