#include "libvdbsynth/io/points/row_text.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace vdbsynth {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\x1a';
}
bool isSeparator(char c) {
    return c == ',' || c == ';' || c == '|';
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}
bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool isMissing(std::string_view word) {
    if (word.size() > 12) return false;
    std::string lower(word);
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if (!lower.empty() && (lower[0] == '-' || lower[0] == '+')) lower.erase(0, 1);
    for (const char* known : {"", "na", "n/a", "#n/a", "nan", "null", "none", "nil", "nan(ind)", "1.#qnan",
                              "1.#ind", "1.#snan", "1.#inf", "1.#qnan0", "1.#ind00", "1.#inf00"})
        if (lower == known) return true;
    return false;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

// A line end of old Macs: CR that no LF follows.
bool hasLoneReturn(std::string_view text) {
    std::size_t at = text.find('\r');
    while (at != std::string_view::npos && at + 1 < text.size() &&
           (text[at + 1] == '\n' || text[at + 1] == '\r'))
        at = text.find('\r', at + 1);
    return at != std::string_view::npos && at + 1 < text.size();
}

// At most one comma, and that between digits, as in "-1,5"; nothing else but what numbers consist of.
bool mayHaveDecimalComma(std::string_view word) {
    std::size_t commas = 0;
    for (std::size_t i = 0; i < word.size(); ++i) {
        if (word[i] != ',') continue;
        const bool between = i + 1 < word.size() && i > 0 && isDigit(word[i - 1]) && isDigit(word[i + 1]);
        if (!between) return false;
        ++commas;
    }
    double ignored = 0;
    return commas <= 1 && parseLenient(word, true, ignored);
}

}  // namespace

bool parseLenient(std::string_view word, bool decimalComma, double& value) {
    if (!decimalComma && parseAnyReal(word, value)) return true;
    if (word.size() > 1 && word.front() == '"' && word.back() == '"')
        word = trimmed(word.substr(1, word.size() - 2));
    if (isMissing(word)) {
        value = kMissing;
        return true;
    }
    if (word.size() > 400) return false;
    std::string plain(word);
    for (char& c : plain) {
        if (decimalComma && c == '.') return false;
        if (decimalComma && c == ',') c = '.';
        if (c == 'd' || c == 'D') c = 'e';
    }
    return parseAnyReal(plain, value);
}

std::string shownWord(std::string_view word) {
    std::string shown(word.substr(0, 40));
    for (char& c : shown)
        if (c < ' ' || c > '~') c = '?';
    return "\"" + shown + "\"";
}

RowText::RowText(const std::string& path, const std::string& content, std::size_t start) : mPath(path) {
    std::string_view text = content;
    if (text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff")
        throw Error(ErrorCode::BadData, path + ": is UTF-16 text; save it as UTF-8 or plain text");
    if (text.substr(0, 4) == "LASF")
        throw Error(ErrorCode::BadData, path +
                                            ": is a LAS file; save it as .ply or text, for example with "
                                            "CloudCompare or las2txt");
    if (start == 0 && text.substr(0, 3) == "\xef\xbb\xbf") start = 3;
    while (text.size() > start && text.back() == '\0') text.remove_suffix(1);
    if (text.substr(start, 65536).find('\0') != std::string_view::npos)
        throw Error(ErrorCode::BadData, path + ": is not text; rows of numbers are needed");
    if (hasLoneReturn(text)) {
        mCopy = std::string(text);
        for (std::size_t i = 0; i < mCopy.size(); ++i)
            if (mCopy[i] == '\r' && (i + 1 == mCopy.size() || mCopy[i + 1] != '\n')) mCopy[i] = '\n';
        text = mCopy;
    }
    mText = text.data();
    mTextEnd = mText + text.size();
    mNext = mBegin = mEnd = mText + std::min(start, text.size());
}

bool RowText::next() {
    while (mNext < mTextEnd) {
        const void* found = std::memchr(mNext, '\n', std::size_t(mTextEnd - mNext));
        mBegin = mNext;
        mEnd = found ? static_cast<const char*>(found) : mTextEnd;
        mNext = found ? mEnd + 1 : mTextEnd;
        while (mBegin < mEnd && isBlank(*mBegin)) ++mBegin;
        while (mEnd > mBegin && isBlank(mEnd[-1])) --mEnd;
        if (mBegin < mEnd) return true;
    }
    mBegin = mEnd = mTextEnd;
    return false;
}

bool RowText::isComment() const {
    const std::string_view text = line();
    return !text.empty() && (text[0] == '#' || text[0] == '%' || text[0] == '!' || text.substr(0, 2) == "//");
}

bool RowText::beginsWithNumber() const {
    const char* at = mBegin;
    while (at < mEnd && (isBlank(*at) || isSeparator(*at))) ++at;
    const char* end = wordEnd(at);
    double ignored = 0;
    const std::string_view word(at, std::size_t(end - at));
    return end > at && (parseLenient(word, false, ignored) || parseLenient(word, true, ignored));
}

bool RowText::endsWithSeparator() const {
    return mEnd > mBegin && isSeparator(mEnd[-1]);
}

bool RowText::endsWord(char c) const {
    return isBlank(c) || (isSeparator(c) && !(c == ',' && mDecimalCommas));
}

// A word in quotes may hold separators. A # ends a word, but for the 1.#QNAN of old Windows programs.
const char* RowText::wordEnd(const char* at) const {
    if (at < mEnd && *at == '"') {
        const void* quote = std::memchr(at + 1, '"', std::size_t(mEnd - at - 1));
        if (quote) return static_cast<const char*>(quote) + 1;
    }
    while (at < mEnd && !endsWord(*at) &&
           !(*at == '#' && !(at > mBegin && at[-1] == '.' && at + 1 < mEnd && isLetter(at[1]))))
        ++at;
    return at;
}

// The end of the number at this place, null if there is none.
const char* RowText::numberEnd(const char* at, double& value) const {
    if (!mDecimalCommas) {
        const auto [end, error] = std::from_chars(at, mEnd, value);
        if (error == std::errc() && (end == mEnd || endsWord(*end))) return end;
    }
    const char* last = wordEnd(at);
    return parseLenient({at, std::size_t(last - at)}, mDecimalCommas, value) ? last : nullptr;
}

void RowText::numbers(std::vector<double>& values, std::vector<RowWord>& words) const {
    const std::size_t first = values.size();
    bool missing = true;
    for (const char* at = mBegin; at < mEnd;) {
        if (isBlank(*at)) {
            ++at;
        } else if (endsWord(*at) || (*at == ',' && at > mBegin && at[-1] == '"')) {
            if (missing) values.push_back(kMissing);
            missing = true;
            ++at;
        } else if (*at == '#') {
            return;
        } else {
            double value = 0;
            const char* end = numberEnd(at, value);
            if (!end) {
                end = std::max(wordEnd(at), at + 1);
                words.push_back({values.size() - first, {at, std::size_t(end - at)}});
                value = kMissing;
            }
            values.push_back(value);
            at = end;
            missing = false;
        }
    }
}

bool RowText::hasDecimalCommas() const {
    std::size_t words = 0;
    // Between separators that are no commas other words may stand.
    const bool separated = line().find_first_of(";\t|") != std::string_view::npos;
    for (const char* at = mBegin; at < mEnd && *at != '#';) {
        if (endsWord(*at) || (*at == ',' && at > mBegin && at[-1] == '"')) {
            ++at;
            continue;
        }
        const char* end = wordEnd(at);
        const std::string_view word{at, std::size_t(end - at)};
        const bool plain = separated && word.find(',') == std::string_view::npos;
        if (!plain && !mayHaveDecimalComma(word)) return false;
        at = end;
        ++words;
    }
    return words >= 3;
}

bool RowText::findDecimalCommas() {
    const char *const begin = mBegin, *const end = mEnd, *const next = mNext;
    constexpr int kLines = 64;
    mDecimalCommas = true;  // commas belong to words while this looks
    int lines = 0;
    bool decimal = true;
    const void* comma = std::memchr(mBegin, ',', std::size_t(mTextEnd - mBegin));
    if (comma && comma >= mEnd) {  // to the line that has it
        mNext = static_cast<const char*>(comma);
        while (mNext > begin && mNext[-1] != '\n') --mNext;
        this->next();
    }
    while (comma && lines < kLines && decimal && mBegin < mTextEnd) {
        if (!isComment() && line().find(',') != std::string_view::npos) {
            decimal = hasDecimalCommas();
            ++lines;
        }
        if (!this->next()) break;
    }
    mBegin = begin, mEnd = end, mNext = next;
    return mDecimalCommas = decimal && lines > 0;
}

void RowText::words(std::vector<std::string_view>& words) const {
    for (const char* at = mBegin; at < mEnd && *at != '#';) {
        const char* end = endsWord(*at) ? at + 1 : wordEnd(at);
        if (!endsWord(*at)) words.emplace_back(at, std::size_t(end - at));
        at = end;
    }
}

std::vector<std::string> RowText::names() const {
    const std::string_view text = line();
    char separator = ' ';
    for (const char c : {';', '\t', '|', ','})
        if (separator == ' ' && text.find(c) != std::string_view::npos) separator = c;
    std::vector<std::string> names(1);
    bool quoted = false;
    for (const char c : text) {
        if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && (c == separator || (separator == ' ' && isBlank(c)))) {
            if (separator != ' ' || !names.back().empty()) names.emplace_back();
        } else {
            names.back() += c;
        }
    }
    for (std::string& name : names) name = std::string(trimmed(name));
    return names;
}

std::size_t RowText::lineNumberAt(std::size_t position) const {
    return std::size_t(std::count(mText, mText + position, '\n')) + 1;
}

void RowText::fail(const std::string& what) const {
    throw Error(ErrorCode::BadData, mPath + ":" + std::to_string(lineNumber()) + ": " + what);
}

}  // namespace vdbsynth
