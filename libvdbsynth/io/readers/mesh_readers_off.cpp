// OFF and its variants with extra numbers per vertex (NOFF, COFF, STOFF, CNOFF): ascii only.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// What the first word says, and where the counts begin.
struct Keyword {
    std::string prefix;  // of [ST][C][N][4][n]OFF
    std::size_t end = 0;
    bool absent = false;
};

std::string upperCase(std::string_view word) {
    std::string upper(word);
    for (char& c : upper)
        if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    return upper;
}

// Some files have no keyword, and in some the first count is glued to it.
Keyword readKeyword(TextScanner scanner) {
    const std::string_view word = scanner.word();
    const std::size_t begin = scanner.position() - word.size();
    const std::string upper = upperCase(word.substr(0, 16));
    const std::size_t at = upper.find("OFF");
    std::int64_t count = 0;
    if (at == std::string::npos && parseWhole(word, count)) return {"", begin, true};
    const std::string rest = at == std::string::npos ? "" : upper.substr(at + 3);
    if (at == std::string::npos || at > 5 ||
        upper.substr(0, at).find_first_not_of("STCN4") != std::string::npos ||
        rest.find_first_not_of("0123456789") != std::string::npos)
        scanner.fail("not an OFF file: it must begin with OFF");
    // In a word of capitals, a small n is another thing than N.
    std::string prefix = upper.substr(0, at);
    if (at > 0 && word[at - 1] == 'n') prefix.back() = 'n';
    return {prefix, begin + at + 3, false};
}

// Vertices, faces, and edges, which may be absent and are never needed.
struct Counts {
    std::int64_t vertices = 0, faces = 0;
};

Counts readCounts(const std::string& path, const std::string& content, TextScanner& scanner) {
    Counts counts{scanner.whole(), scanner.whole()};
    if (scanner.wordOnLine().empty()) {
        // A line with one number is the edges, one with more is the first vertex.
        TextScanner ahead = scanner;
        ahead.word();
        if (ahead.wordOnLine().empty() && counts.vertices > 0) scanner.word();
    }
    // Every vertex takes at least six characters and every face four.
    if (counts.vertices < 0 || counts.faces < 0 || counts.vertices > std::int64_t(content.size() / 6 + 1) ||
        counts.faces > std::int64_t(content.size() / 4 + 1))
        throw Error(ErrorCode::BadData,
                    path + ": the header claims " + std::to_string(counts.vertices) + " vertices and " +
                        std::to_string(counts.faces) +
                        " faces, more than the file can hold; it is truncated or corrupt");
    return counts;
}

class Body {
public:
    Body(const std::string& path, const std::string& content, const Keyword& keyword)
        : mScanner(path, content, '#', keyword.end),
          mNormals(keyword.prefix.find('N') != std::string::npos),
          mColours(keyword.prefix.find('C') != std::string::npos) {
        refuseOthers(keyword);
        mCounts = readCounts(path, content, mScanner);
        mScanner.atEnd();
        mByLine = !isRunTogether() || mColours || mNormals || keyword.prefix.find('T') != std::string::npos;
        mExpected = !keyword.prefix.empty();
    }

    void readVertices(MeshContent& mesh) {
        std::vector<AttributeColumn> colour;
        if (mColours) colour = {{"red", 0, {}}, {"green", 0, {}}, {"blue", 0, {}}};
        mesh.points.reserve(std::size_t(mCounts.vertices));
        for (std::int64_t i = 0; i < mCounts.vertices; ++i) {
            Vec3d p;
            for (int axis = 0; axis < 3; ++axis) p[axis] = mScanner.anyReal();
            mesh.points.push_back(p);
            if (!mByLine) continue;
            for (int k = 0; k < (mNormals ? 3 : 0); ++k) mScanner.wordOnLine();
            for (AttributeColumn& column : colour) readColour(column);
            // Opacity and texture coordinates are what the keyword lets expect.
            if (!mExpected && !mScanner.wordOnLine().empty()) ++mLongVertices;
            mScanner.skipLine();
        }
        keepColours(std::move(colour), mesh);
    }

    void readFaces(MeshContent& mesh) {
        std::vector<std::uint32_t> corners;
        for (std::int64_t i = 0; i < mCounts.faces; ++i) {
            if (mScanner.atEnd())
                mScanner.fail("truncated: " + std::to_string(i) + " of " + std::to_string(mCounts.faces) +
                              " faces are there");
            const std::int64_t count = mScanner.whole();
            if (count < 1 || count > mCounts.vertices)
                mScanner.fail("a face of " + std::to_string(count) + " corners");
            corners.clear();
            for (std::int64_t c = 0; c < count; ++c) {
                const std::int64_t index = mScanner.whole();
                if (index < 0 || index >= mCounts.vertices)
                    mScanner.fail("vertex " + std::to_string(index) + " of " +
                                  std::to_string(mCounts.vertices) + " does not exist (counting from 0)");
                corners.push_back(std::uint32_t(index));
            }
            mesh.polygons.add(corners.data(), corners.size());
            if (!mByLine) continue;
            if (!mScanner.wordOnLine().empty()) ++mLongFaces;
            mScanner.skipLine();
        }
    }

    void report(const std::string& path, const RunContext& ctx) {
        if (mLongVertices > 0)
            message(ctx, MessageLevel::Note,
                    path + ": numbers behind x y z of " + std::to_string(mLongVertices) +
                        " vertices are not read; colours need a file that begins with COFF");
        if (mLongFaces > 0)
            message(ctx, MessageLevel::Note,
                    path + ": colours of " + std::to_string(mLongFaces) + " faces are not read");
        if (!mScanner.atEnd())
            message(ctx, MessageLevel::Warning,
                    path + ": what stands behind the last of " +
                        countText(std::size_t(mCounts.faces), "face") + ", from line " +
                        std::to_string(mScanner.line()) + " on, is not read");
    }

private:
    // Usually every vertex and face stands on its own line, with other numbers behind it. A file of fewer
    // lines is truncated, unless its first line is more than a vertex.
    bool isRunTogether() const {
        TextScanner ahead = mScanner;
        for (int axis = 0; axis < 3; ++axis) ahead.word();
        if (ahead.wordOnLine().empty()) return false;
        return mScanner.linesWithWords() < mCounts.vertices + mCounts.faces;
    }

    void refuseOthers(const Keyword& keyword) {
        if (keyword.prefix.find('4') != std::string::npos)
            mScanner.fail("4-dimensional OFF is not supported; convert it to OFF");
        TextScanner ahead = mScanner;
        if (upperCase(ahead.wordOnLine()) == "BINARY")
            mScanner.fail("binary OFF is not supported; convert it to ascii OFF or ply");
        if (keyword.prefix.find('n') == std::string::npos) return;
        const std::int64_t dimension = mScanner.whole();
        if (dimension != 3)
            mScanner.fail(std::to_string(dimension) + "-dimensional OFF is not supported; convert it to OFF");
    }

    // One component of a colour; `white` becomes 1 if it is not an integer.
    void readColour(AttributeColumn& column) {
        const std::string_view word = mScanner.wordOnLine();
        float value = 0;
        if (!parseAnyReal(word, value)) return;
        if (word.find('.') != std::string_view::npos) column.white = 1;
        column.values.push_back(value);
    }

    static void keepColours(std::vector<AttributeColumn> colour, MeshContent& mesh) {
        // Integers range to 255, even if none is over 1.
        bool coloured = !colour.empty() && !mesh.points.empty(), real = false;
        for (const AttributeColumn& column : colour) {
            coloured = coloured && column.values.size() == mesh.points.size();
            real = real || column.white == 1;
        }
        for (AttributeColumn& column : colour) column.white = real ? 0 : 255;
        if (coloured) mesh.attributes = groupColumns(std::move(colour));
    }

    TextScanner mScanner;
    bool mNormals, mColours;
    Counts mCounts;
    bool mByLine = true, mExpected = false;
    std::int64_t mLongVertices = 0, mLongFaces = 0;
};

}  // namespace

MeshContent readOff(const std::string& path, const std::string& content, const RunContext& ctx) {
    const Keyword keyword = readKeyword(TextScanner(path, content));
    if (keyword.absent)
        message(ctx, MessageLevel::Note, path + ": does not begin with OFF; read as OFF without its keyword");
    Body body(path, content, keyword);
    MeshContent mesh;
    body.readVertices(mesh);
    body.readFaces(mesh);
    body.report(path, ctx);
    return mesh;
}

}  // namespace vdbsynth
