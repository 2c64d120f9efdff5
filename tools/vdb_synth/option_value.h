#pragma once
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/procedural/exemplar.h"
#include "tools/vdb_synth/option.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli {

/// A length of a Kind::Sizes: in voxels, in world units, or as a multiple of the exemplar's domain.
struct SizeValue {
    double value = 0;
    bool multiple = false;
    bool world = false;  ///< "2.5w": a length in world units
};

/// A Kind::Box: i,j,k,I,J,K. Whole numbers are voxels, both corners inclusive; lengths in world units (1.5w)
/// hold the voxels whose centres lie from the lower one up to, but not on, the upper one.
using BoxValue = std::array<SizeValue, 6>;

/// A Kind::Slice: an axis and a position along it.
struct SliceValue {
    int axis = 2;
    double fraction = 0.5;
};

/// FILE.vdb or FILE.vdb:GRID.
struct GridPath {
    std::string file, grid;
};

// Readers of values, by their kind. Each reads the whole text and returns false if it does not parse. Ranges
// are checked by normalValue. The locale does not matter.
bool readWhole(const std::string& text, long long& value);
bool readReal(const std::string& text, double& value);
bool readSeed(const std::string& text, std::uint64_t& value);
bool readBytes(const std::string& text, std::uint64_t& value);
bool readLengths(const std::string& text, std::vector<double>& lengths);
bool readTriple(const std::string& text, std::array<double, 3>& values);
bool readWholeTriple(const std::string& text, Index3& values);
bool readRange(const std::string& text, double& low, double& high);
bool readBox(const std::string& text, BoxValue& box);
/// Three numbers (world), each with or without a `w`.
bool readWorldTriple(const std::string& text, std::array<double, 3>& values);
/// A Kind::Hole of Unit::World: finite, every minimum below its maximum, with or without a `w`.
bool readWorldBox(const std::string& text, std::array<double, 6>& values);
bool readSheetSizes(const std::string& text, std::array<SizeValue, 2>& sizes);
bool readSizes(const std::string& text, std::array<SizeValue, 3>& sizes);
bool readPixels(const std::string& text, int& width, int& height);
bool readSlice(const std::string& text, SliceValue& slice);
bool readLabels(const std::string& text, std::vector<std::pair<double, double>>& labels);
/// "1-20", "1-20x2" (every second), "1,4,10-12": numbers from 0 to 9999999 in the order given, at most 100
/// 000.
bool readFrames(const std::string& text, std::vector<int>& frames);
bool readAxes(const std::string& text, std::array<bool, 3>& axes);
/// "make KIND [--feature F]": the kind and its feature only.
bool readProcess(const std::string& text, ExemplarOptions& options);
GridPath splitGridPath(const std::string& text);
/// True for FILE.vdb and FILE.vdb:GRID.
bool namesGrid(const std::string& text);
/// NAME=FILE: a name of letters, digits and _, and an image's path.
bool readNamedImage(const std::string& text, std::pair<std::string, std::string>& image);
/// One choice for each axis from a Kind::AxisChoices.
std::array<std::string, 3> splitAxisChoices(const std::string& text);

/// "a,b,,c" is four parts.
std::vector<std::string> splitAtCommas(const std::string& text);

/// @throw Error InvalidOption "--NAME VALUE: must be RANGE"
[[noreturn]] void refuseValue(const Option& option, const std::string& given);

/// Refuses a value that is not of the option's kind or out of its range; opens no file.
/// @return the value in the one normal form that metadata holds, however it was typed; of paths that are read
/// only the names of files
/// @throw Error InvalidOption that names the option, the value and what is allowed
std::string normalValue(const Option& option, const std::string& given);

/// The file that a value names, if the option reads or writes one; else empty.
std::string pathIn(const Option& option, const std::string& value);

}  // namespace vdbsynth::cli
