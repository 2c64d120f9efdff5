#include "libvdbsynth/io/readers/base64.h"

#include "libvdbsynth/base/error.h"

#include <cstdint>

namespace vdbsynth {

std::size_t decodeBase64(const std::string& path, std::string_view text, std::size_t at, std::size_t most,
                         std::string& bytes) {
    const std::size_t start = at;
    std::uint32_t bits = 0;
    int have = 0;
    for (; at < text.size() && bytes.size() < most; ++at) {
        const char c = text[at];
        int value = 0;
        if (c >= 'A' && c <= 'Z')
            value = c - 'A';
        else if (c >= 'a' && c <= 'z')
            value = c - 'a' + 26;
        else if (c >= '0' && c <= '9')
            value = c - '0' + 52;
        else if (c == '+' || c == '-')
            value = 62;
        else if (c == '/' || c == '_')
            value = 63;
        else if (c == '=' || c == ' ' || c == '\n' || c == '\r' || c == '\t')
            continue;
        else
            throw Error(ErrorCode::BadData, path + ": its base64 is invalid");
        bits = bits << 6 | std::uint32_t(value);
        have += 6;
        if (have < 8) continue;
        have -= 8;
        bytes += char(bits >> have & 255);
    }
    return at - start;
}

}  // namespace vdbsynth
