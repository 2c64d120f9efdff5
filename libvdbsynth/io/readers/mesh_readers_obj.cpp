// OBJ: vertices, texture coordinates and faces, as all kinds of programs write them. Free-form curves and
// surfaces are left out.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/joined_lines.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"
#include "libvdbsynth/io/readers/texture_seams.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace vdbsynth {
namespace {

std::string lowerCase(std::string_view word) {
    std::string lower(word.substr(0, 12));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

bool isOneOf(std::string_view word, std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// What a file holds that does not become part of the mesh.
struct LeftOut {
    std::size_t elements = 0, surfaces = 0, calls = 0, unknown = 0, weights = 0, extraNumbers = 0,
                textureCorners = 0;
};

class ObjReader {
public:
    ObjReader(const std::string& path, const std::string& text, std::size_t start, const RunContext& ctx)
        : mPath(path), mText(text), mScanner(path, text, '#', start), mContext(ctx) {}

    MeshContent read() {
        while (!mScanner.atEnd()) {
            readLine();
            mScanner.skipLine();
        }
        checkCorners();
        if (mMesh.polygons.sizes.empty()) refuse();
        addColours();
        addTexture();
        sayLeftOut();
        return std::move(mMesh);
    }

private:
    void readLine();
    void readVertex();
    void readTexture();
    void readFace();
    double readCoordinate();
    std::int64_t indexOf(std::string_view digits);
    std::uint32_t pointOf(std::int64_t index);
    std::int32_t textureOf(std::int64_t index) const;
    void checkCorners() const;
    [[noreturn]] void refuse() const;
    void addColours();
    void addTexture();
    void sayLeftOut() const;
    void say(MessageLevel level, std::size_t count, const std::string& what) const {
        if (count > 0) message(mContext, level, mPath + ": " + std::to_string(count) + " " + what);
    }
    [[noreturn]] void failAt(std::size_t position, const std::string& what) const {
        TextScanner(mPath, mText, '#', position).fail(what);
    }

    const std::string& mPath;
    const std::string& mText;
    TextScanner mScanner;
    const RunContext& mContext;
    MeshContent mMesh;
    std::vector<AttributeColumn> mColour{{"red", 0, {}}, {"green", 0, {}}, {"blue", 0, {}}};
    std::vector<float> mTexture;               // two of each vt
    std::vector<std::int32_t> mCornerTexture;  // as mMesh.polygons.corners
    // Corners that a later vertex may still satisfy, each larger than those before it, and their places.
    std::vector<std::pair<std::uint32_t, std::size_t>> mAhead;
    std::map<std::uint32_t, std::size_t> mUnfinite;  // vertices and their places
    LeftOut mLeftOut;
};

void ObjReader::readLine() {
    const std::string key = lowerCase(mScanner.word());
    if (key == "v")
        readVertex();
    else if (key == "vt")
        readTexture();
    else if (key == "f" || key == "fo")
        readFace();
    else if (key == "l" || key == "p")
        ++mLeftOut.elements;
    else if (isOneOf(key, {"curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp"}))
        ++mLeftOut.surfaces;
    else if (key == "call")
        ++mLeftOut.calls;
    else if (!isOneOf(key, {"vn",     "vp",     "g",        "o",        "s",    "mg",         "usemtl",
                            "mtllib", "usemap", "maplib",   "bevel",    "lod",  "shadow_obj", "trace_obj",
                            "deg",    "cstype", "c_interp", "d_interp", "bmat", "step",       "parm",
                            "trim",   "hole",   "scrv",     "sp",       "end",  "con",        "ctech",
                            "stech",  "res",    "csh"}))
        ++mLeftOut.unknown;
}

double ObjReader::readCoordinate() {
    double value = 0;
    const std::string_view word = mScanner.wordOnLine();
    if (word.empty()) mScanner.fail("a vertex has fewer than three coordinates");
    if (parseForeignReal(word, value)) return value;
    if (word.find(',') != std::string_view::npos)
        mScanner.fail(
            "a comma in a coordinate; OBJ files have decimal points, and blanks between numbers: export "
            "the file again with decimal points");
    mScanner.fail("a coordinate is not a number");
}

// Colours, which some programs append, count only if every line is "v x y z r g b".
void ObjReader::readVertex() {
    const std::size_t place = mScanner.position();
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = readCoordinate();
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(p[axis]) <= double(FLT_MAX)))
            mUnfinite.emplace_hint(mUnfinite.end(), std::uint32_t(mMesh.points.size()), place);
    mMesh.points.push_back(p);
    std::size_t extra = 0;
    float numbers[3] = {};
    for (std::string_view word = mScanner.wordOnLine(); !word.empty(); word = mScanner.wordOnLine(), ++extra)
        if (extra < 3 && parseAnyReal(word, numbers[extra])) mColour[extra].values.push_back(numbers[extra]);
    if (extra == 1) mLeftOut.weights += numbers[0] != 1;
    if (extra == 2 || extra > 3) ++mLeftOut.extraNumbers;
}

void ObjReader::readTexture() {
    for (int k = 0; k < 2; ++k) {
        const std::string_view word = mScanner.wordOnLine();
        float value = 0;
        if (!word.empty() && !parseAnyReal(word, value)) value = std::numeric_limits<float>::quiet_NaN();
        mTexture.push_back(value);
    }
}

// Corners are v, v/vt, v//vn or v/vt/vn, where slashes without a number behind them do no harm.
void ObjReader::readFace() {
    const std::size_t first = mMesh.polygons.corners.size();
    for (std::string_view word = mScanner.wordOnLine(); !word.empty(); word = mScanner.wordOnLine()) {
        std::int64_t parts[3] = {0, 0, 0};
        std::size_t part = 0;
        for (std::size_t begin = 0; begin <= word.size(); ++part) {
            const std::size_t end = std::min(word.find('/', begin), word.size());
            if (part == 3) mScanner.fail("a corner of a face has more than three numbers");
            if (end > begin) parts[part] = indexOf(word.substr(begin, end - begin));
            begin = end + 1;
        }
        mMesh.polygons.corners.push_back(pointOf(parts[0]));
        mCornerTexture.push_back(textureOf(parts[1]));
    }
    mMesh.polygons.sizes.push_back(std::uint32_t(mMesh.polygons.corners.size() - first));
}

std::int64_t ObjReader::indexOf(std::string_view digits) {
    long long index = 0;
    if (parseWhole(digits, index)) return index;
    // Some scripts write whole numbers as 1.0 or 1e+05.
    double real = 0;
    if (!parseReal(digits, real) || real != std::floor(real) || std::abs(real) > 1e15)
        mScanner.fail("a corner of a face is not a whole number, or numbers with slashes between them");
    return std::int64_t(real);
}

std::uint32_t ObjReader::pointOf(std::int64_t index) {
    const std::int64_t count = std::int64_t(mMesh.points.size());
    if (index == 0)
        mScanner.fail("line " + std::to_string(mScanner.line()) +
                      " has a face with vertex 0; vertices of OBJ files count from 1");
    if (index < -count)
        mScanner.fail("a face uses vertex " + std::to_string(index) + ", but only " + std::to_string(count) +
                      " are above it");
    const std::int64_t point = index > 0 ? index - 1 : count + index;
    if (point >= std::int64_t(0xffffffff)) mScanner.fail("a face uses vertex " + std::to_string(index));
    if (point >= count && (mAhead.empty() || point > std::int64_t(mAhead.back().first)))
        mAhead.push_back({std::uint32_t(point), mScanner.position()});
    return std::uint32_t(point);
}

// Whether there are coordinates of this number is known at the end only.
std::int32_t ObjReader::textureOf(std::int64_t index) const {
    const std::int64_t texture = index > 0 ? index - 1 : std::int64_t(mTexture.size() / 2) + index;
    if (index == 0) return kNoTexture;
    return texture < 0 || texture > std::numeric_limits<std::int32_t>::max()
               ? std::numeric_limits<std::int32_t>::max()
               : std::int32_t(texture);
}

void ObjReader::checkCorners() const {
    for (const auto& [point, place] : mAhead)
        if (point >= mMesh.points.size())
            failAt(place, "a face uses vertex " + std::to_string(point) + " of " +
                              std::to_string(mMesh.points.size()) + " (counting from 0)");
    if (mUnfinite.empty()) return;
    for (const std::uint32_t point : mMesh.polygons.corners) {
        const auto at = mUnfinite.find(point);
        if (at != mUnfinite.end()) failAt(at->second, "a coordinate is not a finite number");
    }
}

void ObjReader::refuse() const {
    if (mLeftOut.surfaces > 0)
        throw Error(ErrorCode::BadData,
                    mPath +
                        ": only free-form curves and surfaces (curv, surf), which are not "
                        "read; export it as polygons");
    if (mMesh.points.empty() && mLeftOut.unknown > 0)
        throw Error(ErrorCode::BadData, mPath + ": not an OBJ file: no line begins with v or f");
    std::string held;
    if (mLeftOut.elements > 0) held = ", only points and lines (p, l)";
    if (mLeftOut.elements == 0 && !mMesh.points.empty())
        held = ", only vertices; point clouds are read from .ply, .xyz or .pcd";
    throw Error(ErrorCode::EmptyInput,
                mPath + ": no faces" + held + "; a mesh with at least one face is needed");
}

void ObjReader::addColours() {
    std::size_t least = mMesh.points.size(), most = 0;
    for (const AttributeColumn& column : mColour) {
        least = std::min(least, column.values.size());
        most = std::max(most, column.values.size());
    }
    if (least == most && least == mMesh.points.size() && least > 0)
        mMesh.attributes = groupColumns(std::move(mColour));
    else
        say(MessageLevel::Note, least,
            "of " + std::to_string(mMesh.points.size()) + " vertices have colours; those are left out");
}

void ObjReader::addTexture() {
    for (std::int32_t& texture : mCornerTexture)
        if (texture != kNoTexture && std::size_t(texture) >= mTexture.size() / 2) {
            texture = kNoTexture;
            ++mLeftOut.textureCorners;
        }
    if (std::all_of(mCornerTexture.begin(), mCornerTexture.end(),
                    [](std::int32_t texture) { return texture == kNoTexture; }))
        return;
    if (!splitAtSeams(mMesh, mCornerTexture, mTexture))
        message(mContext, MessageLevel::Note,
                mPath + ": texture coordinates that are not finite numbers; all of them are left out");
}

void ObjReader::sayLeftOut() const {
    say(MessageLevel::Note, mLeftOut.elements,
        mLeftOut.elements == 1 ? "point or line (p, l) left out; only faces are read"
                               : "points and lines (p, l) left out; only faces are read");
    say(MessageLevel::Warning, mLeftOut.surfaces,
        "free-form curves and surfaces (curv, surf) left out; exporting them as polygons helps");
    say(MessageLevel::Warning, mLeftOut.calls, "other files (call) left out");
    say(MessageLevel::Note, mLeftOut.unknown, "lines that OBJ does not know left out");
    say(MessageLevel::Note, mLeftOut.weights, "weights of vertices (v x y z w) left out");
    say(MessageLevel::Note, mLeftOut.extraNumbers,
        "vertices with numbers that are neither a weight nor a colour; those are left out");
    say(MessageLevel::Note, mLeftOut.textureCorners,
        "corners with texture coordinates that the file lacks; those are left out");
}

}  // namespace

MeshContent readObj(const std::string& path, const std::string& text, const RunContext& ctx) {
    if (text.compare(0, 2, "\xff\xfe") == 0 || text.compare(0, 2, "\xfe\xff") == 0)
        throw Error(ErrorCode::BadData, path + ": UTF-16 text; save the file as UTF-8");
    const std::string content = joinedLines(text);
    const std::size_t start = content.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
    return ObjReader(path, content, start, ctx).read();
}

}  // namespace vdbsynth
