#include "libvdbsynth/base/printable_text.h"

#include <cstddef>

namespace vdbsynth {
namespace {

// Bytes of the character that begins here: 0 if it is no printable one.
std::size_t characterLength(std::string_view text) {
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
    unsigned long code = first & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return 0;
        code = (code << 6) | (byte(i) & 0x3Fu);
    }
    // The control characters of Latin-1, overlong forms, halves of pairs, beyond the last character.
    static const unsigned long least[] = {0, 0, 0xA0, 0x800, 0x10000};
    if (code < least[length] || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF) return 0;
    return length;
}

}  // namespace

std::string printableText(std::string_view text, std::size_t most) {
    std::string out;
    const bool cut = text.size() > most;
    if (cut) {
        // Not within a character.
        while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;
        text = text.substr(0, most);
    }
    out.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = characterLength(text);
        const char first = text[0];
        if (length > 0)
            out.append(text.substr(0, length));
        else
            out += first == '\n' || first == '\r' || first == '\t' ? ' ' : '?';
        text.remove_prefix(length > 0 ? length : 1);
    }
    return cut ? out + "..." : out;
}

}  // namespace vdbsynth
