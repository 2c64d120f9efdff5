#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tools/vdb_synth/frames.h"
#include "tools/vdb_synth/option_set.h"
#include "tools/vdb_synth/progress.h"
#include "tools/vdb_synth/streams.h"
#include "tools/vdb_synth/supervisor.h"

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vdbsynth::cli {

struct Command;

/// One run of a command: its arguments, context, outputs and report. Made by main, used by the command.
class Run {
    std::unique_ptr<Streams> mStreams;  // first: `arguments` is read from it

public:
    /// @param frames  what runs of other frames share with this one; null: this is no sequence
    Run(const Command& command, Arguments arguments, const SupervisorLine& line,
        FrameCache* frames = nullptr);
    ~Run();

    /// As given, with temporary files in place of standard input and output, and a frame's number in place of
    /// ####.
    const Arguments arguments;
    RunContext context;

    /// Paths given with -o, at least one. @throw Error InvalidOption
    std::vector<std::string> outputPaths() const;
    /// The path given with -o, of commands that write one file. @throw Error InvalidOption (none)
    std::string outputPath() const;
    /// @throw Error InvalidOption unless low <= number of inputs <= high
    void requireInputs(std::size_t low, std::size_t high) const;
    OutputSet& outputs() { return *mOutputs; }
    /// A message with the names of outputs and streams in place of their temporary files' names.
    std::string withoutTemporaries(const std::string& text) const;
    /// The same with options in place of the field names of the library's structs (inFlags).
    std::string inWords(const std::string& text) const;

    /// Options of loadModel, from the common options.
    ModelOptions modelOptions() const;
    /// loadModel; records the file's name and hash for metadata and report.
    LevelSet load(const std::string& path);
    LevelSet load(const std::string& path, const ModelOptions& options);
    /// What `make` returns; where all of `paths` are the same for every frame of a sequence, it is made once.
    template <typename T>
    std::shared_ptr<T> shared(const std::string& name, const std::vector<std::string>& paths,
                              const std::function<std::shared_ptr<T>()>& make) {
        const bool same = frames() && std::all_of(paths.begin(), paths.end(), [&](const std::string& path) {
                              return path.empty() || frames()->isShared(path);
                          });
        return same ? frames()->kept<T>(name, make) : make();
    }
    /// True in a sequence of which every frame has another file in this path's place.
    bool changesByFrame(const std::string& path) const { return frames() && !frames()->isShared(path); }
    /// Reads the grid that an option names as FILE.vdb:GRID, or a file's only grid. @throw Error BadData
    GridPtr loadGrid(const std::string& option);
    GridPtr loadGrid(const std::string& option, const std::string& text);
    /// Checks that all outputs can be written, before the work starts; `load` calls it.
    void reserveOutputs();
    /// Records an input that is not read through `load`.
    void noteInput(const std::string& path);
    /// File metadata of every VDB output.
    VdbMetadata metadata() const;
    /// The unit of the world that the models read name, empty if none does or they name several.
    std::string unit() const;
    /// Metadata, name and precision of .vdb outputs, values and unit of volumes; after all inputs are read.
    void describeOutputs(ModelOutputOptions& outputs) const;
    /// Adds a number or text to the report's "counts".
    void count(const std::string& name, const nlohmann::json& value);
    /// Adds a resulting level set to the report: its size to "counts", its band to "quality".
    void describe(const LevelSet& result);
    /// Writes a text file: an output, or one that an option names. @throw Error Io
    void write(const std::string& path, const std::string& text);
    /// Writes the JSON answer of a command that makes no model: to -o if given, else to standard output.
    /// @throw Error Io
    void answer(const std::string& json);
    /// Writes --report if asked for and renames all outputs into place.
    void finish();

private:
    FrameCache* frames() const;
    struct Impl;
    std::unique_ptr<Impl> mImpl;
    std::unique_ptr<OutputSet> mOutputs;
};

/// One command of the tool; options.h holds its options.
struct Command {
    std::string name, usage, summary, example;
    void (*run)(Run&);              ///< checks its options before it reads a file
    bool inputsAreOutputs = false;  ///< its inputs are the names of the files it writes
    bool runsOthers = false;  ///< runs other commands as processes of their own, and watches these itself
    bool ofTheProgram =
        false;  ///< tells of the program itself: in its process, under the limits it was given
};

/// The only registry of commands.
const std::vector<const Command*>& commands();
/// Null if no command has that name.
const Command* findCommand(const std::string& name);
/// Commands that are not in this build (VDBSYNTH_COMMANDS of CMake), usually none.
const std::vector<std::string>& leftOutCommands();
/// What is said of a name that is no command here: that the build leaves it out and how to build it, or that
/// it is unknown, with the nearest of `candidates`.
std::string notACommand(const std::string& name, const std::vector<std::string>& candidates,
                        const std::vector<std::string>& leftOut = leftOutCommands());

/// `vdb_synth COMMAND --help`: its options in groups, see options.h.
std::string helpText(const Command& command);

/// Prints data to standard output.
void printLine(const std::string& text);

extern const Command kAnalogy, kCompare, kConvert, kInfo, kCrop, kMask, kMatch, kSynth, kTexture, kRepeat,
    kRender, kMake, kRelief, kReliefExtract, kPatch, kBatch, kDoctor;

}  // namespace vdbsynth::cli
