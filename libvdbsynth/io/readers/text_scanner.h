#pragma once
#include "libvdbsynth/base/number_text.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vdbsynth {

/// Reads the whole of `word` as a number, as parseAnyReal and in the spellings that other programs print:
/// 1.#QNAN and 1.#INF (old C libraries, as nan), exponents with D (Fortran).
/// @return false if it is not one; `value` then does not change
bool parseForeignReal(std::string_view word, double& value);

/// Iterates over the words and numbers of a text file in memory. Lines may end in LF, CR LF or CR; a mark of
/// UTF-8 at the beginning is skipped. Numbers are parsed without the locale; errors name the file and the
/// line.
class TextScanner {
public:
    /// Both are borrowed for the scanner's lifetime.
    /// @param start  where in the text to begin; lines are still counted from its beginning
    /// @throw Error BadData (UTF-16)
    TextScanner(const std::string& path, std::string_view text, char comment = '#', std::size_t start = 0);

    /// True at the end of the text (comments and white space skipped).
    bool atEnd();
    /// Next word on this or a later line, empty at the end.
    std::string_view word();
    /// Next word on this line, empty if the line has no more.
    std::string_view wordOnLine();
    void skipLine();
    /// @throw Error BadData (not a number, not finite, end of file)
    double real();
    /// As real, but nan and inf too, and in foreign spellings: for coordinates that nothing may use.
    double anyReal();
    std::int64_t whole();
    std::size_t position() const { return mAt; }
    std::size_t line() const;
    /// Lines from here on that have a word. @par Cost O(text)
    std::int64_t linesWithWords() const;
    /// @throw Error BadData "PATH:LINE: WHAT"; bytes of the file in it are made printable
    [[noreturn]] void fail(const std::string& what) const;

private:
    bool beginsComment(std::size_t at) const;
    bool endsLine(std::size_t at) const;
    void skipSpace(bool acrossLines);

    const std::string& mPath;
    std::string_view mText;
    std::size_t mAt = 0;
    char mComment;
};

}  // namespace vdbsynth
