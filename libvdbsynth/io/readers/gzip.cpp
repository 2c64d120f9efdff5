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
    Inflater() {
        if (inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK)
            throw Error(ErrorCode::Memory, "zlib: out of memory");
    }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

bool isGzip(const std::string& content) {
    return content.size() > 2 && content[0] == '\x1f' && content[1] == '\x8b';
}

std::string gunzip(const std::string& path, const std::string& content) {
    Inflater inflater;
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
    // zlib expands one byte to at most 1032.
    if (size / 1100 > content.size())
        throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
    std::string bytes(size, '\0');
    uLongf made = uLongf(size);
    const int state = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &made,
                                 reinterpret_cast<const Bytef*>(content.data()), uLong(content.size()));
    if (state != Z_OK || made != size)
        throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
    return bytes;
}

}  // namespace vdbsynth
