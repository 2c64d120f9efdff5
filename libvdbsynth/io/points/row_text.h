#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vdbsynth {

/// A word where a number should be, and its place among the numbers of its line, from 0.
struct RowWord {
    std::size_t place = 0;
    std::string_view text;
};

/// Iterates over the lines of a text of numbers, whatever program wrote it: words are separated by blanks,
/// tabs, commas, semicolons or pipes, and may be in double quotes; lines end with LF, CR LF or CR; a byte
/// order mark is skipped. Nothing between two separators other than blanks is a missing number (NaN), as are
/// nan, NA, null and words of that meaning.
class RowText {
public:
    /// @param path, content  borrowed for the lifetime of this
    /// @param start  where in the content the rows begin; lines are counted from its beginning
    /// @throw Error BadData (UTF-16, binary content)
    RowText(const std::string& path, const std::string& content, std::size_t start = 0);

    /// To the next line that is not blank. @return false at the end
    bool next();
    /// The present line, without blanks and line end around it.
    std::string_view line() const { return {mBegin, std::size_t(mEnd - mBegin)}; }
    /// True if the present line begins with a comment sign: # // % !
    bool isComment() const;
    /// True if the first word of the present line is a number, or a missing one.
    bool beginsWithNumber() const;
    /// True if the text ends in the present line, without a line end.
    bool isCutOff() const { return mNext == mTextEnd && mTextEnd > mText && mTextEnd[-1] != '\n'; }
    /// True if the present line ends with a comma, semicolon or pipe.
    bool endsWithSeparator() const;

    /// Decides whether commas from the present line on are decimal: if every line with a comma (of the first
    /// 64) consists of three or more words, separated otherwise, with at most one comma each, between digits.
    bool findDecimalCommas();
    /// As found by findDecimalCommas.
    bool decimalCommas() const { return mDecimalCommas; }

    /// Appends the numbers of the present line, up to a #. A word that is no number becomes NaN, and is
    /// appended to `words`.
    void numbers(std::vector<double>& values, std::vector<RowWord>& words) const;
    /// Appends the words of the present line, up to a #; their characters are the text's own.
    void words(std::vector<std::string_view>& words) const;
    /// The words of the present line without quotes, for names of columns: separated by semicolons, tabs,
    /// pipes or commas if there are any, else by blanks.
    std::vector<std::string> names() const;

    /// Number of the present line, from 1, or of the one at a position. Costs O(text): for messages.
    std::size_t lineNumber() const { return lineNumberAt(position()); }
    std::size_t lineNumberAt(std::size_t position) const;
    /// Bytes before the present line.
    std::size_t position() const { return std::size_t(mBegin - mText); }
    /// Bytes from the present line to the end.
    std::size_t bytesLeft() const { return std::size_t(mTextEnd - mBegin); }
    /// @throw Error BadData "PATH:LINE: WHAT"
    [[noreturn]] void fail(const std::string& what) const;

private:
    const char* numberEnd(const char* at, double& value) const;
    bool endsWord(char c) const;
    const char* wordEnd(const char* at) const;
    bool hasDecimalCommas() const;

    const std::string& mPath;
    std::string mCopy;  // of a text with line ends that are CR alone
    const char *mText = nullptr, *mTextEnd = nullptr;
    const char *mBegin = nullptr, *mEnd = nullptr, *mNext = nullptr;
    bool mDecimalCommas = false;
};

/// Reads a word as numbers are written anywhere: as parseAnyReal, also with an exponent of D (Fortran), and
/// missing numbers (NA, N/A, null, none, -, 1.#QNAN, nan(ind)) as NaN.
/// @param decimalComma  a comma is the decimal point; a point is then none
bool parseLenient(std::string_view word, bool decimalComma, double& value);

/// A word of a file for a message: at most 40 bytes, in quotes, those that are not printable ASCII as '?'.
std::string shownWord(std::string_view word);

}  // namespace vdbsynth
