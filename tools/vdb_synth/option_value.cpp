#include "tools/vdb_synth/option_value.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/direction/direction.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vdbsynth::cli {
namespace {

bool isChoice(const Option& option, const std::string& word) {
    return std::any_of(option.choices.begin(), option.choices.end(),
                       [&](const Choice& choice) { return choice.word == word; });
}

bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

bool within(const Option& option, double value) {
    return value >= option.low && value <= option.high;
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? "," : "") + parts[i];
    return text;
}

// A path as metadata holds it: moving a file must not change a result's bytes.
std::string fileOnly(const std::string& text) {
    const GridPath path = splitGridPath(text);
    return fileNameOf(path.file) + (path.grid.empty() ? "" : ":" + path.grid);
}

bool isStrokeFile(const std::string& text) {
    static const std::vector<std::string> kinds{"csv", "txt", "xyz", "json", "ply"};
    return has(kinds, extensionOf(text));
}

std::string normalWhole(const Option& option, const std::string& given) {
    long long value = 0;
    double real = 0;
    // 64.0 and 1e2 are whole numbers too.
    if (!readWhole(given, value)) {
        if (!readReal(given, real) || real != std::floor(real) || std::abs(real) > 1e15)
            refuseValue(option, given);
        value = static_cast<long long>(real);
    }
    if (!within(option, double(value)) || (option.odd && value % 2 == 0)) refuseValue(option, given);
    return std::to_string(value);
}

std::string normalBox(const BoxValue& box) {
    std::vector<std::string> parts;
    for (const SizeValue& end : box)
        parts.push_back(end.world ? exactText(end.value) + "w"
                                  : std::to_string(static_cast<long long>(end.value)));
    return joined(parts);
}

std::string normalWorldBox(const std::array<double, 6>& box) {
    std::vector<std::string> parts;
    for (const double corner : box) parts.push_back(exactText(corner));
    return joined(parts);
}

std::string normalSizes(const Option& option, const std::string& given) {
    std::array<SizeValue, 3> sizes;
    if (!readSizes(given, sizes)) refuseValue(option, given);
    std::vector<std::string> parts;
    for (const SizeValue& size : sizes) {
        const bool good =
            size.multiple ? size.value >= 1 && size.value <= 1e6
            : size.world  ? size.value > 0 && size.value <= 1e30
                          : size.value == std::floor(size.value) && size.value >= 1 && size.value <= 1 << 20;
        if (!good) refuseValue(option, given);
        parts.push_back(size.multiple ? exactText(size.value) + "x"
                        : size.world  ? exactText(size.value) + "w"
                                      : std::to_string(static_cast<long long>(size.value)));
    }
    return joined(parts);
}

std::string normalSheetSizes(const Option& option, const std::string& given) {
    std::array<SizeValue, 2> sizes;
    if (!readSheetSizes(given, sizes)) refuseValue(option, given);
    std::vector<std::string> parts;
    for (const SizeValue& size : sizes) {
        if (!(size.value > 0 && size.value <= (size.multiple ? 1e6 : 1e30))) refuseValue(option, given);
        parts.push_back(exactText(size.value) + (size.multiple ? "x" : ""));
    }
    return joined(parts);
}

std::string normalNumbers(const Option& option, const std::string& given) {
    std::vector<std::string> parts;
    std::array<double, 3> triple{};
    Index3 whole;
    double low = 0, high = 0;
    if (option.kind == Kind::Range) {
        if (!readRange(given, low, high)) refuseValue(option, given);
        parts = {exactText(low), exactText(high)};
    } else if (option.kind == Kind::Lengths) {
        std::vector<double> lengths;
        if (!readLengths(given, lengths)) refuseValue(option, given);
        for (double length : lengths) {
            if (!within(option, length)) refuseValue(option, given);
            parts.push_back(exactText(length));
        }
    } else if (option.kind == Kind::Triple) {
        const bool world = option.unit == Unit::World;
        if (world ? !readWorldTriple(given, triple) : !readTriple(given, triple)) refuseValue(option, given);
        for (double value : triple) parts.push_back(exactText(value));
    } else {
        if (!readWholeTriple(given, whole)) refuseValue(option, given);
        for (int axis = 0; axis < 3; ++axis) {
            if (!within(option, whole[axis])) refuseValue(option, given);
            parts.push_back(std::to_string(whole[axis]));
        }
    }
    return joined(parts);
}

std::string normalLabels(const Option& option, const std::string& given) {
    std::vector<std::pair<double, double>> labels;
    if (!readLabels(given, labels)) refuseValue(option, given);
    std::vector<std::string> parts;
    for (const auto& [low, high] : labels)
        parts.push_back(low == high ? exactText(float(low))
                                    : exactText(float(low)) + "-" + exactText(float(high)));
    return joined(parts);
}

std::string normalPixels(const Option& option, const std::string& given) {
    int width = 0, height = 0;
    if (!readPixels(given, width, height) || !within(option, width) || !within(option, height))
        refuseValue(option, given);
    return std::to_string(width) + "x" + std::to_string(height);
}

std::string normalScalar(const Option& option, const std::string& given) {
    double real = 0;
    std::uint64_t wide = 0;
    switch (option.kind) {
        case Kind::Whole:
            return normalWhole(option, given);
        case Kind::Seed:
            if (!readSeed(given, wide)) refuseValue(option, given);
            return std::to_string(wide);
        case Kind::Bytes:
            if (!readBytes(given, wide)) refuseValue(option, given);
            return std::to_string(wide);
        default:
            if (!readReal(given, real) || !within(option, real)) refuseValue(option, given);
            return exactText(real);
    }
}

std::string normalWords(const Option& option, const std::string& given) {
    std::array<bool, 3> axes{};
    SliceValue slice;
    ExemplarOptions process;
    switch (option.kind) {
        case Kind::Choice:
            // An extension is the kind of standard input and does not change the result.
            if (option.orExtension && !isChoice(option, given) && isKnownExtension(given))
                return option.initial;
            if (!isChoice(option, given)) refuseValue(option, given);
            return given;
        case Kind::AxisChoices: {
            const std::size_t parts = splitAtCommas(given).size();
            const std::array<std::string, 3> words = splitAxisChoices(given);
            for (const std::string& word : words)
                if ((parts != 1 && parts != 3) || !isChoice(option, word)) refuseValue(option, given);
            return joined({words.begin(), words.end()});
        }
        case Kind::Axes:
            if (!readAxes(given, axes)) refuseValue(option, given);
            return given;
        case Kind::Slice:
            if (!readSlice(given, slice)) refuseValue(option, given);
            return std::string(1, char('x' + slice.axis)) + "=" + exactText(slice.fraction);
        default:
            if (!readProcess(given, process)) refuseValue(option, given);
            return "make " + process.kind +
                   (process.feature > 0 ? " --feature " + exactText(process.feature) : std::string());
    }
}

std::string normalOutput(const Option& option, const std::string& given) {
    // "-" has no extension; the class Streams reports that.
    if (given == "-") return given;
    if (option.extensions.empty()) {
        requireOutputPaths({given});
    } else if (option.extensions.front() != "*" && !has(option.extensions, extensionOf(given))) {
        throw Error(ErrorCode::InvalidOption,
                    "--" + option.name + " " + given + ": unknown extension; must be " + allowedText(option));
    }
    return fileNameOf(given);
}

std::string normalPath(const Option& option, const std::string& given) {
    DirectionSource direction;
    BoxValue box;
    std::array<double, 6> reals;
    std::pair<std::string, std::string> image;
    switch (option.kind) {
        case Kind::NamedImage:
            if (!readNamedImage(given, image)) refuseValue(option, given);
            return image.first + "=" + fileNameOf(image.second);
        case Kind::Direction:
            if (parseDirection(given, direction))
                return given.find(',') == std::string::npos
                           ? given
                           : joined({exactText(direction.axis.x), exactText(direction.axis.y),
                                     exactText(direction.axis.z)});
            if (!namesGrid(given) && !isStrokeFile(given)) refuseValue(option, given);
            return fileOnly(given);
        case Kind::Hole:
            if (option.unit == Unit::World && readWorldBox(given, reals)) return normalWorldBox(reals);
            if (option.unit != Unit::World && given == "auto") return given;
            if (option.unit != Unit::World && readBox(given, box)) return normalBox(box);
            if (!isModelPath(given)) refuseValue(option, given);
            return fileOnly(given);
        case Kind::Region:
            if (given != "auto" && !namesGrid(given) && !isModelPath(given)) refuseValue(option, given);
            return given == "auto" ? given : fileOnly(given);
        case Kind::Grid:
            if (!namesGrid(given)) refuseValue(option, given);
            return fileOnly(given);
        case Kind::File:
            if (!option.extensions.empty() && !has(option.extensions, extensionOf(given)))
                refuseValue(option, given);
            return fileOnly(given);
        default:
            if (option.kind == Kind::Model || !namesGrid(given)) requireModelPath(given);
            return fileOnly(given);
    }
}

// A unit of length behind one of the numbers, such as the m of 2.5m,1,1; empty: none.
std::string unitIn(const std::string& given) {
    static const std::vector<std::string> units{"nm", "um", "mm", "cm", "m", "km", "in", "ft"};
    for (const std::string& part : splitAtCommas(given)) {
        const std::size_t end = part.find_last_of("0123456789.");
        double value = 0;
        if (end == std::string::npos || !parseReal(part.substr(0, end + 1), value)) continue;
        if (has(units, part.substr(end + 1))) return part.substr(end + 1);
    }
    return "";
}

}  // namespace

void refuseValue(const Option& option, const std::string& given) {
    const std::string unit = unitIn(given);
    throw Error(ErrorCode::InvalidOption,
                "--" + option.name + " " + given + ": must be " + allowedText(option) +
                    (unit.empty() ? ""
                                  : "; `" + unit +
                                        "` is not read: lengths are in the units of the model's file, and "
                                        "a model does not say which those are"));
}

std::string normalValue(const Option& option, const std::string& given) {
    BoxValue box;
    std::vector<int> frames;
    if (readsPath(option)) return normalPath(option, given);
    switch (option.kind) {
        case Kind::Flag:
            return "true";
        case Kind::Folder:
        case Kind::Text:
            if (given.empty()) refuseValue(option, given);
            return given;
        case Kind::Output:
            return normalOutput(option, given);
        case Kind::Box:
            if (!readBox(given, box)) refuseValue(option, given);
            return normalBox(box);
        case Kind::SheetSizes:
            return normalSheetSizes(option, given);
        case Kind::Sizes:
            return normalSizes(option, given);
        case Kind::Pixels:
            return normalPixels(option, given);
        case Kind::Labels:
            return normalLabels(option, given);
        case Kind::Frames:
            if (!readFrames(given, frames)) refuseValue(option, given);
            return given;
        case Kind::Lengths:
        case Kind::Triple:
        case Kind::WholeTriple:
        case Kind::Range:
            return normalNumbers(option, given);
        case Kind::Whole:
        case Kind::Real:
        case Kind::Seed:
        case Kind::Bytes:
            return normalScalar(option, given);
        default:
            return normalWords(option, given);
    }
}

std::string pathIn(const Option& option, const std::string& value) {
    DirectionSource direction;
    BoxValue box;
    std::array<double, 6> reals;
    if (option.kind == Kind::Output) return value;
    if (!readsPath(option)) return "";
    if (option.kind == Kind::Direction && parseDirection(value, direction)) return "";
    if (option.kind == Kind::NamedImage) return value.substr(std::min(value.find('='), value.size() - 1) + 1);
    const bool hole = option.kind == Kind::Hole;
    if (hole && (readBox(value, box) || readWorldBox(value, reals))) return "";
    if ((hole || option.kind == Kind::Region) && value == "auto") return "";
    return splitGridPath(value).file;
}

}  // namespace vdbsynth::cli
