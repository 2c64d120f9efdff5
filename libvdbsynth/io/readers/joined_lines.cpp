#include "libvdbsynth/io/readers/joined_lines.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace vdbsynth {
namespace {

// Keywords that names follow.
constexpr const char* kNames[] = {"g", "o", "usemtl", "mtllib", "usemap", "maplib", "call"};

class LineJoiner {
public:
    explicit LineJoiner(const std::string& text) : mText(text) {}

    std::string joined() {
        mJoined.reserve(mText.size());
        for (std::size_t i = 0; i < mText.size();) {
            std::size_t end = lineEndAt(i);
            if (end > i) {
                mJoined.append(1 + mOwed, '\n');
                mOwed = 0;
                mWord.clear();
                mWordEnded = mComment = false;
                i = end;
                continue;
            }
            if (mText[i] == '\\' && (end = endBehindBlanks(i + 1)) > 0 && joins()) {
                mJoined += ' ';
                ++mOwed;
                mWordEnded = !mWord.empty();
                i = end;
                continue;
            }
            add(mText[i++]);
        }
        return std::move(mJoined);
    }

private:
    // Behind the line end that begins at `i`, or `i` if none does.
    std::size_t lineEndAt(std::size_t i) const {
        if (mText[i] == '\n') return i + 1;
        if (mText[i] != '\r') return i;
        if (mText.compare(i, 3, "\r\r\n") == 0) return i + 3;
        return mText.compare(i, 2, "\r\n") == 0 ? i + 2 : i + 1;
    }
    std::size_t endBehindBlanks(std::size_t i) const {
        while (i < mText.size() && (mText[i] == ' ' || mText[i] == '\t')) ++i;
        if (i == mText.size()) return i;
        const std::size_t end = lineEndAt(i);
        return end > i ? end : 0;
    }
    bool joins() const {
        return !mComment && std::find(std::begin(kNames), std::end(kNames), mWord) == std::end(kNames);
    }
    void add(char c) {
        mJoined += c;
        mComment = mComment || c == '#';
        if (c == ' ' || c == '\t')
            mWordEnded = mWordEnded || !mWord.empty();
        else if (!mWordEnded && mWord.size() < 8)
            mWord += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    }

    const std::string& mText;
    std::string mJoined;
    std::size_t mOwed = 0;
    std::string mWord;  // the first of the line
    bool mWordEnded = false, mComment = false;
};

}  // namespace

std::string joinedLines(const std::string& text) {
    return text.find_first_of("\r\\") == std::string::npos ? text : LineJoiner(text).joined();
}

}  // namespace vdbsynth
