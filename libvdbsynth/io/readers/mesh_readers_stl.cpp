// STL. Binary: a header of 80 bytes, a count, records of 50 bytes. Counts and headers are often wrong, so the
// size of the file and what stands in the records decide.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/facet_soup.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/stl_text.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbsynth {
namespace {

constexpr std::uint64_t kHeader = 84, kRecord = 50;
constexpr std::uint32_t kUnknownCount = 0xFFFFFFFF;  // of writers that could not go back to fill it in

std::string triangles(std::uint64_t count) {
    return std::to_string(count) + " triangle" + (count == 1 ? "" : "s");
}

// A binary file: numbers at places, in the byte order that the file has.
class Binary {
public:
    explicit Binary(const std::string& content) : mContent(content), mBigEndian(false) {
        // Floats of the wrong order are mostly too small or too large for any model.
        const std::uint64_t sample = std::min<std::uint64_t>(room(), 1000);
        const std::uint64_t strangeLittle = strange(sample);
        mBigEndian = true;
        const bool fits = count() <= room();
        mBigEndian = fits && strangeLittle > 4 * strange(sample);
    }

    bool bigEndian() const { return mBigEndian; }
    std::uint32_t count(std::uint64_t block = 0) const { return word(block + 80); }
    /// Records that the file has room for.
    std::uint64_t room() const { return (mContent.size() - kHeader) / kRecord; }
    std::uint64_t bytesBehind(std::uint64_t records) const {
        return mContent.size() - kHeader - records * kRecord;
    }
    bool hasAttribute(std::uint64_t offset) const { return mContent[offset + 48] || mContent[offset + 49]; }

    void corners(std::uint64_t offset, Vec3f corner[3]) const {
        for (std::uint64_t i = 0; i < 9; ++i) {
            const std::uint32_t bits = word(offset + 12 + 4 * i);
            std::memcpy(&corner[i / 3][int(i % 3)], &bits, 4);
        }
    }

    // Of the first records, those that no model has.
    std::uint64_t strange(std::uint64_t records) const {
        std::uint64_t found = 0;
        for (std::uint64_t i = 0; i < records; ++i) found += looksLikeTriangle(i, 1e20f) ? 0 : 1;
        return found;
    }

    bool looksLikeTriangle(std::uint64_t record, float limit) const {
        Vec3f corner[3];
        corners(kHeader + record * kRecord, corner);
        bool anywhere = false;
        for (const Vec3f& p : corner)
            for (int axis = 0; axis < 3; ++axis) {
                const float size = std::abs(p[axis]);
                if (!(size <= limit) || (size > 0 && size < 1e-20f)) return false;
                anywhere = anywhere || size > 0;
            }
        return anywhere;
    }

private:
    std::uint32_t word(std::uint64_t at) const {
        unsigned char b[4];
        std::memcpy(b, mContent.data() + at, 4);
        if (mBigEndian) std::reverse(b, b + 4);
        return std::uint32_t(b[0]) | std::uint32_t(b[1]) << 8 | std::uint32_t(b[2]) << 16 |
               std::uint32_t(b[3]) << 24;
    }

    const std::string& mContent;
    bool mBigEndian;
};

// Where the headers of binary solids one after the other begin, if they fill the file; else the first alone.
std::vector<std::uint64_t> blocksOf(const Binary& file, std::uint64_t size) {
    std::vector<std::uint64_t> blocks;
    for (std::uint64_t at = 0; at + kHeader <= size && (at == 0 || file.count(at) > 0);) {
        blocks.push_back(at);
        at += kHeader + kRecord * file.count(at);
        if (at == size) return blocks;
    }
    return {0};
}

// True if the records behind those that the header claims are more of the same surface, and not other data.
bool continues(const Binary& file, std::uint64_t from, std::uint64_t to) {
    float largest = 0;
    Vec3f corner[3];
    for (std::uint64_t i = 0; i < from; ++i) {
        file.corners(kHeader + i * kRecord, corner);
        for (const Vec3f& p : corner)
            for (int axis = 0; axis < 3; ++axis)
                if (std::isfinite(p[axis])) largest = std::max(largest, std::abs(p[axis]));
    }
    const float limit = from > 0 ? 20 * largest : 1e20f;
    std::uint64_t other = 0;
    for (std::uint64_t i = from; i < to; ++i) other += file.looksLikeTriangle(i, limit) ? 0 : 1;
    return other <= (to - from) / 10;
}

void addBlock(const Binary& file, std::uint64_t block, std::uint64_t count, FacetSoup& soup,
              std::uint64_t& attributes) {
    Vec3f corner[3];
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t offset = block + kHeader + i * kRecord;
        file.corners(offset, corner);
        const Vec3d points[3] = {cast<double>(corner[0]), cast<double>(corner[1]), cast<double>(corner[2])};
        soup.add(corner, points, 3);
        attributes += file.hasAttribute(offset) ? 1 : 0;
    }
}

// How many records of the first solid to read, and what to say of it.
struct Extent {
    std::uint64_t records = 0;
    MessageLevel level = MessageLevel::Note;
    std::string note;
    bool mustClose = false;  // the header claims more: whole only if the surface is closed
};

Extent extentOf(const Binary& file, const std::string& path) {
    const std::uint64_t claimed = file.count(), room = file.room();
    const std::string claims = "the header claims " + triangles(claimed), fits = triangles(room);
    if ((claimed == 0 || claimed == kUnknownCount) && room > 0) {
        if (!continues(file, 0, room))
            throw Error(ErrorCode::BadData, path + ": " + claims + ", and the " +
                                                std::to_string(file.bytesBehind(0)) +
                                                " bytes behind it are not triangles");
        return {room, MessageLevel::Note,
                claims + ", the size of the file says " + fits + ", which are read"};
    }
    if (claimed > room)
        return {room, MessageLevel::Warning,
                claims + ", the file has " + fits +
                    ", which are read: they are a closed surface, so the count is wrong",
                true};
    if (claimed < room && continues(file, claimed, room))
        return {room, MessageLevel::Warning,
                claims + ", the size of the file says " + fits + ", which are read"};
    return {claimed, MessageLevel::Note, {}};
}

MeshContent readBinary(const std::string& path, const std::string& content, const RunContext& ctx) {
    const Binary file(content);
    FacetSoup soup;
    std::uint64_t attributes = 0;
    const auto say = [&](MessageLevel level, const std::string& text) {
        message(ctx, level, path + ": " + text);
    };
    if (file.bigEndian()) say(MessageLevel::Note, "its numbers are big-endian, against the format; read so");
    const std::vector<std::uint64_t> blocks = blocksOf(file, content.size());
    if (blocks.size() > 1) {
        say(MessageLevel::Note,
            std::to_string(blocks.size()) + " binary solids one after the other, all are read");
        for (const std::uint64_t block : blocks) addBlock(file, block, file.count(block), soup, attributes);
    } else {
        const Extent extent = extentOf(file, path);
        addBlock(file, 0, extent.records, soup, attributes);
        if (extent.mustClose && !soup.isClosed())
            throw Error(ErrorCode::BadData, path + ": truncated, or not an STL file: the header claims " +
                                                triangles(file.count()) + ", " + std::to_string(file.room()) +
                                                " of them are there");
        if (!extent.note.empty()) say(extent.level, extent.note);
        if (const std::uint64_t behind = file.bytesBehind(extent.records))
            say(MessageLevel::Note,
                countText(behind, "byte") + " behind the last of " + triangles(extent.records) + " left out");
    }
    if (attributes > 0)
        say(MessageLevel::Note,
            triangles(attributes) + " with attribute words, such as colours, which are not read");
    return soup.take(path, ctx);
}

}  // namespace

MeshContent readStl(const std::string& path, const std::string& content, const RunContext& ctx) {
    const bool hasHeader = content.size() >= kHeader;
    const bool fits = hasHeader && [&] {
        std::uint32_t count = 0;
        std::memcpy(&count, content.data() + 80, 4);
        return content.size() == kHeader + kRecord * count;
    }();
    if (!fits && isStlText(content)) return readStlText(path, content, ctx);
    const bool text = content.find('\0') == std::string::npos;
    if (!fits && text)
        throw Error(ErrorCode::BadData,
                    path + ": not an STL file: it is text that does not begin with solid");
    if (!hasHeader)
        throw Error(ErrorCode::BadData,
                    path + ": not an STL file, or truncated: " + std::to_string(content.size()) +
                        " bytes are fewer than a binary header's 84");
    return readBinary(path, content, ctx);
}

}  // namespace vdbsynth
