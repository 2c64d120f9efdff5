#pragma once
#include <map>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// What the value of an option is; option_value.h reads each kind.
enum class Kind {
    Flag,         ///< no value
    Text,         ///< anything
    Choice,       ///< one of `choices`
    AxisChoices,  ///< one of `choices`, or one for each axis with commas
    Axes,         ///< "xy", or "none"
    Whole,        ///< a whole number from `low` to `high`, odd where `odd` is set
    Real,         ///< a number from `low` to `high`
    Seed,         ///< a whole number of up to 64 bits
    Bytes,        ///< at least 1M, with an optional K, M, G or T (powers of 1000)
    Triple,       ///< three numbers with commas
    WholeTriple,  ///< three whole numbers, each from `low` to `high`
    Range,        ///< two numbers with a comma, the first not above the second
    Box,          ///< i,j,k,I,J,K, both corners inclusive
    Sizes,        ///< three sizes, each in voxels or a multiple such as 2x
    Pixels,       ///< WIDTHxHEIGHT, each from `low` to `high`
    Slice,        ///< an axis and a fraction: z=0.5
    Labels,       ///< numbers and ranges with commas: 1,4,10-20
    Process,      ///< "make KIND", "make KIND --feature F"
    Direction,    ///< axis:x, around:y, radial, curvature, a grid, or a file of strokes
    Hole,         ///< auto, a box, or a model
    File,         ///< a file to read, of `extensions`
    Model,        ///< a file to read, of any kind that is made a level set
    Grid,         ///< FILE.vdb or FILE.vdb:GRID, to read
    ModelOrGrid,  ///< either
    Folder,       ///< a folder to keep files in
    Output        ///< a file to write, of `extensions`; none: what a model is written as; "*": any
};

enum class Unit { None, Voxels, World, Pixels, Radians };

/// Headings of --help, in this order.
enum class Group { Result, Method, Controls, Output, Input, Raster, Running };

/// A word that an option may be and, where the word does not say it, what it means.
struct Choice {
    std::string word, meaning;
};

/// Ends of ranges that are open: not said in help.
inline constexpr double kAboveZero = 1e-30, kUnbounded = 1e30;
/// The farthest voxel from the origin that an option takes.
inline constexpr double kFarVoxel = 99999999;

/// One option, described once: from this come parsing, validation, help and metadata. The table is in
/// options.h. The functions at the end fill a description in, so that the table reads as sentences.
struct Option {
    std::string name;      ///< without dashes
    std::string argument;  ///< what --help shows for its value; empty for a flag
    std::string help;      ///< what it does; unit, range, choices and default are added (helpLine)
    std::string note;      ///< what else there is to know, said last
    Kind kind = Kind::Flag;
    Group group = Group::Result;
    Unit unit = Unit::None;
    char letter = 0;  ///< short form, 0: none
    double low = -kUnbounded, high = kUnbounded;
    bool odd = false;
    std::vector<Choice> choices;
    bool orExtension = false;  ///< of a Choice: also the extension of any kind of file that is read
    std::vector<std::string> extensions;  ///< without dots
    std::string initial;                  ///< the value where none is given; empty: none
    std::string otherwise;  ///< what holds where none is given, in words, if that is no fixed value
    std::vector<std::string> commands;  ///< that take it
    bool repeats = false;               ///< may be given several times
    bool incidental = false;            ///< changes how a run goes or where it writes, not what it makes
    bool valueOptional = false;         ///< the next word is its value only if it has one of `extensions`
    /// Fields of the library's option structs that it sets; errors of the library name those.
    std::vector<std::string> fields;
    std::map<std::string, std::string> valueOf;  ///< the option's value that stands for a field being set
    std::vector<std::string> oldNames;           ///< refused, with a hint at the present one

    /// What differs for one command: applied in optionsOf.
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

/// "longest-run" as "longestRun".
std::string camelCase(const std::string& name);

/// True for a path that is read: a file of which nothing but the name may come into metadata.
bool readsPath(const Option& option);
/// True for a path that is written, or a folder.
bool writesPath(const Option& option);

/// "4 to 256", "above 0", empty where there is none.
std::string rangeText(const Option& option);
/// What a value must be, after "must be": "a whole number from 4 to 256".
std::string allowedText(const Option& option);
/// The line of --help: what it does, unit, range or choices, default.
std::string helpLine(const Option& option);

}  // namespace vdbsynth::cli
