#pragma once
#include "tools/vdb_synth/option_set.h"

#include <functional>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// Standard input and output as files. The path `-.EXT` means standard input among the inputs (or `-` where
/// the content shows its kind or --as EXT names it), and standard output after -o. Input is stored in a
/// temporary file, since readers read a file more than once; output is complete before its first byte is
/// sent. Both are in a folder of their own below TMPDIR that only this user can open.
class Streams {
public:
    /// @param onTemporary  called with each temporary path before it is created, and with their folder's
    explicit Streams(std::function<void(const std::string&)> onTemporary)
        : mOnTemporary(std::move(onTemporary)) {}
    ~Streams();
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;

    /// @param inputsAreOutputs  the inputs are the names of the files to write, as for `make`
    /// The arguments with temporary paths in place of streams; reads standard input to its end.
    /// @throw Error InvalidOption (two inputs from it, two outputs to it, no extension for its kind), Io
    Arguments spooled(Arguments arguments, bool inputsAreOutputs);
    /// Copies the temporary output to standard output. @throw Error Io
    void release();
    /// A message with the streams' names in place of their temporary files' names.
    std::string named(std::string text) const;

private:
    struct Stream {
        std::string name, temporary;
        bool output;
    };
    std::string open(const std::string& name, const std::string& extension, bool output);
    void readInput(std::string& path, const Arguments& arguments);

    std::vector<Stream> mStreams;
    std::string mFolder;  // empty until one is needed
    std::function<void(const std::string&)> mOnTemporary;
};

}  // namespace vdbsynth::cli
