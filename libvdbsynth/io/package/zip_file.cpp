#include "libvdbsynth/io/package/zip_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/gzip.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr std::size_t kEndSize = 22, kLocatorSize = 20, kEnd64Size = 56, kEntrySize = 46, kLocalSize = 30;
constexpr std::uint32_t kEndMark = 0x06054b50, kLocatorMark = 0x07064b50, kEnd64Mark = 0x06064b50,
                        kEntryMark = 0x02014b50, kLocalMark = 0x04034b50;
constexpr std::uint64_t kSeeWide = 0xffffffff;  // the value stands among the 64 bit ones

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": " + what);
}

// Little-endian; the caller has checked that they are there.
std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | std::uint8_t(bytes[at + i]);
    return value;
}

std::string lowered(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return result;
}

// The place of the directory's end, which a comment of up to 65535 bytes may follow.
std::size_t endOf(const std::string& path, std::string_view content) {
    const std::size_t least = content.size() < kEndSize + 65535 ? 0 : content.size() - kEndSize - 65535;
    if (content.size() >= kEndSize)
        for (std::size_t at = content.size() - kEndSize + 1; at-- > least;)
            if (number(content, at, 4) == kEndMark) return at;
    if (content.substr(0, 2) == "PK")
        refuse(path, "truncated: the directory at the end of its ZIP archive is missing");
    refuse(path, "is no ZIP archive");
}

// The 64 bit values of an entry: those whose short ones say so, in this order.
void readWide(const std::string& path, std::string_view extra, ZipFile::Entry& entry) {
    for (std::size_t at = 0; at + 4 <= extra.size();) {
        const std::uint64_t kind = number(extra, at, 2), size = number(extra, at + 2, 2);
        at += 4;
        if (at + size > extra.size()) return;
        if (kind == 1) {
            std::size_t next = at;
            for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.offset}) {
                if (*value != kSeeWide) continue;
                if (next + 8 > at + size) refuse(path, "its ZIP directory is corrupt");
                *value = number(extra, next, 8);
                next += 8;
            }
        }
        at += std::size_t(size);
    }
}

}  // namespace

ZipFile::ZipFile(const std::string& path, std::string_view content) : mPath(path), mContent(content) {
    const std::size_t end = endOf(path, content);
    std::uint64_t count = number(content, end + 10, 2), offset = number(content, end + 16, 4);
    if (number(content, end + 4, 2) != 0 && number(content, end + 4, 2) != 0xffff)
        refuse(path, "is one disk of a ZIP archive of several; only whole archives are read");
    if (end >= kLocatorSize && number(content, end - kLocatorSize, 4) == kLocatorMark) {
        const std::uint64_t at = number(content, end - kLocatorSize + 8, 8);
        if (at > content.size() || content.size() - at < kEnd64Size ||
            number(content, std::size_t(at), 4) != kEnd64Mark)
            refuse(path, "its ZIP directory is corrupt");
        count = number(content, std::size_t(at) + 32, 8);
        offset = number(content, std::size_t(at) + 48, 8);
    }
    readDirectory(offset, count);
}

void ZipFile::readDirectory(std::uint64_t offset, std::uint64_t count) {
    if (offset > mContent.size() || count > (mContent.size() - offset) / kEntrySize)
        refuse(mPath, "truncated: its ZIP directory claims more entries than the file can hold");
    std::size_t at = std::size_t(offset);
    std::uint64_t packed = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        if (mContent.size() - at < kEntrySize || number(mContent, at, 4) != kEntryMark)
            refuse(mPath, "its ZIP directory is corrupt");
        Entry entry;
        entry.flags = std::uint16_t(number(mContent, at + 8, 2));
        entry.method = std::uint16_t(number(mContent, at + 10, 2));
        entry.crc = std::uint32_t(number(mContent, at + 16, 4));
        entry.packed = number(mContent, at + 20, 4);
        entry.size = number(mContent, at + 24, 4);
        entry.offset = number(mContent, at + 42, 4);
        const std::size_t name = std::size_t(number(mContent, at + 28, 2)),
                          extra = std::size_t(number(mContent, at + 30, 2)),
                          comment = std::size_t(number(mContent, at + 32, 2));
        if (mContent.size() - at - kEntrySize < name + extra + comment)
            refuse(mPath, "its ZIP directory is corrupt");
        entry.name = mContent.substr(at + kEntrySize, name);
        entry.name.erase(0, std::min(entry.name.find_first_not_of('/'), entry.name.size()));
        readWide(mPath, mContent.substr(at + kEntrySize + name, extra), entry);
        at += kEntrySize + name + extra + comment;
        if (!mByName.emplace(lowered(entry.name), mEntries.size()).second)
            refuse(mPath, "its ZIP archive has two entries " + printableText(entry.name, 200));
        // Entries that share their bytes are how small archives unpack to huge ones.
        packed = entry.packed > mContent.size() ? entry.packed : packed + entry.packed;
        if (packed > mContent.size())
            refuse(mPath, "truncated, or its ZIP entries overlap: they claim more bytes than the file has");
        mEntries.push_back(std::move(entry));
    }
}

const ZipFile::Entry* ZipFile::find(std::string_view name) const {
    const auto found = mByName.find(lowered(name));
    return found == mByName.end() ? nullptr : &mEntries[found->second];
}

std::string ZipFile::read(const Entry& entry, const RunContext& ctx) const {
    const std::string name = mPath + " (" + printableText(entry.name, 200) + ")";
    if (entry.flags & 1) refuse(name, "is encrypted; save it without a password");
    if (entry.method != 0 && entry.method != 8)
        refuse(name, "is packed by method " + std::to_string(entry.method) +
                         " of ZIP; only stored and deflated entries are read");
    if (entry.offset > mContent.size() || mContent.size() - entry.offset < kLocalSize)
        refuse(name, "truncated: it begins behind the file's end");
    const std::size_t at = std::size_t(entry.offset);
    if (number(mContent, at, 4) != kLocalMark) refuse(name, "its place in the ZIP archive is wrong");
    const std::size_t begin = at + kLocalSize + std::size_t(number(mContent, at + 26, 2)) +
                              std::size_t(number(mContent, at + 28, 2));
    if (begin > mContent.size() || entry.packed > mContent.size() - begin)
        refuse(name, "truncated: it ends behind the file's end");
    const std::string_view packed = mContent.substr(begin, std::size_t(entry.packed));
    requireMemory(ctx, double(entry.size), name, "store a part of it");
    std::string bytes;
    if (entry.method == 8)
        bytes = inflateRaw(name, packed, std::size_t(entry.size));
    else if (entry.size == entry.packed)
        bytes = packed;
    else
        refuse(name, "is stored, with two different sizes");
    if (crc32Of(bytes) != entry.crc) refuse(name, "corrupt: its checksum is wrong");
    return bytes;
}

}  // namespace vdbsynth
