#pragma once
#include <stdexcept>
#include <string>

namespace vdbsynth {

/// Why an operation failed. The command line maps every code to one exit code (see `exitCode`).
enum class ErrorCode {
    InvalidOption,  ///< an option is unknown, missing or out of its range
    ShapeMismatch,  ///< two inputs whose sizes, voxel sizes or domains do not match
    EmptyInput,     ///< a readable input with nothing in it (no faces, no active voxels)
    Unusable,       ///< a readable input that this operation cannot use
    Io,             ///< a file that is missing, a directory, not readable or not writable
    BadData,        ///< a file that is truncated, corrupt, holds NaN or an unsupported kind of grid
    Memory,         ///< more memory than allowed or present
    Solver,         ///< a numerical method did not converge
    Cancelled       ///< the caller asked for a stop; nothing was returned or written
};

/// The one exception type of the library. The message is one line that names the file, the input or the
/// options' field (in backquotes), the problem and what is valid.
class Error : public std::runtime_error {
public:
    Error(ErrorCode code, const std::string& message) : std::runtime_error(message), mCode(code) {}
    ErrorCode code() const noexcept { return mCode; }

private:
    ErrorCode mCode;
};

/// The exit code of the command line for an error: 2 for InvalidOption, 3 for Io and BadData,
/// 130 for Cancelled, 1 for all others.
int exitCode(ErrorCode code) noexcept;

/// Throws Error InvalidOption "`FIELD` VALUE: must be RANGE" unless `valid`. Messages name fields of option
/// structs in backquotes, so that a program can substitute its own names, as the command line does.
/// @param field  name of the options' field, for example longestRun
/// @param value  the refused value as text
/// @param range  the allowed range in words, for example "a whole number from 4 to 256"
void requireOption(bool valid, const std::string& field, const std::string& value, const std::string& range);

}  // namespace vdbsynth
