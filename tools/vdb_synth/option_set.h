#pragma once
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// Value of an option whose value was left out.
inline const std::string kNoValue = "(none)";

/// One option of a command.
struct Option {
    std::string name;      ///< without dashes
    std::string argument;  ///< what --help shows for its value; empty: a flag
    std::string help;      ///< one line; lengths are marked (voxels) or (world)
    bool repeats = false;  ///< may be given several times
    char letter = 0;       ///< short form, 0: none
    std::string ending =
        "";  ///< not empty: the value may be left out; the next word is it only if it ends so
};

/// What was given on the command line and in --config, as text; typed readers check ranges. Every reader
/// throws Error InvalidOption that names the option, the value and what is allowed.
class Arguments {
public:
    std::vector<std::string> inputs;
    std::map<std::string, std::vector<std::string>> values;  ///< flags hold one "true"

    /// What the typed readers read, defaults included, each in one form: what a run did, however it was
    /// typed.
    const std::map<std::string, std::string>& normalised() const { return mNormalised; }
    /// Notes an option's normalised value; for commands that parse one themselves.
    void note(const std::string& name, const std::string& value) const { mNormalised[name] = value; }

    bool has(const std::string& name) const { return values.count(name) > 0; }
    std::string text(const std::string& name, const std::string& fallback = "") const;
    std::vector<std::string> all(const std::string& name) const;
    int whole(const std::string& name, int fallback, int low, int high) const;
    std::uint64_t wide(const std::string& name, std::uint64_t fallback) const;
    double real(const std::string& name, double fallback, double low, double high) const;
    std::array<double, 3> triple(const std::string& name, const std::array<double, 3>& fallback) const;
    IndexBox box(const std::string& name) const;
    /// Bytes, with an optional K, M, G or T (powers of 1000).
    std::uint64_t bytes(const std::string& name, std::uint64_t fallback) const;

private:
    mutable std::map<std::string, std::string> mNormalised;
};

/// Parses a command line (Boost.Program_options); `-o X`, `--option X`, `--option=X` and `-option X`.
/// @throw Error InvalidOption (unknown option, with the nearest known name; a missing value; one given twice)
Arguments parseArguments(const std::vector<Option>& options, const std::vector<std::string>& words);

/// "a,b,,c" is four parts.
std::vector<std::string> splitAtCommas(const std::string& text);

/// The nearest of `names` to `word`, empty if none is near.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

}  // namespace vdbsynth::cli
