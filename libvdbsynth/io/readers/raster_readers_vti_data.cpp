// The data of VTK's XML files: text, base64 or raw, compressed or not.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/base64.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/raster_readers_vti_steps.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vdbsynth {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": " + what);
}

// A block of binary data as stored in the file: a header of sizes, then bytes, perhaps in compressed pieces.
class BlockReader {
public:
    BlockReader(const std::string& path, const VtkEncoding& encoding, const std::string& text, std::size_t at,
                bool base64)
        : mPath(path), mEncoding(encoding), mText(text), mAt(at), mBase64(base64) {}

    std::string read(std::size_t expected) {
        const std::size_t word = mEncoding.wideHeader ? 8 : 4;
        if (!mEncoding.compressed) {
            // Header and data are one run of base64.
            const std::string bytes = take(word + expected);
            if (number(bytes, 0) < expected) truncated();
            return bytes.substr(word);
        }
        std::string header = peek(3 * word);
        const std::uint64_t blocks = number(header, 0), size = number(header, 1), last = number(header, 2);
        if (blocks > mText.size() / word || size > 4000ull * mText.size() + 1000000) truncated();
        header = take((3 + std::size_t(blocks)) * word);
        finishRun();
        std::size_t packed = 0;
        for (std::size_t i = 0; i < blocks; ++i)
            packed += std::size_t(std::min<std::uint64_t>(number(header, 3 + i), mText.size()));
        const std::string bytes = take(packed);
        std::string all;
        std::size_t from = 0;
        for (std::size_t i = 0; i < blocks; ++i) {
            const std::size_t length = std::size_t(number(header, 3 + i));
            const std::size_t made = std::size_t(i + 1 == blocks && last > 0 ? last : size);
            all += inflateZlib(mPath, bytes.substr(from, length), made);
            from += length;
        }
        if (all.size() < expected) truncated();
        return all;
    }

private:
    [[noreturn]] void truncated() const {
        refuse(mPath, "truncated, or its data array is smaller than its extent");
    }
    std::uint64_t number(const std::string& bytes, std::size_t index) const {
        const std::size_t word = mEncoding.wideHeader ? 8 : 4;
        std::uint64_t value = 0;
        if ((index + 1) * word > bytes.size()) truncated();
        std::string raw = bytes.substr(index * word, word);
        if (mEncoding.swap) std::reverse(raw.begin(), raw.end());
        std::memcpy(&value, raw.data(), word);
        return value;
    }
    std::string peek(std::size_t count) {
        const std::size_t at = mAt;
        std::string bytes = take(count);
        mAt = at;
        return bytes;
    }
    std::string take(std::size_t count) {
        std::string bytes;
        if (count > mText.size()) truncated();
        if (mBase64) {
            mAt += decodeBase64(mPath, mText, mAt, count, bytes);
        } else if (mAt <= mText.size() && count <= mText.size() - mAt) {
            bytes = mText.substr(mAt, count);
            mAt += count;
        }
        if (bytes.size() < count) truncated();
        return bytes;
    }
    // A run of base64 ends with its padding.
    void finishRun() {
        while (mBase64 && mAt < mText.size() && mText[mAt] == '=') ++mAt;
    }

    const std::string& mPath;
    const VtkEncoding& mEncoding;
    const std::string& mText;
    std::size_t mAt;
    bool mBase64;
};

SampleType typeOf(const std::string& path, const VtkArray& array) {
    static const std::map<std::string, SampleType> types{
        {"UInt8", SampleType::U8},   {"Int8", SampleType::I8},    {"UInt16", SampleType::U16},
        {"Int16", SampleType::I16},  {"UInt32", SampleType::U32}, {"Int32", SampleType::I32},
        {"UInt64", SampleType::U64}, {"Int64", SampleType::I64},  {"Float32", SampleType::F32},
        {"Float64", SampleType::F64}};
    const auto found = types.find(array.type);
    if (found == types.end())
        refuse(path, "its array " + array.name + " is of type " + printableText(array.type, 60) +
                         ", which is not supported; numbers of 8 to 64 bits are");
    return found->second;
}

void readText(const std::string& path, const std::string& text, std::vector<float>& values) {
    TextScanner scanner(path, text, '\0');
    for (float& value : values) {
        const std::string_view word = scanner.word();
        if (word.empty()) refuse(path, "truncated: its data array ends before its extent does");
        if (!parseAnyReal(word, value))
            refuse(path, "its data holds \"" + printableText(word, 60) + "\", which is not a number");
    }
}

}  // namespace

// Raw appended data is not XML: it is cut out before the rest is parsed.
std::string cutAppended(const std::string& content, VtkEncoding& encoding) {
    const std::size_t tag = content.find("<AppendedData");
    if (tag == std::string::npos) return content;
    const std::size_t open = content.find('>', tag),
                      mark = open == std::string::npos ? open : content.find('_', open);
    if (mark == std::string::npos) return content;
    encoding.appendedBase64 = content.substr(tag, open - tag).find("base64") != std::string::npos;
    std::size_t end = content.rfind("</AppendedData>");
    if (end == std::string::npos || end < mark) end = content.size();
    encoding.appended = content.substr(mark + 1, end - mark - 1);
    return content.substr(0, mark) +
           (end < content.size() ? content.substr(end) : "</AppendedData></VTKFile>");
}

std::size_t bytesOfVtkType(const std::string& path, const VtkArray& array) {
    return bytesOf(typeOf(path, array));
}

double whiteOfVtkType(const std::string& path, const VtkArray& array) {
    return array.components == 1 ? whiteOf(typeOf(path, array)) : 0;
}

std::vector<float> readVtkArray(const std::string& path, const VtkArray& array, const VtkEncoding& encoding,
                                std::size_t count, const RunContext& ctx) {
    const std::size_t components = std::size_t(array.components);
    requireMemory(ctx, double(count) * double(components) * 8, path, "crop or shrink it first");
    const SampleType type = typeOf(path, array);
    std::vector<float> values(count * components);
    if (array.format == "ascii") {
        readText(path, array.text, values);
    } else {
        const bool appended = array.format == "appended";
        const std::string bytes =
            BlockReader(path, encoding, appended ? encoding.appended : array.text,
                        appended ? array.offset : 0, !appended || encoding.appendedBase64)
                .read(values.size() * bytesOf(type));
        toFloats(bytes.data(), values.size(), type, encoding.swap, values.data());
    }
    if (components == 1) return values;
    for (std::size_t i = 0; i < count; ++i) {
        double sum = 0;
        for (std::size_t c = 0; c < components; ++c) {
            const double part = double(values[i * components + c]);
            sum += part * part;
        }
        values[i] = float(std::sqrt(sum));
    }
    values.resize(count);
    return values;
}

}  // namespace vdbsynth
