#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/machine_memory.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/text_scanner.h"
#include "tools/vdb_synth/stop_flag.h"
#include "tools/vdb_synth/version.h"

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
    const std::string style = arguments.text("progress", "auto");
    requireOption(style == "auto" || style == "bar" || style == "json" || style == "off", "progress", style,
                  "auto, bar, json or off");
    if (style == "bar") return ProgressStyle::Bar;
    if (style == "json") return ProgressStyle::Json;
    return style == "auto" && ::isatty(2) && !arguments.has("quiet") ? ProgressStyle::Bar
                                                                     : ProgressStyle::Off;
}

// Options that change how a run goes, not what it makes.
const std::set<std::string>& incidental() {
    static const std::set<std::string> names{"threads",     "progress",      "report",  "config",
                                             "index-cache", "quiet",         "verbose", "max-memory",
                                             "output",      "no-supervisor", "seed",    "source-map"};
    return names;
}

// Options that name a file: metadata holds its name, "inputs" its hash.
bool isPath(const std::string& name) {
    return name == "exemplar-mask" || name == "mask";
}

std::vector<std::string> fileNames(std::vector<std::string> paths) {
    for (std::string& path : paths) path = fileNameOf(path);
    return paths;
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
    bool quiet = false, verbose = false, reading = false;
    std::vector<std::pair<std::string, std::string>> inputs{};  // name, hash
    nlohmann::json counts = nlohmann::json::object(), quality{};
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();

    nlohmann::json options(const Arguments& arguments, bool normalised) const {
        nlohmann::json json = nlohmann::json::object();
        for (const auto& [name, values] : arguments.values)
            if (!normalised)
                json[name] = asJson(values);
            else if (!incidental().count(name))
                json[name] = asJson(isPath(name) ? fileNames(values) : values);
        if (normalised)
            for (const auto& [name, value] : arguments.normalised())
                if (!incidental().count(name) && !isPath(name)) json[name] = value;
        if (!normalised) {
            json["inputs"] = arguments.inputs;
            json.erase("report");
            json.erase("config");
        }
        return json;
    }
};

Run::Run(const Command& command, Arguments given, const SupervisorLine& line)
    : mStreams(new Streams([line](const std::string& path) { line.temporary(path); })),
      arguments(mStreams->spooled(std::move(given), command.name == "make")),
      mImpl(new Impl{command, line, ProgressLog(progressStyle(arguments))}) {
    Impl& impl = *mImpl;
    impl.quiet = arguments.has("quiet");
    impl.verbose = arguments.has("verbose");
    context.seed = arguments.wide("seed", 0);
    context.threads = arguments.whole("threads", 0, 0, 1024);
    context.maxMemory = arguments.bytes("max-memory", presentMemory() / 10 * 8);
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
                     withoutTemporaries(text).c_str());
    };
    mOutputs = std::make_unique<OutputSet>([&impl](const std::string& path) { impl.line.temporary(path); });
}

std::string Run::withoutTemporaries(const std::string& text) const {
    return mStreams->named(mOutputs ? mOutputs->withoutTemporaries(text) : text);
}

Run::~Run() {
    mImpl->progress.clear();
}

std::vector<std::string> Run::outputPaths() const {
    const std::vector<std::string> paths = arguments.all("output");
    if (paths.empty())
        throw Error(ErrorCode::InvalidOption, "--output: missing; say where the result goes with -o FILE");
    return paths;
}

std::string Run::outputPath() const {
    const std::vector<std::string> paths = outputPaths();
    if (paths.size() > 1)
        throw Error(ErrorCode::InvalidOption, "--output: " + mImpl->command.name + " writes one file");
    return paths.front();
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

// "1,4,10-20" as ranges.
std::vector<LabelRange> parseLabels(const std::string& text) {
    std::vector<LabelRange> labels;
    const std::string list = text + ",";
    for (std::size_t at = 0; at < list.size();) {
        const std::size_t comma = list.find(',', at), dash = list.find('-', at + 1);
        const std::string low = list.substr(at, std::min(comma, dash) - at);
        const std::string high = dash < comma ? list.substr(dash + 1, comma - dash - 1) : low;
        float values[2] = {};
        const bool good = parseReal(low, values[0]) && parseReal(high, values[1]) && values[0] <= values[1];
        requireOption(good, "labels", text, "numbers and ranges with commas, for example 1,4,10-20");
        labels.emplace_back(double(values[0]), double(values[1]));
        at = comma + 1;
    }
    return labels;
}

void readRasterOptions(const Arguments& arguments, ModelOptions& options) {
    const auto size = [&](const char* name) {
        return arguments.has(name) ? arguments.real(name, 0, 1e-30, 1e30) : 0;
    };
    options.heights.pixelSize = options.volume.pixelSize = size("pixel-size");
    options.heights.height = size("height");
    options.heights.base = size("base");
    const std::string plane = arguments.text("plane", "xy");
    requireOption(plane == "xy" || plane == "yz" || plane == "zx", "plane", plane, "xy, yz or zx");
    options.heights.plane = plane == "xy"   ? HeightPlane::XY
                            : plane == "yz" ? HeightPlane::YZ
                                            : HeightPlane::ZX;
    if (arguments.has("threshold")) options.volume.threshold = arguments.real("threshold", 0, -1e30, 1e30);
    if (arguments.has("labels")) options.volume.labels = parseLabels(arguments.text("labels"));
    if (arguments.has("threshold") && arguments.has("labels"))
        throw Error(ErrorCode::InvalidOption, "--threshold and --labels: give one of them");
}

}  // namespace

ModelOptions Run::modelOptions() const {
    ModelOptions options;
    options.voxelSize = arguments.has("voxel-size") ? arguments.real("voxel-size", 0, 1e-30, 1e30) : 0;
    options.resolution = arguments.whole("resolution", 0, 2, 100000);
    if (arguments.has("voxel-size") && arguments.has("resolution"))
        throw Error(ErrorCode::InvalidOption, "--voxel-size and --resolution: give one of them");
    options.halfWidth = arguments.real("half-width", 3, 1.5, 100);
    const std::string open = arguments.text("open", "close");
    requireOption(open == "close" || open == "shell", "open", open, "close or shell");
    if (open == "shell") options.solid.open = OpenMesh::Shell;
    options.solid.thickness = arguments.has("thickness") ? arguments.real("thickness", 0, 1e-30, 1e30) : 0;
    if ((open == "shell") != arguments.has("thickness"))
        throw Error(ErrorCode::InvalidOption,
                    "--open shell and --thickness W: give both, the thickness of the shell in world units");
    readRasterOptions(arguments, options);
    options.grid = arguments.text("grid");
    if (arguments.has("iso")) options.iso = arguments.real("iso", 0, -1e30, 1e30);
    return options;
}

void Run::reserveOutputs() {
    for (const char* name : {"output", "report", "source-map"})
        for (const std::string& path : arguments.all(name))
            if (path != kNoValue) mOutputs->reserve(path);
}

void Run::noteInput(const std::string& path) {
    mImpl->inputs.emplace_back(fileNameOf(mStreams->named(path)), fileHash(path));
}

LevelSet Run::load(const std::string& path) {
    return load(path, modelOptions());
}

LevelSet Run::load(const std::string& path, const ModelOptions& options) {
    reserveOutputs();
    LevelSet model = loadModel(path, options, context);
    noteInput(path);
    return model;
}

VdbMetadata Run::metadata() const {
    nlohmann::json inputs = nlohmann::json::array();
    for (const auto& [name, hash] : mImpl->inputs) inputs.push_back({{"name", name}, {"hash", hash}});
    return {{"vdbsynth:version", kVersion},
            {"vdbsynth:command", mImpl->command.name},
            {"vdbsynth:options",
             mImpl->options(arguments, true).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)},
            {"vdbsynth:seed", std::to_string(context.seed)},
            {"vdbsynth:inputs", inputs.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)}};
}

void Run::count(const std::string& name, const nlohmann::json& value) {
    mImpl->counts[name] = value;
}

GridPtr Run::loadMask(const std::string& option) {
    return loadGrid(option, arguments.text(option));
}

GridPtr Run::loadGrid(const std::string& option, const std::string& text) {
    const std::size_t colon = text.rfind(".vdb:");
    const std::string path = colon == std::string::npos ? text : text.substr(0, colon + 4),
                      name = colon == std::string::npos ? "" : text.substr(colon + 5);
    if (extensionOf(path) != "vdb")
        throw Error(ErrorCode::InvalidOption,
                    "--" + option + " " + text + ": give a .vdb file, or FILE.vdb:GRID for one of its grids");
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
    if (!arguments.has("report")) return;
    const BandQuality band = measureBand(*result.grid, context);
    mImpl->quality = {{"gradient_error_mean", band.gradientErrorMean},
                      {"gradient_error_p99", band.gradientErrorP99},
                      {"band_gaps", band.missingNeighbours},
                      {"finite", band.finite}};
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
            {"options", impl.options(arguments, false)},
            {"seed", context.seed},
            {"inputs", inputs},
            {"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - impl.began).count()},
            {"peak_bytes", peakMemory()},
            {"stages", stages},
            {"counts", impl.counts},
            {"quality", impl.quality}};
        const std::string path = arguments.text("report");
        std::ofstream file(mOutputs->add(path));
        file << withoutTemporaries(report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace))
             << '\n';
        file.close();
        if (!file) throw Error(ErrorCode::Io, path + ": writing failed; the disk may be full");
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
