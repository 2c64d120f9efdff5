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

    /// Options of loadModel from the common options.
    ModelOptions modelOptions() const;
    /// loadModel, noting the file's name and hash for metadata and report.
    LevelSet load(const std::string& path);
    LevelSet load(const std::string& path, const ModelOptions& options);
    /// Reads the one grid of the mask that an option names. @throw Error InvalidOption (not .vdb), BadData
    GridPtr loadMask(const std::string& option);
    /// Reads the one grid of a file, or that of FILE.vdb:GRID. @throw Error as loadMask
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
    /// Writes --report if asked for and renames all outputs into place.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
    std::unique_ptr<OutputSet> mOutputs;
};

/// One command of the tool. The table in main.cpp is the only registry.
struct Command {
    std::string name, usage, summary, example;
    std::vector<Option> options;  ///< its own; the common ones come on top
    void (*run)(Run&);            ///< checks every option before it reads a file
};

const std::vector<Option>& commonOptions();
std::string helpText(const Command& command);

/// Data for standard output.
void printLine(const std::string& text);

extern const Command kAnalogy, kCompare, kConvert, kInfo, kCrop, kMask, kMatch, kSynth, kRepeat, kRender,
    kMake;

}  // namespace vdbsynth::cli
