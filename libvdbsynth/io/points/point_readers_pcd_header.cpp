// The header of a .pcd, and its compression.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/points/point_readers_steps.h"
#include "libvdbsynth/io/points/row_text.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <set>

namespace vdbsynth {
namespace {

std::string withoutCase(std::string_view word, char first, char last) {
    std::string text(word);
    for (char& c : text)
        if (c >= first && c <= last) c = char(c ^ 0x20);
    return text;
}
std::string upper(std::string_view word) {
    return withoutCase(word, 'a', 'z');
}
std::string lower(std::string_view word) {
    return withoutCase(word, 'A', 'Z');
}

void readFieldLine(TextScanner& scanner, const std::string& key, std::vector<PcdField>& fields) {
    std::size_t i = 0;
    for (std::string_view word = scanner.wordOnLine(); !word.empty(); word = scanner.wordOnLine(), ++i) {
        if (key == "FIELDS") {
            fields.emplace_back();
            fields.back().name = std::string(word);
            continue;
        }
        if (i >= fields.size()) scanner.fail(key + " names more fields than FIELDS");
        std::int64_t number = 0;
        if (key == "TYPE") {
            fields[i].type = upper(word)[0];
            if (word.size() != 1 || std::string("FUI").find(fields[i].type) == std::string::npos)
                scanner.fail("TYPE " + shownWord(word) + " is unknown; F, U and I are read");
        } else if (!parseWhole(word, number) || number < 0 || number > 65536) {
            scanner.fail(key + " is not a list of small whole numbers");
        } else {
            (key == "SIZE" ? fields[i].size : fields[i].count) = number;
        }
    }
    if (key != "FIELDS" && i < fields.size())
        scanner.fail(key + " has " + std::to_string(i) + " entries for " + std::to_string(fields.size()) +
                     " fields");
}

void layOut(TextScanner& scanner, PcdHeader& header) {
    for (PcdField& field : header.fields) {
        const bool whole = field.size == 1 || field.size == 2;
        if (!whole && field.size != 4 && field.size != 8)
            scanner.fail("a field of " + std::to_string(field.size) + " bytes");
        if (whole && field.type == 'F' && header.data != "ascii")
            scanner.fail("a field of type F and " + std::to_string(field.size) +
                         " bytes; real numbers have 4 or 8");
        field.offset = header.rowBytes;
        header.rowBytes += field.size * field.count;
    }
    if (header.points < 0) header.points = header.grid;
    if (header.points < 0 || header.rowBytes <= 0) scanner.fail("the header has no points or no fields");
}

void sayDoubts(const std::string& path, const PcdHeader& header, const std::set<std::string>& keys,
               const RunContext& ctx) {
    if (header.grid >= 0 && header.grid != header.points)
        message(ctx, MessageLevel::Warning,
                path + ": WIDTH times HEIGHT is " + std::to_string(header.grid) + ", POINTS is " +
                    std::to_string(header.points) + ", which is read");
    std::string guessed;
    if (keys.count("TYPE") == 0) guessed = "type F";
    if (keys.count("SIZE") == 0) guessed += std::string(guessed.empty() ? "" : " and ") + "size 4";
    if (!guessed.empty() && header.data != "ascii")
        message(ctx, MessageLevel::Warning, path + ": its header lacks them, so fields have " + guessed);
}

}  // namespace

PcdHeader readPcdHeader(const std::string& path, const std::string& content, const RunContext& ctx) {
    TextScanner scanner(path, content, '#', content.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0);
    PcdHeader header;
    std::set<std::string> keys;
    std::int64_t width = -1, height = 1;
    while (!scanner.atEnd()) {
        const std::string_view word = scanner.wordOnLine();
        std::string key = upper(word);
        if (key == "COLUMNS") key = "FIELDS";  // up to version 0.6
        keys.insert(key);
        if (key == "FIELDS" || key == "SIZE" || key == "TYPE" || key == "COUNT")
            readFieldLine(scanner, key, header.fields);
        else if (key == "WIDTH")
            width = scanner.whole();
        else if (key == "HEIGHT")
            height = scanner.whole();
        else if (key == "POINTS")
            header.points = scanner.whole();
        else if (key == "DATA")
            header.data = lower(scanner.wordOnLine());
        else if (key != "VERSION" && key != "VIEWPOINT")
            scanner.fail(shownWord(word) + " is not a line of a PCD header");
        scanner.skipLine();
        if (key != "DATA") continue;
        header.bytes = scanner.position();
        if (width >= 0 && height >= 0 && height < (1 << 30) && width < (1 << 30))
            header.grid = width * height;
        layOut(scanner, header);
        sayDoubts(path, header, keys, ctx);
        return header;
    }
    scanner.fail("the header has no DATA; the file is truncated");
}

// A control byte under 32 is followed by that many and one literal bytes; else its upper three bits are
// the length and the rest, with the next byte, the distance of bytes to repeat.
std::string unpackLzf(const std::string& path, std::string_view packed, std::size_t size) {
    std::string out;
    out.reserve(size);
    std::size_t at = 0;
    const auto next = [&] {
        if (at >= packed.size()) throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
        return std::size_t(static_cast<unsigned char>(packed[at++]));
    };
    while (at < packed.size()) {
        const std::size_t control = next();
        if (control < 32) {
            const std::size_t count = control + 1;
            if (count > packed.size() - at)
                throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
            out.append(packed.substr(at, count));
            at += count;
        } else {
            std::size_t count = (control >> 5) + 2;
            if (count == 9) count += next();
            const std::size_t distance = ((control & 31) << 8) + next() + 1;
            if (distance > out.size())
                throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
            for (std::size_t i = 0; i < count; ++i) out += out[out.size() - distance];
        }
        if (out.size() > size) throw Error(ErrorCode::BadData, path + ": its compressed data is corrupt");
    }
    if (out.size() != size) throw Error(ErrorCode::BadData, path + ": its compressed data is truncated");
    return out;
}

}  // namespace vdbsynth
