#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/machine_memory.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/model_unit.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/read/metadata_format.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/stop_flag.h"
#include "tools/vdb_synth/surface_json.h"
#include "tools/vdb_synth/version.h"
#include "tools/vdb_synth/volume_report.h"
#include "tools/vdb_synth/wall_report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <set>

#include <unistd.h>

namespace vdbsynth::cli {
namespace {

ProgressStyle progressStyle(const Arguments& arguments) {
    const std::string style = arguments.text("progress");
    if (style == "bar") return ProgressStyle::Bar;
    if (style == "json") return ProgressStyle::Json;
    if (style == "lines") return ProgressStyle::Lines;
    if (style == "off" || arguments.has("quiet")) return ProgressStyle::Off;
    return ::isatty(2) ? ProgressStyle::Bar : ProgressStyle::Lines;
}

nlohmann::json asJson(const std::vector<std::string>& values) {
    if (values.size() == 1) return values.front();
    return values;
}

}  // namespace

struct Run::Impl {
    const Command& command;
    SupervisorLine line;
    ProgressLog progress;
    FrameCache* frames = nullptr;
    int loads = 0;
    bool quiet = false, verbose = false, reading = false;
    std::vector<std::pair<std::string, std::string>> inputs{};  // name, hash
    std::set<std::string> units{};                              // that the models read name
    nlohmann::json counts = nlohmann::json::object(), quality{};
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

    // As given, so that --config replays the run.
    static nlohmann::json givenOptions(const Arguments& arguments) {
        nlohmann::json json = nlohmann::json::object();
        for (const auto& [name, values] : arguments.values)
            if (name != "report" && name != "config")
                json[name] = values.front() == kNoValue ? nlohmann::json(true) : asJson(values);
        json["inputs"] = arguments.inputs;
        return json;
    }

    static nlohmann::json normalisedOptions(const Arguments& arguments) {
        nlohmann::json json = nlohmann::json::object();
        for (const auto& [name, values] : arguments.normalised()) json[name] = asJson(values);
        return json;
    }
};

Run::Run(const Command& command, Arguments given, const SupervisorLine& line, FrameCache* frames)
    : mStreams(new Streams([line](const std::string& path) { line.temporary(path); })),
      arguments(mStreams->spooled(std::move(given), command.inputsAreOutputs)),
      mImpl(new Impl{command, line, ProgressLog(progressStyle(arguments))}) {
    Impl& impl = *mImpl;
    impl.frames = frames;
    impl.quiet = arguments.has("quiet");
    impl.verbose = arguments.has("verbose");
    context.seed = arguments.wide("seed");
    context.threads = arguments.whole("threads");
    context.maxMemory = arguments.has("max-memory") ? arguments.wide("max-memory") : presentMemory() / 10 * 8;
    context.cancel = stopFlag();
    context.onProgress = [&impl](const Progress& progress) {
        if (progress.reading)
            impl.line.reading(progress.stage.substr(progress.stage.find(' ') + 1));
        else if (impl.reading)
            impl.line.doneReading();
        else
            impl.line.alive();
        if (progress.reading && progress.done == progress.total) impl.line.doneReading();
        impl.reading = progress.reading;
        impl.progress.update(progress);
    };
    context.onMessage = [this, &impl](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Detail && !impl.verbose) return;
        if (level != MessageLevel::Warning && impl.quiet) return;
        impl.progress.clear();
        std::fprintf(stderr, "vdb_synth: %s%s\n", level == MessageLevel::Warning ? "warning: " : "",
                     printableText(inWords(text)).c_str());
    };
    mOutputs = std::make_unique<OutputSet>([&impl](const std::string& path) { impl.line.temporary(path); });
}

std::string Run::withoutTemporaries(const std::string& text) const {
    return mStreams->named(mOutputs ? mOutputs->withoutTemporaries(text) : text);
}

std::string Run::inWords(const std::string& text) const {
    return withoutTemporaries(inFlags(text, mImpl->command.name));
}

Run::~Run() {
    mImpl->progress.clear();
}

std::vector<std::string> Run::outputPaths() const {
    const std::vector<std::string> paths = arguments.all("output");
    if (paths.empty())
        throw Error(ErrorCode::InvalidOption, "--output: missing; name the result's file with -o FILE");
    return paths;
}

std::string Run::outputPath() const {
    return outputPaths().front();
}

void Run::requireInputs(std::size_t low, std::size_t high) const {
    const std::size_t given = arguments.inputs.size();
    if (given < low)
        throw Error(ErrorCode::InvalidOption, std::string(given == 0 ? "no input" : "too few inputs") +
                                                  "; usage: vdb_synth " + mImpl->command.usage);
    if (given > high)
        throw Error(
            ErrorCode::InvalidOption,
            arguments.inputs[high] + ": one input too many; usage: vdb_synth " + mImpl->command.usage);
}

namespace {

void readRasterOptions(const Arguments& arguments, ModelOptions& options) {
    const std::vector<double> sides = arguments.lengths("pixel-size");
    if (sides.size() == 1) options.heights.pixelSize = options.volume.pixelSize = sides[0];
    if (sides.size() > 1)
        options.heights.pixelSides =
            options.volume.pixelSides = {sides[0], sides[1], sides.size() > 2 ? sides[2] : 0};
    options.heights.height = arguments.real("height");
    // relief-extract has another option of that name.
    const Option* base = findOption(arguments.command(), "base");
    if (base && base->kind == Kind::Real) options.heights.base = arguments.real("base");
    const std::string plane = arguments.text("plane");
    options.heights.plane = plane == "yz"   ? HeightPlane::YZ
                            : plane == "zx" ? HeightPlane::ZX
                                            : HeightPlane::XY;
    if (arguments.has("threshold")) options.volume.threshold = arguments.real("threshold");
    if (arguments.has("below")) options.volume.below = arguments.real("below");
    options.volume.labels = arguments.labels("labels");
    if (arguments.has("threshold") && arguments.has("labels"))
        throw Error(ErrorCode::InvalidOption, "--threshold and --labels: give one of them");
    for (const char* other : {"threshold", "labels"})
        if (arguments.has("below") && arguments.has(other))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--below and --") + other + ": give one of them");
}

}  // namespace

ModelOptions Run::modelOptions() const {
    ModelOptions options;
    options.voxelSize = arguments.real("voxel-size");
    options.resolution = arguments.whole("resolution");
    if (arguments.has("voxel-size") && arguments.has("resolution"))
        throw Error(ErrorCode::InvalidOption, "--voxel-size and --resolution: give one of them");
    // Commands that write no level set use the library's default; repeat uses the map's.
    if (!arguments.text("half-width").empty()) options.halfWidth = arguments.real("half-width");
    const bool shell = arguments.text("open") == "shell";
    if (shell) options.solid.open = OpenMesh::Shell;
    options.solid.thickness = arguments.real("thickness");
    if (shell != arguments.has("thickness"))
        throw Error(ErrorCode::InvalidOption,
                    "--open shell and --thickness W: give both, the thickness of the shell in world units");
    readRasterOptions(arguments, options);
    options.grid = arguments.text("grid");
    if (arguments.has("unit-scale")) options.unitScale = arguments.real("unit-scale");
    if (arguments.has("iso")) options.iso = arguments.real("iso");
    return options;
}

void Run::reserveOutputs() {
    if (mImpl->command.inputsAreOutputs)
        for (std::size_t i = 1; i < arguments.inputs.size(); ++i) mOutputs->reserve(arguments.inputs[i]);
    for (const Option& option : optionsOf(mImpl->command.name))
        if (option.kind == Kind::Output)
            for (const std::string& path : arguments.all(option.name))
                if (path != kNoValue) mOutputs->reserve(path);
}

void Run::noteInput(const std::string& path) {
    mImpl->inputs.emplace_back(fileNameOf(mStreams->named(path)), fileHash(path));
}

LevelSet Run::load(const std::string& path) {
    return load(path, modelOptions());
}

LevelSet Run::load(const std::string& path, const ModelOptions& given) {
    reserveOutputs();
    ModelOptions options = given;
    if (arguments.has("report")) options.keepSource = true;  // the report compares with it
    // The same command loads the same file with the same options, every frame.
    const std::string name = "model " + std::to_string(mImpl->loads++) + " " + path;
    const auto model = shared<LevelSet>(
        name, {path}, [&] { return std::make_shared<LevelSet>(loadModel(path, options, context)); });
    noteInput(path);
    const std::string unit = unitOf(*model);
    if (!unit.empty()) mImpl->units.insert(unit);
    // What one frame does to its grids does not reach the next.
    return mImpl->frames ? withOwnGrids(*model) : *model;
}

FrameCache* Run::frames() const {
    return mImpl->frames;
}

VdbMetadata Run::metadata() const {
    nlohmann::json inputs = nlohmann::json::array();
    for (const auto& [name, hash] : mImpl->inputs) inputs.push_back({{"name", name}, {"hash", hash}});
    return {{kMetadataFormatKey, std::to_string(kMetadataFormat)},
            {"vdbsynth:version", kVersion},
            {"vdbsynth:command", mImpl->command.name},
            {"vdbsynth:options", Impl::normalisedOptions(arguments).dump(
                                     -1, ' ', false, nlohmann::json::error_handler_t::replace)},
            {"vdbsynth:seed", std::to_string(context.seed)},
            {"vdbsynth:inputs", inputs.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)}};
}

void Run::describeOutputs(ModelOutputOptions& outputs) const {
    outputs.metadata = metadata();
    outputs.name = arguments.text("name");
    outputs.half = arguments.has("half");
    outputs.values = volumeValues(*this);
    outputs.unit = unit();
    if (arguments.has("values") && !writesVolume(*this))
        message(context, MessageLevel::Note, "`values` has no effect without a volume to write");
}

std::string Run::unit() const {
    return mImpl->units.size() == 1 ? *mImpl->units.begin() : "";
}

void Run::count(const std::string& name, const nlohmann::json& value) {
    mImpl->counts[name] = value;
}

GridPtr Run::loadGrid(const std::string& option) {
    return loadGrid(option, arguments.text(option));
}

GridPtr Run::loadGrid(const std::string& option, const std::string& text) {
    const auto [path, name] = splitGridPath(text);
    reserveOutputs();
    GridPtr grid;
    if (!name.empty()) {
        grid = readVdbGrid(path, name, context);
    } else {
        const std::vector<GridPtr> grids = readVdbGrids(path, context);
        if (grids.size() != 1)
            throw Error(ErrorCode::BadData, path + ": holds " + std::to_string(grids.size()) +
                                                " grids; name the one for --" + option + " as " + path +
                                                ":GRID");
        grid = grids.front();
    }
    noteInput(path);
    return grid;
}

void Run::describe(const LevelSet& result) {
    count("active_voxels", activeVoxels(*result.grid));
    reportWall(*this, result);
    if (!arguments.has("report")) return;
    reportVolume(*this, result);
    if (result.source) count("input_surface", surfaceJson(*result.source, context));
    count("surface", surfaceJson(levelSetToMesh(*result.grid, {}, context), context));
    count("lost_share", lostShare(*result.grid));
    const BandQuality band = measureBand(*result.grid, context);
    mImpl->quality = {{"gradient_error_mean", band.gradientErrorMean},
                      {"gradient_error_p99", band.gradientErrorP99},
                      {"band_gaps", band.missingNeighbours},
                      {"finite", band.finite}};
}

void Run::write(const std::string& path, const std::string& text) {
    std::ofstream file(mOutputs->add(path), std::ios::binary);
    file << text;
    file.close();
    if (!file) throw Error(ErrorCode::Io, path + ": writing failed; the disk may be full");
}

void Run::answer(const std::string& json) {
    if (arguments.has("output"))
        write(outputPath(), json + "\n");
    else
        printLine(json);
}

void Run::finish() {
    Impl& impl = *mImpl;
    if (arguments.has("report")) {
        nlohmann::json stages = nlohmann::json::array();
        for (const StageRecord& stage : impl.progress.finish())
            stages.push_back(
                {{"name", stage.name}, {"seconds", stage.seconds}, {"peak_bytes", stage.peakBytes}});
        nlohmann::json inputs = nlohmann::json::array();
        for (const auto& [name, hash] : impl.inputs) inputs.push_back({{"name", name}, {"hash", hash}});
        const nlohmann::json report{
            {"program", "vdb_synth"},
            {"version", kVersion},
            {"command", impl.command.name},
            {"options", Impl::givenOptions(arguments)},
            {"seed", context.seed},
            {"inputs", inputs},
            {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - impl.began).count()},
            {"peak_bytes", peakMemory()},
            {"stages", stages},
            {"counts", impl.counts},
            {"quality", impl.quality}};
        write(
            arguments.text("report"),
            withoutTemporaries(report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)) + "\n");
    }
    throwIfCancelled(context);
    mOutputs->commit();
    impl.progress.finish();
    mStreams->release();
}

void printLine(const std::string& text) {
    std::printf("%s\n", text.c_str());
}

}  // namespace vdbsynth::cli
