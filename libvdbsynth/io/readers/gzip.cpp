#include "libvdbsynth/io/readers/gzip.h"

#include "libvdbsynth/base/error.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kMost = 64000000000;

// A zlib stream that is ended on every exit.
struct Inflater {
    z_stream stream{};
    explicit Inflater(int windowBits) {
        if (inflateInit2(&stream, windowBits) != Z_OK) throw Error(ErrorCode::Memory, "zlib: out of memory");
    }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
};

// zlib expands one byte to at most 1032.
void requireCompressed(const std::string& path, std::size_t packed, std::size_t size) {
    if (size / 1100 > packed) throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
}

constexpr std::size_t kMostAtOnce = 1 << 30;  // zlib counts in 32 bits

}  // namespace

bool isGzip(const std::string& content) {
    return content.size() > 2 && content[0] == '\x1f' && content[1] == '\x8b';
}

std::string gunzip(const std::string& path, const std::string& content) {
    Inflater inflater(16 + MAX_WBITS);
    z_stream& stream = inflater.stream;
    std::string text;
    std::string buffer(1 << 18, '\0');
    std::size_t at = 0;
    int state = Z_OK;
    while (state != Z_STREAM_END || at < content.size()) {
        if (state == Z_STREAM_END) {
            // Another member, or padding from a disk or archive.
            if (content[at] != '\x1f') break;
            inflateReset(&stream);
        }
        const std::size_t chunk = std::min<std::size_t>(content.size() - at, 1 << 30);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data() + at));
        stream.avail_in = uInt(chunk);
        stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
        stream.avail_out = uInt(buffer.size());
        state = inflate(&stream, Z_NO_FLUSH);
        at += chunk - stream.avail_in;
        text.append(buffer.data(), buffer.size() - stream.avail_out);
        if (text.size() > kMost) throw Error(ErrorCode::BadData, path + ": unpacks to over 64 GB");
        if (state == Z_OK) continue;
        if (state == Z_BUF_ERROR) throw Error(ErrorCode::BadData, path + ": the gzip file is truncated");
        if (state != Z_STREAM_END) throw Error(ErrorCode::BadData, path + ": the gzip file is corrupt");
    }
    return text;
}

std::string inflateZlib(const std::string& path, const std::string& content, std::size_t size) {
    requireCompressed(path, content.size(), size);
    std::string bytes(size, '\0');
    uLongf made = uLongf(size);
    const int state = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &made,
                                 reinterpret_cast<const Bytef*>(content.data()), uLong(content.size()));
    if (state != Z_OK || made != size)
        throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
    return bytes;
}

std::string inflateRaw(const std::string& path, std::string_view content, std::size_t size) {
    requireCompressed(path, content.size(), size);
    Inflater inflater(-MAX_WBITS);
    z_stream& stream = inflater.stream;
    std::string bytes(size, '\0');
    std::size_t from = 0, to = 0;
    int state = Z_OK;
    while (state == Z_OK) {
        const std::size_t input = std::min(content.size() - from, kMostAtOnce),
                          room = std::min(size - to, kMostAtOnce);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data() + from));
        stream.avail_in = uInt(input);
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + to);
        stream.avail_out = uInt(room);
        // Without progress it says Z_BUF_ERROR.
        state = inflate(&stream, Z_NO_FLUSH);
        from += input - stream.avail_in;
        to += room - stream.avail_out;
    }
    if (state != Z_STREAM_END || to != size)
        throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
    return bytes;
}

std::string deflatePiece(std::string_view content, bool last) {
    // Of 1..9: text of numbers packs to 5 % less with 6, in over twice the time.
    constexpr int kLevel = 4, kMemory = 8;
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, -MAX_WBITS, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw Error(ErrorCode::Memory, "zlib: out of memory");
    // Room for the mark between pieces too.
    std::string packed(deflateBound(&stream, uLong(content.size())) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = uInt(content.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    const int state =
        content.size() > kMostAtOnce ? Z_STREAM_ERROR : deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
    packed.resize(packed.size() - stream.avail_out);
    deflateEnd(&stream);
    if (state != (last ? Z_STREAM_END : Z_OK)) throw Error(ErrorCode::Solver, "zlib cannot pack a piece");
    return packed;
}

std::uint32_t crc32Of(std::string_view content) {
    uLong sum = crc32(0, nullptr, 0);
    for (std::size_t at = 0; at < content.size(); at += kMostAtOnce)
        sum = crc32(sum, reinterpret_cast<const Bytef*>(content.data() + at),
                    uInt(std::min(content.size() - at, kMostAtOnce)));
    return std::uint32_t(sum);
}

std::uint32_t joinedCrc32(std::uint32_t first, std::uint32_t second, std::size_t secondSize) {
    return std::uint32_t(crc32_combine(first, second, z_off_t(secondSize)));
}

}  // namespace vdbsynth
