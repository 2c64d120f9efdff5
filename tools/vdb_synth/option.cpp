#include "tools/vdb_synth/option.h"

#include "libvdbsynth/base/number_text.h"

#include <cctype>
#include <cmath>

namespace vdbsynth::cli {
namespace {

// Whole numbers in full, others with the fewest digits that read back exactly.
std::string numberText(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15)
        return std::to_string(static_cast<long long>(value));
    return exactText(value);
}

std::string unitText(Unit unit) {
    switch (unit) {
        case Unit::None:
            return "";
        case Unit::Voxels:
            return " (voxels)";
        case Unit::World:
            return " (world)";
        case Unit::Pixels:
            return " (pixels)";
        case Unit::Radians:
            return " (radians)";
    }
    return "";
}

// "a, b or c".
std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return text;
}

std::string listed(const std::vector<Choice>& choices, const std::string& initial, bool meanings) {
    std::vector<std::string> words;
    for (const Choice& choice : choices) {
        // A choice named default is not marked a second time.
        const bool marked = meanings && choice.word == initial && choice.word != "default";
        std::string note = meanings ? choice.meaning : "";
        if (marked) note = note.empty() ? "default" : "default: " + note;
        words.push_back(choice.word + (note.empty() ? "" : " (" + note + ")"));
    }
    return listed(words);
}

std::string extensionList(const Option& option) {
    std::vector<std::string> words;
    for (const std::string& extension : option.extensions) words.push_back("." + extension);
    return listed(words);
}

bool hasChoices(const Option& option) {
    return option.kind == Kind::Choice || option.kind == Kind::AxisChoices;
}

std::string allowedNumber(const Option& option, const std::string& noun) {
    const std::string range = rangeText(option);
    if (range.empty()) return noun;
    return noun + (option.high >= kUnbounded ? " " : " from ") + range;
}

}  // namespace

std::string camelCase(const std::string& name) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (name[i] == '-') continue;
        const bool first = i > 0 && name[i - 1] == '-';
        text += first ? char(std::toupper(static_cast<unsigned char>(name[i]))) : name[i];
    }
    return text;
}

bool readsPath(const Option& option) {
    switch (option.kind) {
        case Kind::File:
        case Kind::NamedImage:
        case Kind::Model:
        case Kind::Grid:
        case Kind::ModelOrGrid:
        case Kind::Direction:
        case Kind::Hole:
        case Kind::Region:
            return true;
        default:
            return false;
    }
}

bool writesPath(const Option& option) {
    return option.kind == Kind::Output || option.kind == Kind::Folder;
}

const char* headingOf(Group group) {
    switch (group) {
        case Group::Result:
            return "Result";
        case Group::Method:
            return "Method";
        case Group::Controls:
            return "Controls";
        case Group::Output:
            return "Output";
        case Group::Input:
            return "Input models";
        case Group::Raster:
            return "Images and volumes as input";
        case Group::Running:
            return "Running";
    }
    return "";
}

std::string rangeText(const Option& option) {
    const bool numbers = option.kind == Kind::Whole || option.kind == Kind::Lengths ||
                         option.kind == Kind::Real || option.kind == Kind::WholeTriple ||
                         option.kind == Kind::Pixels;
    if (option.kind == Kind::Bytes) return "at least 1M";
    if (!numbers || (option.low <= -kUnbounded && option.high >= kUnbounded)) return "";
    if (option.low == -kFarVoxel) return "";
    if (option.high >= kUnbounded)
        return option.low == kAboveZero ? "above 0" : "of at least " + numberText(option.low);
    return numberText(option.low) + " to " + numberText(option.high);
}

std::string allowedText(const Option& option) {
    switch (option.kind) {
        case Kind::Choice:
            return listed(option.choices, "", false) +
                   (option.orExtension ? "; for standard input also an extension" : "");
        case Kind::AxisChoices:
            return listed(option.choices, "", false) + ", once or for each axis with commas";
        case Kind::Axes:
            return "axes such as x, xy or xyz, or none";
        case Kind::Whole:
            return allowedNumber(option, option.odd ? "an odd number" : "a whole number");
        case Kind::Real:
            return allowedNumber(option, "a number");
        case Kind::Lengths:
            return allowedNumber(option, "one to three numbers") + ", with commas, for example 10,10,30";
        case Kind::Seed:
            return "a whole number from 0 to 18446744073709551615";
        case Kind::Bytes:
            return "at least 1M, for example 4G";
        case Kind::Triple:
            return std::string("three numbers with commas, for example 1,2,3") +
                   (option.unit == Unit::World ? " or 1w,2w,3w" : "");
        case Kind::WholeTriple:
            return "three whole numbers " +
                   std::string(rangeText(option).empty() ? "" : "from " + rangeText(option) + " ") +
                   "with commas, for example 64,64,32" +
                   (option.low == -kFarVoxel ? ", within 100 million voxels of the origin" : "");
        case Kind::Range:
            return "a smaller and a larger number with a comma, for example -1,0.5";
        case Kind::Box:
            return "six numbers i,j,k,I,J,K, each whole (voxels) or with a w (world), every minimum at most "
                   "its "
                   "maximum";
        case Kind::SheetSizes:
            return "two sizes with a comma, each a length above 0 (world) or a multiple such as 4x, for "
                   "example "
                   "4x,4x or 2.5,1";
        case Kind::Sizes:
            return "three sizes with commas, each in voxels (1 to 1048576), a multiple (from 1x) or a length "
                   "(world, with a w), for example 2x,2x,1x, 128,128,64 or 2.5w,2.5w,1x";
        case Kind::Pixels:
            return "WIDTHxHEIGHT, each from " + rangeText(option) + " (pixels)";
        case Kind::Slice:
            return "an axis and a fraction of the domain from 0 to 1, for example z=0.5";
        case Kind::Labels:
            return "numbers and ranges with commas, for example 1,4,10-20";
        case Kind::Frames:
            return "numbers of frames, each once, for example 1-20, 1-20x2 for every second one, or "
                   "1,4,10-12";
        case Kind::Process:
            return "such as \"make balls\" or \"make balls --feature 12\", with a feature from 4 to 256";
        case Kind::Direction:
            return std::string(
                       "axis:x|y|z or axis:-x, a vector x,y,z that is not 0, around:x|y|z, radial, ") +
                   (option.help.find("curvature") == std::string::npos ? "" : "curvature, ") +
                   "a grid FILE.vdb[:GRID], or strokes in a .csv, .json or .ply file";
        case Kind::NamedImage:
            return "NAME=FILE with an image, for example roughness=rough.png; a name of letters, digits and "
                   "_";
        case Kind::Hole:
            return option.unit == Unit::World
                       ? "a model, or a box x,y,z,X,Y,Z, every minimum below its maximum"
                       : "a model, a box i,j,k,I,J,K (voxels, or world with a w), or auto";
        case Kind::Region:
            return "a model, FILE.vdb:GRID for a grid, or auto";
        case Kind::File:
        case Kind::Output:
            return "a " + extensionList(option) + " file";
        case Kind::Grid:
            return "a .vdb file, or FILE.vdb:GRID for one of its grids";
        default:
            return "given";
    }
}

std::string helpLine(const Option& option) {
    std::string text = option.help + unitText(option.unit);
    const std::string range = rangeText(option);
    if (hasChoices(option))
        text += ": " + listed(option.choices, option.initial, true) +
                (option.kind == Kind::AxisChoices ? ", once or for each axis" : "");
    else if (!range.empty())
        text += ", " + (option.odd ? "odd, " + range : range);
    const bool marked = option.kind == Kind::Choice;
    if (!option.initial.empty() && !marked) text += "; default " + option.initial;
    if (!option.otherwise.empty()) text += "; default " + option.otherwise;
    if (!option.note.empty()) text += "; " + option.note;
    if (option.repeats) text += "; may be given several times";
    return text;
}

}  // namespace vdbsynth::cli
