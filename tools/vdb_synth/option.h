#pragma once
#include <map>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// The kind of an option's value; option_value.h reads each kind.
enum class Kind {
    Flag,         ///< no value
    Text,         ///< anything
    Choice,       ///< one of `choices`
    AxisChoices,  ///< one of `choices`, or one for each axis with commas
    Axes,         ///< "xy", or "none"
    Whole,        ///< a whole number from `low` to `high`, odd where `odd` is set
    Real,         ///< a number from `low` to `high`
    Lengths,      ///< one to three numbers with commas, each from `low` to `high`
    Seed,         ///< a whole number of up to 64 bits
    Bytes,        ///< at least 1M, with an optional K, M, G or T (powers of 1000)
    Triple,       ///< three numbers with commas
    WholeTriple,  ///< three whole numbers, each from `low` to `high`
    Range,        ///< two numbers with a comma, the first not above the second
    Box,          ///< i,j,k,I,J,K, both corners inclusive
    SheetSizes,   ///< two sizes, each a length or a multiple such as 4x
    Sizes,        ///< three sizes, each in voxels or a multiple such as 2x
    Pixels,       ///< WIDTHxHEIGHT, each from `low` to `high`
    Slice,        ///< an axis and a fraction: z=0.5
    Labels,       ///< numbers and ranges with commas: 1,4,10-20
    Frames,       ///< numbers of frames: 1-20, 1-20x2, 1,4,10-12
    Process,      ///< "make KIND", "make KIND --feature F"
    Direction,    ///< axis:x, around:y, radial, curvature, a grid, or a file of strokes
    Hole,         ///< auto, a box, or a model
    Region,       ///< auto, a model, or FILE.vdb:GRID
    File,         ///< a file to read, of `extensions`
    NamedImage,   ///< NAME=FILE, an image to read
    Model,        ///< a file to read, of any kind that converts to a level set
    Grid,         ///< FILE.vdb or FILE.vdb:GRID, to read
    ModelOrGrid,  ///< either
    Folder,       ///< a folder to keep files in
    Output        ///< a file to write, of `extensions`; none: any kind of model file; "*": any file
};

enum class Unit { None, Voxels, World, Pixels, Radians };

/// Headings of --help, in this order.
enum class Group { Result, Method, Controls, Output, Input, Raster, Running };

/// A word that an option accepts and, where the word does not explain itself, its meaning.
struct Choice {
    std::string word, meaning;
};

/// Open ends of ranges, which help does not show.
inline constexpr double kAboveZero = 1e-30, kUnbounded = 1e30;
/// The voxel farthest from the origin that an option accepts.
inline constexpr double kFarVoxel = 99999999;

/// One option, described once: parsing, validation, help and metadata derive from it. The table is in
/// options.h. The setters at the end return *this, so that each table entry reads as a sentence.
struct Option {
    std::string name;      ///< without dashes
    std::string argument;  ///< what --help shows for its value; empty for a flag
    std::string help;      ///< what it does; unit, range, choices and default are added (helpLine)
    std::string note;      ///< a remark, printed last
    Kind kind = Kind::Flag;
    Group group = Group::Result;
    Unit unit = Unit::None;
    char letter = 0;  ///< short form, 0: none
    double low = -kUnbounded, high = kUnbounded;
    bool odd = false;
    std::vector<Choice> choices;
    bool orExtension = false;             ///< of a Choice: also the extension of any readable file
    std::vector<std::string> extensions;  ///< without dots
    std::string initial;                  ///< the value if none is given; empty: none
    std::string otherwise;                ///< the default in words, if it is no fixed value
    std::vector<std::string> commands;    ///< that take it
    bool repeats = false;                 ///< may be given several times
    bool incidental = false;              ///< changes how a run proceeds or where it writes, not its result
    bool valueOptional = false;           ///< the next word is its value only if it has one of `extensions`
    /// Fields of the library's option structs that the option sets; the library's errors name these.
    std::vector<std::string> fields;
    std::map<std::string, std::string> valueOf;  ///< the option's value that sets a field
    std::vector<std::string> oldNames;           ///< refused, with a hint at the present name

    /// What differs for one command; applied in optionsOf.
    struct Change {
        std::string command;
        void (*apply)(Option&);
    };
    std::vector<Change> changes;

    Option& says(const std::string& text) { return help = text, *this; }
    Option& noting(const std::string& text) { return note = text, *this; }
    Option& in(Group g) { return group = g, *this; }
    Option& measuredIn(Unit u) { return unit = u, *this; }
    Option& shortly(char l) { return letter = l, *this; }
    Option& from(double least, double most) { return low = least, high = most, *this; }
    Option& initially(const std::string& value) { return initial = value, *this; }
    Option& otherwiseIs(const std::string& words) { return otherwise = words, *this; }
    Option& takenBy(const std::vector<std::string>& names) { return commands = names, *this; }
    Option& orAnExtension() { return orExtension = true, *this; }
    Option& repeatable() { return repeats = true, *this; }
    Option& ofTheRun() { return incidental = true, *this; }
    Option& sets(const std::vector<std::string>& names) { return fields = names, *this; }
    Option& setsBy(const std::string& value, const std::string& field) {
        return valueOf[field] = value, *this;
    }
    Option& was(const std::string& old) { return oldNames.push_back(old), *this; }
    Option& butFor(const std::string& command, void (*apply)(Option&)) {
        return changes.push_back({command, apply}), *this;
    }
};

/// The heading of a group in --help and in manual pages.
const char* headingOf(Group group);

/// "longest-run" as "longestRun".
std::string camelCase(const std::string& name);

/// True for a path that is read; metadata holds only the file's name.
bool readsPath(const Option& option);
/// True for a path that is written, or a folder.
bool writesPath(const Option& option);

/// "4 to 256", "above 0", empty where there is none.
std::string rangeText(const Option& option);
/// What a value must be, to follow "must be": "a whole number from 4 to 256".
std::string allowedText(const Option& option);
/// The text of --help: what it does, unit, range or choices, default.
std::string helpLine(const Option& option);

}  // namespace vdbsynth::cli
