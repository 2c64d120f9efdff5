// Volumes whose headers are text: GSLIB (as SGeMS writes it) and INRIMAGE.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vdbsynth {

namespace {

// What the first line of a GSLIB file says of its lattice.
struct GslibLattice {
    std::int64_t sides[3] = {0, 0, 0};
    Vec3d spacing{1, 1, 1}, origin{0, 0, 0};  // the origin is a corner of the first cell
    bool placed = false;
};

std::string_view takeLine(TextScanner& scanner, const std::string& content) {
    const std::size_t begin = scanner.position();
    scanner.skipLine();
    std::string_view line = std::string_view(content).substr(begin, scanner.position() - begin);
    while (!line.empty() && std::strchr(" \t\r\n", line.back())) line.remove_suffix(1);
    while (!line.empty() && std::strchr(" \t", line.front())) line.remove_prefix(1);
    return line;
}

// SGeMS writes NAME (NXxNYxNZ).
bool parseTitle(std::string_view line, GslibLattice& lattice) {
    const std::size_t open = line.rfind('('), close = line.rfind(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) return false;
    std::size_t at = open + 1;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t end = axis < 2 ? line.find_first_of("xX", at) : close;
        if (end == std::string_view::npos || end > close) return false;
        std::string_view word = line.substr(at, end - at);
        while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
        while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
        if (!parseWhole(word, lattice.sides[axis])) return false;
        at = end + 1;
    }
    return true;
}

// Programs write spacing and origin in either order: only spacings must be above zero.
void placeLattice(const std::string& path, const std::vector<double>& numbers, GslibLattice& lattice,
                  const RunContext& ctx) {
    const auto vector = [&](std::size_t at) { return Vec3d{numbers[at], numbers[at + 1], numbers[at + 2]}; };
    const auto positive = [](const Vec3d& v) { return v.x > 0 && v.y > 0 && v.z > 0; };
    const Vec3d second = vector(0), third = numbers.size() >= 6 ? vector(3) : Vec3d{0, 0, 0};
    const bool originFirst = !positive(second) && positive(third);
    if (!positive(second) && !originFirst)
        throw Error(ErrorCode::BadData, path + ": the spacing on its first line is not above 0");
    lattice.spacing = originFirst ? third : second;
    lattice.origin = originFirst ? second : third;
    lattice.placed = true;
    const auto text = [](const Vec3d& v) {
        return roundedText(v.x, 9) + " " + roundedText(v.y, 9) + " " + roundedText(v.z, 9);
    };
    message(ctx, MessageLevel::Note,
            path + ": the numbers behind its sizes are taken for a spacing of " + text(lattice.spacing) +
                " and an origin of " + text(lattice.origin));
}

GslibLattice latticeOf(const std::string& path, std::string_view line, const RunContext& ctx) {
    GslibLattice lattice;
    TextScanner words(path, line, '\0');
    std::vector<double> numbers;
    for (std::string_view word = words.wordOnLine(); !word.empty(); word = words.wordOnLine()) {
        double number = 0;
        const bool whole = numbers.size() >= 3 || parseWhole(word, lattice.sides[numbers.size()]);
        if (!whole || !parseReal(word, number)) {
            numbers.clear();
            break;
        }
        numbers.push_back(number);
    }
    if (numbers.size() < 3) {
        if (parseTitle(line, lattice)) return lattice;
        throw Error(ErrorCode::BadData,
                    path + ": its first line must hold the sizes NX NY NZ, or NAME (NXxNYxNZ)");
    }
    numbers.erase(numbers.begin(), numbers.begin() + 3);
    if (numbers.size() == 3 || numbers.size() == 6)
        placeLattice(path, numbers, lattice, ctx);
    else if (!numbers.empty())
        message(ctx, MessageLevel::Note,
                path + ": " + std::to_string(numbers.size()) + " numbers behind its sizes are not used");
    return lattice;
}

float gslibValue(TextScanner& scanner) {
    const std::string_view word = scanner.word();
    float value = 0;
    if (word.empty()) scanner.fail("the file ends where a number should be; it is truncated");
    if (!parseAnyReal(word, value)) scanner.fail("\"" + printableText(word, 40) + "\" is not a number");
    return value;
}

std::vector<std::string> gslibNames(TextScanner& scanner, const std::string& content) {
    std::int64_t variables = 0;
    if (!parseWhole(scanner.word(), variables) || variables < 1 || variables > 1000)
        scanner.fail("the second line must be the number of variables, 1 to 1000");
    scanner.skipLine();
    std::vector<std::string> names;
    for (std::int64_t i = 0; i < variables; ++i) {
        const std::string_view name = takeLine(scanner, content);
        names.push_back(name.empty() ? "variable" + std::to_string(i + 1) : printableText(name, 200));
    }
    return names;
}

}  // namespace

// The lattice, the number of variables, a line with the name of each, then rows of values, x fastest.
Raster readGslib(const std::string& path, const std::string& content, const RasterReadOptions& options,
                 const RunContext& ctx) {
    constexpr float kSgemsNoData = -9966699.f;
    TextScanner scanner(path, content, '\0');
    scanner.atEnd();  // to the first word
    const GslibLattice lattice = latticeOf(path, takeLine(scanner, content), ctx);
    const std::vector<std::string> names = gslibNames(scanner, content);
    const std::int64_t *sides = lattice.sides, variables = std::int64_t(names.size());
    if (!productFits({sides[0], sides[1], sides[2], variables, 2}, content.size() - scanner.position() + 2))
        throw Error(ErrorCode::BadData, path + ": truncated; its header claims " + std::to_string(sides[0]) +
                                            " x " + std::to_string(sides[1]) + " x " +
                                            std::to_string(sides[2]) + " cells");
    const std::size_t chosen = chosenArray(path, names, 0, options, ctx);
    Raster raster = makeRaster(path, sides[0], sides[1], sides[2], 1, ctx);
    raster.stack = sides[2] > 1;
    raster.arrays = names;
    raster.knownSpacing = lattice.placed;
    raster.spacing = lattice.spacing;
    if (lattice.placed) raster.origin = lattice.origin + lattice.spacing * 0.5;
    std::size_t missing = 0;
    for (float& value : raster.values)
        for (std::size_t i = 0; i < names.size(); ++i) {
            const float read = gslibValue(scanner);
            if (i != chosen) continue;
            const bool none = read == kSgemsNoData;
            missing += none ? 1 : 0;
            value = none ? std::nanf("") : read;
        }
    if (missing > 0)
        message(ctx, MessageLevel::Note,
                path + ": " + std::to_string(missing) + " cells hold -9966699, SGeMS's mark of no data");
    if (!scanner.atEnd())
        message(ctx, MessageLevel::Warning,
                path + ": has more values than its sizes say (other realisations?); the first are read");
    return raster;
}

namespace {

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::map<std::string, std::string> inrFields(const std::string& header) {
    std::map<std::string, std::string> fields;
    std::size_t at = 0;
    while (at < header.size()) {
        const std::size_t end = std::min(header.find('\n', at), header.size()), equals = header.find('=', at);
        if (equals < end)
            fields[trimmed(header.substr(at, equals - at))] =
                trimmed(header.substr(equals + 1, end - equals - 1));
        at = end + 1;
    }
    return fields;
}

SampleType inrType(const std::string& path, const std::string& type, const std::string& bits) {
    const bool real = type == "float", isSigned = type.compare(0, 6, "signed") == 0;
    const std::string size = bits.substr(0, bits.find(' '));
    if (real && size == "32") return SampleType::F32;
    if (real && size == "64") return SampleType::F64;
    if (!real && size == "8") return isSigned ? SampleType::I8 : SampleType::U8;
    if (!real && size == "16") return isSigned ? SampleType::I16 : SampleType::U16;
    if (!real && size == "32") return isSigned ? SampleType::I32 : SampleType::U32;
    throw Error(ErrorCode::BadData, path + ": holds values of type " + printableText(type, 20) + " of " +
                                        printableText(bits, 20) + ", which is not supported");
}

// Spacing and origin; a rotation has no reader that applies it.
void placeInr(const std::string& path, std::map<std::string, std::string>& fields, Raster& raster,
              const RunContext& ctx) {
    const auto real = [&](const std::string& name, double& value) {
        return fields.count(name) > 0 && parseReal(fields[name], value);
    };
    bool turned = false;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string letter(1, char('X' + axis));
        double angle = 0;
        raster.knownSpacing = real("V" + letter, raster.spacing[axis]) || raster.knownSpacing;
        real("T" + letter, raster.origin[axis]);
        turned = turned || (real("R" + letter, angle) && angle != 0);
    }
    if (turned) message(ctx, MessageLevel::Note, path + ": its rotation (RX, RY, RZ) is left out");
    if (fields.count("SCALE") && fields["SCALE"] != "2**0")
        message(ctx, MessageLevel::Note, path + ": its SCALE is left out; values are those stored");
}

// Where the voxels begin: behind "##}" and the end of its line.
std::size_t inrStart(const std::string& path, const std::string& content) {
    const std::size_t mark = content.find("##}"),
                      end = mark == std::string::npos ? mark : content.find('\n', mark);
    if (content.compare(0, 13, "#INRIMAGE-4#{") != 0 || end == std::string::npos || end > mark + 4)
        throw Error(ErrorCode::BadData, path + ": not an INRIMAGE file");
    return end + 1;
}

}  // namespace

Raster readInr(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx) {
    const std::size_t start = inrStart(path, content);
    auto fields = inrFields(content.substr(0, start));
    const auto side = [&](const char* name) {
        std::int64_t value = 0;
        if (!parseWhole(fields[name], value))
            throw Error(ErrorCode::BadData, path + ": its header has no usable " + name);
        return value;
    };
    const std::int64_t parts = fields.count("VDIM") ? side("VDIM") : 1;
    if (parts < 1 || parts > 1000)
        throw Error(ErrorCode::BadData, path + ": has " + std::to_string(parts) +
                                            " components a voxel (VDIM); 1 to 1000 are read");
    const SampleType type = inrType(path, fields["TYPE"], fields["PIXSIZE"]);
    const std::int64_t columns = side("XDIM"), rows = side("YDIM"), slices = side("ZDIM");
    if (!productFits({columns, rows, slices, parts, std::int64_t(bytesOf(type))}, content.size() - start))
        throw Error(ErrorCode::BadData, path + ": truncated");
    std::vector<std::string> names;
    for (std::int64_t i = 1; parts > 1 && i <= parts; ++i) names.push_back("component" + std::to_string(i));
    const std::size_t part = names.empty() ? 0 : chosenArray(path, names, 0, options, ctx);
    Raster raster = makeRaster(path, columns, rows, slices, 1, ctx);
    raster.stack = true;
    raster.arrays = names;
    placeInr(path, fields, raster, ctx);
    const bool swap = fields["CPU"] == "sun" || fields["CPU"] == "sgi";
    const char* bytes = content.data() + start;
    if (parts == 1) {
        toFloats(bytes, raster.values.size(), type, swap, raster.values.data());
        return raster;
    }
    for (std::size_t i = 0; i < raster.values.size(); ++i)
        toFloats(bytes + (i * std::size_t(parts) + part) * bytesOf(type), 1, type, swap, &raster.values[i]);
    return raster;
}

}  // namespace vdbsynth
