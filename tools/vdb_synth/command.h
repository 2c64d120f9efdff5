#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/pipeline/model.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tools/vdb_synth/option_set.h"
#include "tools/vdb_synth/progress.h"
#include "tools/vdb_synth/streams.h"
#include "tools/vdb_synth/supervisor.h"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace vdbsynth::cli {

struct Command;

/// One run of a command: its arguments, context, outputs and report. Made by main, used by the command.
class Run {
    std::unique_ptr<Streams> mStreams;  // first: `arguments` comes out of it

public:
    Run(const Command& command, Arguments arguments, const SupervisorLine& line);
    ~Run();

    /// As given, with files in the place of standard input and output.
    const Arguments arguments;
    RunContext context;

    /// Paths given with -o, at least one. @throw Error InvalidOption
    std::vector<std::string> outputPaths() const;
    /// The only path given with -o. @throw Error InvalidOption
    std::string outputPath() const;
    /// @throw Error InvalidOption unless low <= number of inputs <= high
    void requireInputs(std::size_t low, std::size_t high) const;
    OutputSet& outputs() { return *mOutputs; }
    /// A message with the outputs' and streams' names where it has those of temporaries.
    std::string withoutTemporaries(const std::string& text) const;
    /// The same with options where the library names fields of its structs (inFlags).
    std::string inWords(const std::string& text) const;

    /// Options of loadModel from the common options.
    ModelOptions modelOptions() const;
    /// loadModel, noting the file's name and hash for metadata and report.
    LevelSet load(const std::string& path);
    LevelSet load(const std::string& path, const ModelOptions& options);
    /// Reads the one grid of the file that an option names, or that of FILE.vdb:GRID. @throw Error BadData
    GridPtr loadGrid(const std::string& option);
    GridPtr loadGrid(const std::string& option, const std::string& text);
    /// Makes sure that all outputs can be written, before the work; `load` calls it.
    void reserveOutputs();
    /// Notes an input that is not read through `load`.
    void noteInput(const std::string& path);
    /// File metadata of every VDB output.
    VdbMetadata metadata() const;
    /// Adds a number or text to the report's "counts".
    void count(const std::string& name, const nlohmann::json& value);
    /// Adds what a resulting level set is to the report: its size to "counts", its band to "quality".
    void describe(const LevelSet& result);
    /// Writes a file that is text: an output, or what an option names. @throw Error Io
    void write(const std::string& path, const std::string& text);
    /// The answer of a command that makes no model: JSON to -o where that is given, else to standard output.
    /// @throw Error Io
    void answer(const std::string& json);
    /// Writes --report if asked for and renames all outputs into place.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
    std::unique_ptr<OutputSet> mOutputs;
};

/// One command of the tool; options.h says which options it takes.
struct Command {
    std::string name, usage, summary, example;
    void (*run)(Run&);              ///< finds what is wrong with its options before it reads a file
    bool inputsAreOutputs = false;  ///< its inputs name what is written
};

/// The only registry of commands.
const std::vector<const Command*>& commands();
/// Null if there is none of that name.
const Command* findCommand(const std::string& name);

/// `vdb_synth COMMAND --help`: its options in groups, see options.h.
std::string helpText(const Command& command);

/// Data for standard output.
void printLine(const std::string& text);

extern const Command kAnalogy, kCompare, kConvert, kInfo, kCrop, kMask, kMatch, kSynth, kRepeat, kRender,
    kMake;

}  // namespace vdbsynth::cli
