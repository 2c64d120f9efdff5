#pragma once
#include "libvdbsynth/io/readers/text_scanner.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth {

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float, Double };

struct PlyProperty {
    std::string name;
    bool list = false;
    PlyType count = PlyType::UInt8;  ///< of a list's length
    PlyType value = PlyType::Float;

    bool isWhole() const { return value != PlyType::Float && value != PlyType::Double; }
};

struct PlyElement {
    std::string name;
    std::int64_t count = 0;  ///< as the header claims, at least 0
    std::vector<PlyProperty> properties;
};

enum class PlyEncoding { Ascii, Little, Big };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Ascii;
    std::vector<PlyElement> elements;
    std::size_t bytes = 0;  ///< where the body begins
};

/// The header of a PLY file, with lines that end in LF, CR LF or CR; the counts may be more than the file
/// holds.
/// @throw Error BadData
PlyHeader readPlyHeader(const std::string& path, const std::string& content);

/// The comments of a PLY header, in order, without the word and without blanks at the end; of a
/// line its first 4096 bytes.
std::vector<std::string> plyCommentsIn(const std::string& content);

/// Reads the numbers of a PLY body, one after the other, from text or bytes. Where every element of an ascii
/// body stands on a line of its own, words behind those that the header declares are skipped.
class PlyBody {
public:
    /// All are borrowed for the body's lifetime.
    /// @throw Error BadData (the header claims more than the file can hold)
    PlyBody(const std::string& path, const std::string& content, const PlyHeader& header);

    /// Every element is begun, its properties are read or skipped in their order, and it is ended.
    void begin(const PlyElement& element);
    void end();

    double number(PlyType type);
    std::int64_t listLength(const PlyProperty& property);
    void skip(const PlyProperty& property);
    void skipAll(const PlyElement& element);

    /// Lines with more words than the header declares, so far.
    std::int64_t longLines() const { return mLongLines; }
    /// Bytes that are not read yet, without white space at the end.
    std::size_t bytesLeft() const;
    /// @throw Error BadData
    [[noreturn]] void fail(const std::string& what) const;

private:
    void checkCounts(const PlyHeader& header) const;
    [[noreturn]] void failTruncated() const;
    void take(unsigned char* bytes, std::size_t count);
    std::string_view word();
    double asciiNumber(PlyType type);

    const std::string& mPath;
    const std::string& mContent;
    std::size_t mAt;
    PlyEncoding mEncoding;
    TextScanner mScanner;
    const PlyElement* mElement = nullptr;
    std::int64_t mEnded = 0;  // elements of its kind
    bool mByLine = false, mInElement = false;
    bool mManyLines = false;      // at least one for every element
    std::int64_t mExact = 0;      // elements of its kind that were a whole line
    std::int64_t mLongLines = 0;  // that had more words
};

}  // namespace vdbsynth
