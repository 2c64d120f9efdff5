#pragma once
#include "tools/vdb_synth/option_value.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli {

/// The value of an option that was given without one.
inline const std::string kNoValue = "(none)";

/// What was given to one command on the command line and in --config. Readers return the given value, else
/// the option's default, else nothing of its type (0, "", {}); `has` distinguishes these. Ranges are the
/// options' own: after `check` no reader fails.
class Arguments {
public:
    Arguments() = default;
    explicit Arguments(std::string command) : mCommand(std::move(command)) {}

    std::vector<std::string> inputs;
    std::map<std::string, std::vector<std::string>> values;  ///< flags hold one "true"

    /// Refuses every value that its option does not allow, whether or not the command reads it. Opens no
    /// file. @throw Error InvalidOption that names the option, the value and what is allowed
    void check() const;
    /// All options that affect the result, defaults included, each value in one normal form; of paths only
    /// the names of files. `incidental` options are left out.
    std::map<std::string, std::vector<std::string>> normalised() const;

    const std::string& command() const { return mCommand; }
    /// True if the command takes the option.
    bool takes(const std::string& name) const;
    /// True if it was given.
    bool has(const std::string& name) const { return values.count(name) > 0; }
    std::string text(const std::string& name) const;
    std::vector<std::string> all(const std::string& name) const;
    int whole(const std::string& name) const;
    double real(const std::string& name) const;
    std::uint64_t wide(const std::string& name) const;  ///< Seed, Bytes
    std::vector<double> lengths(const std::string& name) const;
    std::array<double, 3> triple(const std::string& name) const;
    Index3 wholeTriple(const std::string& name) const;
    std::pair<double, double> range(const std::string& name) const;
    BoxValue box(const std::string& name) const;
    std::array<SizeValue, 2> sheetSizes(const std::string& name) const;
    std::array<SizeValue, 3> sizes(const std::string& name) const;
    std::array<int, 2> pixels(const std::string& name) const;
    SliceValue slice(const std::string& name) const;
    std::vector<std::pair<double, double>> labels(const std::string& name) const;
    std::array<bool, 3> axes(const std::string& name) const;

private:
    std::string mCommand;
};

/// Parses a command line (Boost.Program_options): `-o X`, `--option X`, `--option=X` and `-option X`. Values
/// are checked later, by Arguments::check.
/// @throw Error InvalidOption (unknownOption; a missing value; one given twice)
Arguments parseArguments(const std::string& command, const std::vector<std::string>& words);

/// Adds the options and inputs of --config that the command line does not give.
/// @throw Error Io (no such file), BadData (no JSON object), InvalidOption (unknownOption; several values)
void mergeConfig(Arguments& arguments);

/// Refuses an output that is one of the files this run reads, by any path, unless --force is given.
/// @param inputsAreOutputs  the inputs are the names of the files to write, as for `make`
/// @throw Error InvalidOption that names both
void refuseOverwriting(const Arguments& arguments, bool inputsAreOutputs);

}  // namespace vdbsynth::cli
