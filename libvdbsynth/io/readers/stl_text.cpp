#include "libvdbsynth/io/readers/stl_text.h"

#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/io/readers/facet_soup.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kMostCorners = 100;

std::string lowerCase(std::string_view word) {
    std::string lower(word.substr(0, 16));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

bool isText(std::string_view bytes) {
    return bytes.find('\0') == std::string_view::npos;
}

// "facet normal", the words between which no name of a solid stands.
bool atFacet(TextScanner ahead) {
    return lowerCase(ahead.word()) == "facet" && lowerCase(ahead.word()) == "normal";
}

class Parser {
public:
    Parser(const std::string& path, const std::string& content) : mScanner(path, content, '\0') {}

    MeshContent run(const std::string& path, const RunContext& ctx) {
        while (!mScanner.atEnd()) readWord();
        if (mOpen || !mCorners.empty() || (!mEnded && mUnknownLast && !mSizes.empty()))
            mScanner.fail("the file ends in the middle, behind " + wholeFacets() + "; it is truncated");
        if (mSizes.empty() && mUnknown > 0) mScanner.fail(mFirstUnknown + " does not belong in an STL file");
        if (!mEnded && mSizes.empty()) mScanner.fail("the file ends without endsolid; it is truncated");
        report(path, ctx);
        FacetSoup soup;
        const LocalPoints local = localPoints(mPoints);
        std::size_t first = 0;
        for (const std::size_t size : mSizes) {
            soup.add(&local.points[first], &mPoints[first], size);
            first += size;
        }
        return soup.take(path, ctx);
    }

private:
    std::string wholeFacets() const { return std::to_string(mSizes.size()) + " whole facets"; }

    void report(const std::string& path, const RunContext& ctx) const {
        if (!mEnded)
            message(
                ctx, MessageLevel::Warning,
                path + ": ends without endsolid; its " + wholeFacets() + " are read, more may be missing");
        if (mCommas) message(ctx, MessageLevel::Note, path + ": decimal commas are read as decimal points");
        if (mUnknown > 0)
            message(ctx, MessageLevel::Note,
                    path + ": " + std::to_string(mUnknown) +
                        " words that do not belong in an STL file are not read, the first " + mFirstUnknown);
        if (mLarge > 0)
            message(ctx, MessageLevel::Note,
                    path + ": " + std::to_string(mLarge) + " facets of more than three vertices");
    }

    void readWord() {
        const std::string_view text = mScanner.word();
        std::string word = lowerCase(text);
        mUnknownLast = false;
        if (word == "end" || word == "outer") {
            TextScanner ahead = mScanner;
            const std::string second = lowerCase(ahead.word());
            if (second == "loop" || second == "facet" || second == "solid") {
                word += second;
                mScanner.word();
            }
        }
        if (word == "vertex") {
            readVertex();
        } else if (word == "solid" || word == "endsolid") {
            endFacet();
            mEnded = word == "endsolid";
            skipName();
        } else if (word == "facet") {
            endFacet();
            mOpen = mBeforeLoop = true;
        } else if (word == "endloop" || word == "endfacet") {
            endFacet();
        } else if (word == "outerloop" || word == "outer" || word == "loop") {
            mBeforeLoop = false;
        } else if (!mBeforeLoop) {  // behind "facet" stands its normal
            mUnknownLast = true;
            if (mUnknown++ == 0)
                mFirstUnknown = "\"" + printableText(text.substr(0, 40)) + "\" in line " +
                                std::to_string(mScanner.line());
        }
    }

    // Of a solid: the rest of the line, unless the whole file is one line.
    void skipName() {
        while (!atFacet(mScanner) && !mScanner.wordOnLine().empty()) {
        }
    }

    void readVertex() {
        mBeforeLoop = false;
        if (mCorners.size() == kMostCorners)
            mScanner.fail("a facet has more than " + std::to_string(kMostCorners) + " vertices");
        Vec3d p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = coordinate();
        mCorners.push_back(p);
    }

    // Not finite if no float can be.
    double coordinate() {
        std::string word(mScanner.word());
        if (word.empty())
            mScanner.fail("the file ends within a vertex, behind " + wholeFacets() + "; it is truncated");
        double value = 0;
        if (std::count(word.begin(), word.end(), ',') == 1 && word.find('.') == std::string::npos) {
            word[word.find(',')] = '.';
            mCommas = true;
        }
        if (!parseForeignReal(word, value)) mScanner.fail("\"" + word.substr(0, 40) + "\" is not a number");
        return std::abs(value) <= double(FLT_MAX) ? value : std::numeric_limits<double>::quiet_NaN();
    }

    void endFacet() {
        if (mCorners.size() < 3 && (mOpen || !mCorners.empty()))
            mScanner.fail("a facet has fewer than three vertices");
        if (!mCorners.empty()) {
            mPoints.insert(mPoints.end(), mCorners.begin(), mCorners.end());
            mSizes.push_back(mCorners.size());
            mLarge += mCorners.size() > 3 ? 1 : 0;
        }
        mCorners.clear();
        mOpen = mBeforeLoop = false;
    }

    TextScanner mScanner;
    std::vector<Vec3d> mPoints, mCorners;  // of all whole facets, of the present one
    std::vector<std::size_t> mSizes;
    bool mOpen = false;        // within a facet, before its end
    bool mBeforeLoop = false;  // between "facet" and its loop
    bool mEnded = false, mCommas = false;
    bool mUnknownLast = false;  // the last word may be one that was cut
    std::size_t mUnknown = 0, mLarge = 0;
    std::string mFirstUnknown;
};

}  // namespace

bool isStlText(const std::string& content) {
    const std::string path, start = content.substr(0, 4096);
    if (start.compare(0, 2, "\xFF\xFE") == 0 || start.compare(0, 2, "\xFE\xFF") == 0) return true;  // UTF-16
    TextScanner scanner(path, start, '\0');
    const std::string first = lowerCase(scanner.word());
    if (first != "solid" && first != "facet") return false;
    if (isText(start)) return true;
    // Some writers leave zero bytes behind the name.
    for (std::size_t at = 0; at < start.size(); ++at)
        if ((start[at] == 'f' || start[at] == 'F') && atFacet(TextScanner(path, start, '\0', at)))
            return true;
    return false;
}

MeshContent readStlText(const std::string& path, const std::string& content, const RunContext& ctx) {
    return Parser(path, content).run(path, ctx);
}

}  // namespace vdbsynth
