// Readers of option_value.h.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "tools/vdb_synth/option_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

namespace vdbsynth::cli {

bool readWhole(const std::string& text, long long& value) {
    return parseWhole(text, value);
}

bool readReal(const std::string& text, double& value) {
    return parseReal(text, value);
}

bool readSeed(const std::string& text, std::uint64_t& value) {
    const char* end = text.data() + text.size();
    const auto [at, problem] = std::from_chars(text.data(), end, value);
    return problem == std::errc() && at == end;
}

bool readBytes(const std::string& text, std::uint64_t& value) {
    std::string number = text;
    double unit = 1, count = 0;
    if (!number.empty() && (number.back() == 'B' || number.back() == 'b')) number.pop_back();
    const std::string letters = "KMGT";
    if (!number.empty()) {
        const std::size_t power = letters.find(char(std::toupper(static_cast<unsigned char>(number.back()))));
        if (power != std::string::npos) {
            for (std::size_t i = 0; i <= power; ++i) unit *= 1000;
            number.pop_back();
        }
    }
    if (!parseReal(number, count) || count * unit < 1e6 || count * unit > 1e18) return false;
    value = std::uint64_t(count * unit);
    return true;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t comma; (comma = text.find(',', begin)) != std::string::npos; begin = comma + 1)
        parts.push_back(text.substr(begin, comma - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

bool readNamedImage(const std::string& text, std::pair<std::string, std::string>& image) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos) return false;
    image = {text.substr(0, equals), text.substr(equals + 1)};
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    return std::all_of(image.first.begin(), image.first.end(), plain) && isRasterPath(image.second);
}

bool readLengths(const std::string& text, std::vector<double>& lengths) {
    for (const std::string& part : splitAtCommas(text)) {
        double length = 0;
        if (lengths.size() == 3 || !parseReal(part, length)) return false;
        lengths.push_back(length);
    }
    return !lengths.empty();
}

bool readTriple(const std::string& text, std::array<double, 3>& values) {
    const std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i)
        if (!parseReal(parts[i], values[i])) return false;
    return true;
}

namespace {

// A length or place in world units; its `w` says what is so anyway.
bool readWorld(std::string part, double& value) {
    if (part.size() > 1 && part.back() == 'w') part.pop_back();
    return parseReal(part, value) && std::isfinite(value);
}

}  // namespace

bool readWorldTriple(const std::string& text, std::array<double, 3>& values) {
    const std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i)
        if (!readWorld(parts[i], values[i])) return false;
    return true;
}

bool readWorldBox(const std::string& text, std::array<double, 6>& values) {
    const std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() != 6) return false;
    for (std::size_t i = 0; i < 6; ++i)
        if (!readWorld(parts[i], values[i])) return false;
    return values[0] < values[3] && values[1] < values[4] && values[2] < values[5];
}

bool readWholeTriple(const std::string& text, Index3& values) {
    std::array<double, 3> reals{};
    if (!readTriple(text, reals)) return false;
    for (int axis = 0; axis < 3; ++axis) {
        const double value = reals[std::size_t(axis)];
        if (value != std::floor(value) || std::abs(value) > 1e9) return false;
        values[axis] = int(value);
    }
    return true;
}

bool readRange(const std::string& text, double& low, double& high) {
    const std::vector<std::string> parts = splitAtCommas(text);
    return parts.size() == 2 && parseReal(parts[0], low) && parseReal(parts[1], high) && low <= high;
}

namespace {

bool readSize(std::string part, SizeValue& size) {
    size.multiple = !part.empty() && part.back() == 'x';
    size.world = !part.empty() && part.back() == 'w';
    if (size.multiple || size.world) part.pop_back();
    return parseReal(part, size.value);
}

}  // namespace

bool readBox(const std::string& text, BoxValue& box) {
    const std::vector<std::string> parts = splitAtCommas(text);
    constexpr int kFar = 1 << 28;  // beyond this, sizes of boxes exceed int
    if (parts.size() != 6) return false;
    BoxValue given;
    for (std::size_t i = 0; i < 6; ++i) {
        SizeValue& end = given[i];
        if (!readSize(parts[i], end) || end.multiple) return false;
        if (!end.world && (end.value != std::floor(end.value) || std::abs(end.value) > kFar)) return false;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const SizeValue &low = given[axis], &high = given[axis + 3];
        if (low.world != high.world) continue;  // known with the voxels
        if (low.value > high.value || (low.world && low.value == high.value)) return false;
    }
    box = given;
    return true;
}

bool readSheetSizes(const std::string& text, std::array<SizeValue, 2>& sizes) {
    const std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() != 2) return false;
    for (std::size_t i = 0; i < 2; ++i)
        if (!readSize(parts[i], sizes[i])) return false;
    return true;
}

bool readSizes(const std::string& text, std::array<SizeValue, 3>& sizes) {
    const std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i)
        if (!readSize(parts[i], sizes[i])) return false;
    return true;
}

bool readPixels(const std::string& text, int& width, int& height) {
    const std::size_t cross = text.find('x');
    return cross != std::string::npos && parseWhole(text.substr(0, cross), width) &&
           parseWhole(text.substr(cross + 1), height);
}

bool readSlice(const std::string& text, SliceValue& slice) {
    if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || text[1] != '=') return false;
    slice.axis = text[0] - 'x';
    return parseReal(text.substr(2), slice.fraction) && slice.fraction >= 0 && slice.fraction <= 1;
}

bool readLabels(const std::string& text, std::vector<std::pair<double, double>>& labels) {
    for (const std::string& part : splitAtCommas(text)) {
        const std::size_t dash = part.find('-', 1);  // the first may be a sign
        const std::string low = part.substr(0, dash);
        const std::string high = dash == std::string::npos ? low : part.substr(dash + 1);
        // Samples are floats: a label is the nearest float, not the double.
        float values[2] = {};
        if (!parseReal(low, values[0]) || !parseReal(high, values[1]) || values[0] > values[1]) return false;
        labels.emplace_back(double(values[0]), double(values[1]));
    }
    return true;
}

namespace {

constexpr int kFarFrame = 9999999;
constexpr std::size_t kMostFrames = 100000;

bool readFrame(const std::string& text, int& frame) {
    if (text.empty() || text.size() > 7 || text.find_first_not_of("0123456789") != std::string::npos)
        return false;
    frame = std::atoi(text.c_str());
    return frame <= kFarFrame;
}

// "7", "1-20" or "1-20x2".
bool addPart(const std::string& part, std::vector<int>& frames) {
    const std::size_t dash = part.find('-'), step = part.find('x');
    int first = 0, last = 0, by = 1;
    if (dash == std::string::npos) {
        if (!readFrame(part, first)) return false;
        last = first;
    } else {
        if (!readFrame(part.substr(0, dash), first)) return false;
        const std::size_t length = step == std::string::npos ? step : step - dash - 1;
        if (!readFrame(part.substr(dash + 1, length), last)) return false;
        if (step != std::string::npos && (!readFrame(part.substr(step + 1), by) || by == 0)) return false;
        if (last < first) return false;
    }
    for (int frame = first; frame <= last; frame += by) {
        if (frames.size() >= kMostFrames) return false;
        frames.push_back(frame);
    }
    return true;
}

}  // namespace

bool readFrames(const std::string& text, std::vector<int>& frames) {
    frames.clear();
    const std::vector<std::string> parts = splitAtCommas(text);
    if (!std::all_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return addPart(part, frames); }))
        return false;
    return std::set<int>(frames.begin(), frames.end()).size() == frames.size();
}

bool readAxes(const std::string& text, std::array<bool, 3>& axes) {
    axes = {};
    if (text == "none") return true;
    for (char letter : text) {
        if (letter < 'x' || letter > 'z' || axes[std::size_t(letter - 'x')]) return false;
        axes[std::size_t(letter - 'x')] = true;
    }
    return !text.empty();
}

bool readProcess(const std::string& text, ExemplarOptions& options) {
    std::istringstream words(text);
    std::vector<std::string> all;
    for (std::string word; words >> word;) all.push_back(word);
    if ((all.size() != 2 && all.size() != 4) || all[0] != "make") return false;
    const std::vector<ExemplarKind>& kinds = exemplarKinds();
    options.kind = all[1];
    if (std::none_of(kinds.begin(), kinds.end(),
                     [&](const ExemplarKind& kind) { return kind.name == options.kind; }))
        return false;
    if (all.size() == 2) return true;
    return all[2] == "--feature" && parseReal(all[3], options.feature) && options.feature >= 4 &&
           options.feature <= 256;
}

GridPath splitGridPath(const std::string& text) {
    const std::size_t colon = text.rfind(".vdb:");
    if (colon == std::string::npos) return {text, ""};
    return {text.substr(0, colon + 4), text.substr(colon + 5)};
}

bool namesGrid(const std::string& text) {
    return extensionOf(splitGridPath(text).file) == "vdb";
}

std::array<std::string, 3> splitAxisChoices(const std::string& text) {
    const std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() != 3) return {parts[0], parts[0], parts[0]};
    return {parts[0], parts[1], parts[2]};
}

}  // namespace vdbsynth::cli
