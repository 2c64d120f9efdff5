#pragma once
#include "tools/vdb_synth/option_set.h"

#include <functional>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// Standard input and output as files. The path `-.EXT` (or `-` where the content tells what it is, or --as
/// EXT does) means standard input among the inputs, and `-.EXT` standard output after -o. What comes in is
/// kept in a temporary file, since readers go over a file more than once; what goes out is written whole
/// before a byte of it leaves. Both lie in a folder of their own below TMPDIR that only this user can open.
class Streams {
public:
    /// @param onTemporary  told each temporary's path before it is made, and that of their folder when it is
    explicit Streams(std::function<void(const std::string&)> onTemporary)
        : mOnTemporary(std::move(onTemporary)) {}
    ~Streams();
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;

    /// @param inputsAreOutputs  the inputs are the names of what is written, as those of `make`
    /// The arguments with paths of temporaries in the place of streams; reads standard input to its end.
    /// @throw Error InvalidOption (two inputs from it, two outputs to it, no extension to tell its kind), Io
    Arguments spooled(Arguments arguments, bool inputsAreOutputs);
    /// Copies what was written for standard output to it. @throw Error Io
    void release();
    /// A message with the streams' names where it has those of their temporaries.
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
