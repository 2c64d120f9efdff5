#include "libvdbsynth/io/readers/text_scanner.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool isLineEnd(char c) {
    return c == '\n' || c == '\r';
}

}  // namespace

bool parseForeignReal(std::string_view word, double& value) {
    if (parseAnyReal(word, value)) return true;
    const std::size_t hash = word.find(".#");
    if (hash != std::string_view::npos && hash > 0 && word[hash - 1] == '1') {
        value = std::numeric_limits<double>::quiet_NaN();
        return true;
    }
    const std::size_t mark = word.find_first_of("dD");
    if (mark == std::string_view::npos || mark == 0) return false;
    std::string exponent(word);
    exponent[mark] = 'e';
    return parseAnyReal(exponent, value);
}

TextScanner::TextScanner(const std::string& path, std::string_view text, char comment, std::size_t start)
    : mPath(path), mText(text), mAt(start), mComment(comment) {
    if (start > 0) return;
    if (mText.substr(0, 3) == "\xEF\xBB\xBF") mAt = 3;
    if (mText.substr(0, 2) == "\xFF\xFE" || mText.substr(0, 2) == "\xFE\xFF")
        fail("the text is UTF-16; save it as UTF-8 or plain ASCII");
}

// A CR before an LF is white space, any other one ends a line too (old Macintosh).
bool TextScanner::endsLine(std::size_t at) const {
    const char c = mText[at];
    return c == '\n' || (c == '\r' && (at + 1 >= mText.size() || mText[at + 1] != '\n'));
}

// Not the mark in 1.#QNAN and 1.#INF.
bool TextScanner::beginsComment(std::size_t at) const {
    if (mText[at] != mComment) return false;
    const bool number =
        mComment == '#' && at >= 2 && mText.substr(at - 2, 2) == "1." &&
        (mText.substr(at + 1, 1) == "Q" || mText.substr(at + 1, 1) == "S" || mText.substr(at + 1, 1) == "I");
    return !number;
}

void TextScanner::skipSpace(bool acrossLines) {
    while (mAt < mText.size()) {
        const char c = mText[mAt];
        if (beginsComment(mAt)) {
            while (mAt < mText.size() && !endsLine(mAt)) ++mAt;
        } else if (endsLine(mAt)) {
            if (!acrossLines) return;
            ++mAt;
        } else if (isBlank(c) || c == '\r') {
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
    while (mAt < mText.size() && !isBlank(mText[mAt]) && !isLineEnd(mText[mAt]) && !beginsComment(mAt)) ++mAt;
    return mText.substr(begin, mAt - begin);
}

void TextScanner::skipLine() {
    while (mAt < mText.size() && !endsLine(mAt)) ++mAt;
    if (mAt < mText.size()) ++mAt;
}

double TextScanner::real() {
    const double value = anyReal();
    if (!std::isfinite(value)) fail("a coordinate is not a finite number");
    return value;
}

double TextScanner::anyReal() {
    const std::string_view text = word();
    double value = 0;
    if (text.empty()) fail("the file ends where a number should be; it is truncated");
    if (!parseForeignReal(text, value)) fail("\"" + std::string(text.substr(0, 40)) + "\" is not a number");
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
    std::size_t line = 1;
    for (std::size_t at = 0; at < mAt && at < mText.size(); ++at) line += endsLine(at) ? 1 : 0;
    return line;
}

std::int64_t TextScanner::linesWithWords() const {
    TextScanner ahead = *this;
    std::int64_t lines = 0;
    for (; !ahead.atEnd(); ahead.skipLine()) ++lines;
    return lines;
}

void TextScanner::fail(const std::string& what) const {
    throw Error(ErrorCode::BadData, mPath + ":" + std::to_string(line()) + ": " + printableText(what));
}

}  // namespace vdbsynth
