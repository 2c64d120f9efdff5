// Archives of ZIP, written.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/package/zip_file.h"
#include "libvdbsynth/io/readers/gzip.h"

namespace vdbsynth {
namespace {

constexpr std::uint64_t kMostBytes = 0xfffffffe;

void put(std::string& bytes, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes += char(value >> 8 * i & 0xff);
}

// What the entry and the directory say alike.
std::string described(std::uint32_t crc, std::size_t packed, std::size_t size, const std::string& name) {
    std::string bytes;
    put(bytes, 20, 2);  // version that can read it
    put(bytes, 0, 2);
    put(bytes, 8, 2);     // deflated
    put(bytes, 0, 2);     // midnight
    put(bytes, 0x21, 2);  // 1980-01-01, the first date there is
    put(bytes, crc, 4);
    put(bytes, packed, 4);
    put(bytes, size, 4);
    put(bytes, name.size(), 2);
    put(bytes, 0, 2);
    return bytes;
}

}  // namespace

void ZipWriter::add(const std::string& name, std::size_t pieces,
                    const std::function<std::string(std::size_t)>& piece) {
    struct Packed {
        std::string bytes;
        std::size_t size = 0;
        std::uint32_t crc = 0;
    };
    std::vector<Packed> packed(pieces);
    parallelFor({}, pieces, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::string text = piece(i);
            packed[i] = {deflatePiece(text, i + 1 == pieces), text.size(), crc32Of(text)};
        }
    });
    std::size_t bytes = 0, size = 0;
    std::uint32_t crc = 0;
    for (const Packed& part : packed) {
        bytes += part.bytes.size();
        size += part.size;
        crc = joinedCrc32(crc, part.crc, part.size);
    }
    if (size > kMostBytes || mBytes.size() + mDirectory.size() + bytes > kMostBytes - 1000000)
        throw Error(ErrorCode::Unusable, name + ": over 4 GB, the most that a part of a package may hold");
    const std::size_t offset = mBytes.size();
    const std::string description = described(crc, bytes, size, name);
    put(mBytes, 0x04034b50, 4);
    mBytes += description + name;
    mBytes.reserve(mBytes.size() + bytes);
    for (Packed& part : packed) {
        mBytes += part.bytes;
        part.bytes = {};
    }
    put(mDirectory, 0x02014b50, 4);
    put(mDirectory, 20, 2);
    mDirectory += description;
    put(mDirectory, 0, 10);  // no comment, first disk, no attributes
    put(mDirectory, offset, 4);
    mDirectory += name;
    ++mCount;
}

void ZipWriter::add(const std::string& name, const std::string& text) {
    add(name, 1, [&](std::size_t) { return text; });
}

std::string ZipWriter::finish() {
    std::string bytes = std::move(mBytes);
    const std::size_t offset = bytes.size();
    bytes += mDirectory;
    put(bytes, 0x06054b50, 4);
    put(bytes, 0, 4);
    put(bytes, mCount, 2);
    put(bytes, mCount, 2);
    put(bytes, mDirectory.size(), 4);
    put(bytes, offset, 4);
    put(bytes, 0, 2);
    mBytes.clear();
    mDirectory.clear();
    mCount = 0;
    return bytes;
}

}  // namespace vdbsynth
