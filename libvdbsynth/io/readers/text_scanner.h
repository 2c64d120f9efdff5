#pragma once
#include "libvdbsynth/base/number_text.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vdbsynth {

/// Iterates over the words and numbers of a text file in memory. Numbers are parsed without the locale;
/// errors name the file and the line.
class TextScanner {
public:
    /// Both are borrowed for the scanner's lifetime.
    /// @param start  where in the text to begin; lines are still counted from its beginning
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
    std::int64_t whole();
    std::size_t position() const { return mAt; }
    std::size_t line() const;
    /// @throw Error BadData "PATH:LINE: WHAT"
    [[noreturn]] void fail(const std::string& what) const;

private:
    void skipSpace(bool acrossLines);

    const std::string& mPath;
    std::string_view mText;
    std::size_t mAt = 0;
    char mComment;
};

}  // namespace vdbsynth
