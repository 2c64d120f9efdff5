#include "libvdbsynth/io/readers/tiff/stack_description.h"

#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace vdbsynth {
namespace {

constexpr std::int64_t kMostPlanes = 1 << 24;

// A count of planes; false if it is none.
bool parseCount(std::string_view word, std::int64_t& count) {
    long long value = 0;
    if (!parseWhole(word, value) || value < 0 || value > kMostPlanes) return false;
    count = value;
    return true;
}

// A length; ImageJ writes some with a minus sign.
void parseLength(std::string_view word, double& length) {
    double value = 0;
    if (parseReal(word, value) && value != 0) length = std::abs(value);
}

// A place in cells; one that is no usable number counts as zero.
void parseOrigin(std::string_view word, double& origin) {
    double value = 0;
    if (parseReal(word, value) && std::abs(value) < 1e9) origin = value;
}

// A unit as letters: files write micrometres in many ways, as escapes and in several encodings.
std::string unitOf(std::string_view word) {
    std::string letters;
    for (const char c : word)
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) letters += c;
    bool micro = false;
    for (const char* sign :
         {"\xb5", "\xce\xbc", "\\u00B5", "\\u00b5", "&#181;", "&#xB5;", "&#xb5;", "&#956;"})
        micro = micro || word.find(sign) != word.npos;
    if (micro || letters == "micron" || letters == "microns" || letters == "micrometer") return "um";
    if (letters == "inch" || letters == "inches") return "in";
    if (letters == "pixel" || letters == "pixels" || letters == "reference" || letters.size() > 12) return "";
    return letters;
}

StackDescription parseImageJ(std::string_view text) {
    StackDescription result;
    result.kind = StackDescription::Kind::ImageJ;
    std::int64_t function = -1;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        const std::size_t equals = line.find('=');
        if (equals == line.npos) continue;
        const std::string_view key = line.substr(0, equals), value = line.substr(equals + 1);
        if (key == "images") parseCount(value, result.images);
        if (key == "channels") parseCount(value, result.channels);
        if (key == "slices") parseCount(value, result.slices);
        if (key == "frames") parseCount(value, result.frames);
        if (key == "spacing") parseLength(value, result.spacing[2]);
        for (const char axis : {'x', 'y', 'z'})
            if (key == std::string(1, axis) + "origin") parseOrigin(value, result.origin[axis - 'x']);
        if (key == "unit") result.unit = unitOf(value);
        if (key == "cf") parseCount(value, function);
        if (key == "c0") parseReal(value, result.calibrationOffset);
        if (key == "c1") parseReal(value, result.calibrationFactor);
    }
    // Function 0 is a straight line; ImageJ's others are densities of gels and other scales.
    result.calibrated = function == 0 && (result.calibrationOffset != 0 || result.calibrationFactor != 1);
    const bool counted = result.channels * result.slices * result.frames > 1;
    if (!counted) result.slices = result.images;
    return result;
}

// The value of an attribute of an element's text, empty if it has none.
std::string_view attributeOf(std::string_view element, std::string_view name) {
    for (std::size_t at = 0; (at = element.find(name, at)) != element.npos; at += name.size()) {
        const std::size_t equals = element.find_first_not_of(" \t\r\n", at + name.size());
        const bool begins =
            at > 0 && std::string_view(" \t\r\n").find(element[at - 1]) != std::string_view::npos;
        if (!begins || equals == element.npos || element[equals] != '=') continue;
        const std::size_t quote = element.find_first_of("\"'", equals);
        if (quote == element.npos) return {};
        const std::size_t end = element.find(element[quote], quote + 1);
        return end == element.npos ? std::string_view() : element.substr(quote + 1, end - quote - 1);
    }
    return {};
}

constexpr std::size_t kLongestNamespace = 32;

// The next element of a name, with or without a namespace, to its '>'; `at` moves behind it. Empty: none.
std::string_view nextElement(std::string_view text, std::string_view name, std::size_t& at) {
    while ((at = text.find(name, at)) != text.npos) {
        const std::size_t begin = at, end = begin + name.size();
        at = end;
        if (end >= text.size() || std::string_view(" \t\r\n/>").find(text[end]) == std::string_view::npos)
            continue;
        std::size_t open = begin;
        for (std::size_t i = 0; i <= kLongestNamespace && open > 0 && text[open] != '<'; ++i) {
            const char c = text[--open];
            if (c == '/' || c == ' ' || (open + 1 == begin && c != '<' && c != ':')) break;
        }
        if (text[open] != '<') continue;
        at = std::min(text.find('>', end), text.size());
        return text.substr(end, at - end);
    }
    return {};
}

std::vector<StackDescription::Block> parseBlocks(std::string_view text, std::string_view pixels) {
    std::vector<StackDescription::Block> blocks;
    const std::size_t begin = std::size_t(pixels.data() - text.data());
    const std::size_t end = std::min(text.find("Pixels>", begin), text.size());
    const std::string_view inside = text.substr(begin, end - begin);
    for (std::size_t at = 0; blocks.size() < std::size_t(kMostPlanes);) {
        const std::string_view element = nextElement(inside, "TiffData", at);
        if (element.empty()) break;
        StackDescription::Block block;
        const bool placed = parseCount(attributeOf(element, "IFD"), block.page);
        parseCount(attributeOf(element, "FirstC"), block.channel);
        parseCount(attributeOf(element, "FirstZ"), block.slice);
        parseCount(attributeOf(element, "FirstT"), block.frame);
        if (!parseCount(attributeOf(element, "PlaneCount"), block.count) && placed) block.count = 1;
        blocks.push_back(block);
    }
    return blocks;
}

bool namesSeveralFiles(std::string_view text) {
    std::string_view first;
    for (std::size_t at = 0;;) {
        const std::string_view element = nextElement(text, "UUID", at);
        if (element.empty()) return false;
        const std::string_view name = attributeOf(element, "FileName");
        if (name.empty()) continue;
        if (first.empty()) first = name;
        if (name != first) return true;
    }
}

StackDescription parseOme(std::string_view text) {
    StackDescription result;
    std::size_t at = 0;
    const std::string_view pixels = nextElement(text, "Pixels", at);
    if (pixels.empty()) return result;
    result.kind = StackDescription::Kind::Ome;
    parseCount(attributeOf(pixels, "SizeC"), result.channels);
    parseCount(attributeOf(pixels, "SizeZ"), result.slices);
    parseCount(attributeOf(pixels, "SizeT"), result.frames);
    const std::string_view order = attributeOf(pixels, "DimensionOrder");
    if (order.size() == 5 && order.substr(0, 2) == "XY") result.order = std::string(order.substr(2));
    const char* const names[3] = {"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    for (std::size_t axis = 0; axis < 3; ++axis)
        parseLength(attributeOf(pixels, names[axis]), result.spacing[axis]);
    const std::string_view unit = attributeOf(pixels, "PhysicalSizeXUnit");
    if (result.spacing[0] > 0) result.unit = unit.empty() ? "um" : unitOf(unit);
    result.blocks = parseBlocks(text, pixels);
    result.severalFiles = namesSeveralFiles(text);
    return result;
}

// The whole numbers of the list that follows a key in JSON.
std::vector<std::int64_t> jsonCounts(std::string_view text, std::string_view key) {
    std::vector<std::int64_t> counts;
    const std::size_t at = text.find(key);
    if (at == text.npos) return counts;
    const std::size_t open = text.find('[', at), close = text.find(']', at);
    if (open == text.npos || close == text.npos || close < open) return counts;
    std::string_view list = text.substr(open + 1, close - open - 1);
    while (!list.empty() && counts.size() < 16) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view word = list.substr(0, comma);
        while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
        while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
        std::int64_t count = 0;
        if (!parseCount(word, count)) return {};
        counts.push_back(count);
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return counts;
}

// The string that follows a key in JSON.
std::string_view jsonString(std::string_view text, std::string_view key) {
    const std::size_t at = text.find(key);
    const std::size_t open = at == text.npos ? at : text.find('"', at + key.size());
    const std::size_t close = open == text.npos ? open : text.find('"', open + 1);
    return close == text.npos ? std::string_view() : text.substr(open + 1, close - open - 1);
}

StackDescription parseShape(std::string_view text, std::int64_t width, std::int64_t height) {
    StackDescription result;
    const std::vector<std::int64_t> shape = jsonCounts(text, "\"shape\"");
    std::size_t page = shape.size();
    for (std::size_t i = 0; i + 1 < shape.size(); ++i)
        if (shape[i] == height && shape[i + 1] == width) page = i;
    if (page == shape.size() || page == 0) return result;
    result.kind = StackDescription::Kind::Shape;
    const std::string_view axes = jsonString(text, "\"axes\"");
    const bool named = axes.size() == shape.size();
    std::string names(named ? axes.substr(0, page) : std::string_view());
    names.resize(page, 'T');
    // Without names of the axes: slices innermost, around them channels, then frames.
    std::size_t unnamed = 0;
    for (std::size_t i = page; i-- > 0 && !named;)
        if (shape[i] != 1 && unnamed < 2) names[i] = "ZC"[unnamed++];
    result.order.clear();
    for (std::size_t i = page; i-- > 0;) {
        std::int64_t& count = names[i] == 'C' || names[i] == 'S' ? result.channels
                              : names[i] == 'T'                  ? result.frames
                                                                 : result.slices;
        const char axis = &count == &result.channels ? 'C' : &count == &result.frames ? 'T' : 'Z';
        if (shape[i] != 1 && result.order.find(axis) != std::string::npos) return StackDescription();
        if (shape[i] != 1) result.order += axis;
        if (shape[i] != 1) count = shape[i];
    }
    for (const char axis : {'C', 'Z', 'T'})
        if (result.order.find(axis) == std::string::npos) result.order += axis;
    return result;
}

}  // namespace

const char* nameOf(StackDescription::Kind kind) {
    switch (kind) {
        case StackDescription::Kind::ImageJ:
            return "ImageJ description";
        case StackDescription::Kind::Ome:
            return "OME description";
        case StackDescription::Kind::Shape:
            return "description's shape";
        default:
            return "description";
    }
}

StackDescription parseStackDescription(const std::string& text, std::int64_t width, std::int64_t height) {
    if (text.compare(0, 7, "ImageJ=") == 0) return parseImageJ(text);
    if (text.find("<OME") != text.npos || text.find(":OME") != text.npos) return parseOme(text);
    if (text.compare(0, 1, "{") == 0) return parseShape(text, width, height);
    return {};
}

std::vector<std::size_t> planePages(const StackDescription& description, std::size_t pages,
                                    std::size_t samples) {
    const std::int64_t inPage = std::int64_t(samples);
    if (description.kind == StackDescription::Kind::None || description.severalFiles) return {};
    if (inPage < 1 || description.channels < 1) return {};
    const bool divides = description.channels % inPage == 0;
    const std::int64_t channels = divides ? description.channels / inPage : description.channels;
    const std::int64_t step = divides ? inPage : 1;
    const std::int64_t sizes[3] = {channels, description.slices, description.frames};
    if (!productFits({sizes[0], sizes[1], sizes[2]}, pages)) return {};
    const std::int64_t planes = sizes[0] * sizes[1] * sizes[2];
    // Steps in the order of pages, of channel, slice and frame.
    std::int64_t steps[3] = {0, 0, 0}, next = 1;
    for (const char axis : description.order) {
        const std::size_t which = axis == 'C' ? 0 : axis == 'Z' ? 1 : 2;
        if (steps[which] != 0) return {};
        steps[which] = next;
        next *= sizes[which];
    }
    if (planes < 1 || next != planes) return {};
    std::vector<StackDescription::Block> blocks = description.blocks;
    if (blocks.empty() && std::size_t(planes) != pages) return {};
    if (blocks.empty()) blocks.emplace_back();
    std::vector<std::int64_t> stored(std::size_t(planes), -1);
    for (const StackDescription::Block& block : blocks) {
        const std::int64_t first =
            block.channel / step * steps[0] + block.slice * steps[1] + block.frame * steps[2];
        const std::int64_t count = block.count > 0 ? block.count : planes;
        for (std::int64_t i = 0; i < count && first + i < planes && block.page + i < std::int64_t(pages); ++i)
            stored[std::size_t(first + i)] = block.page + i;
    }
    std::vector<std::size_t> result;
    for (std::int64_t t = 0; t < sizes[2]; ++t)
        for (std::int64_t c = 0; c < sizes[0]; ++c)
            for (std::int64_t z = 0; z < sizes[1]; ++z) {
                const std::int64_t page = stored[std::size_t(t * steps[2] + c * steps[0] + z * steps[1])];
                if (page < 0) return {};
                result.push_back(std::size_t(page));
            }
    return result;
}

}  // namespace vdbsynth
