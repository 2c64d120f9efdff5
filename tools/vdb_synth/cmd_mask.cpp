#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/world_box.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/mask/mask.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace vdbsynth::cli {
namespace {

// A box in world units is cut to whole voxels, whose size nobody chose.
void sayVoxels(const Run& run, const IndexBox& box) {
    const BoxValue given = run.arguments.box("box");
    if (run.arguments.has("voxel-size") ||
        std::none_of(given.begin(), given.end(), [](const SizeValue& end) { return end.world; }))
        return;
    const Index3 size = box.size();
    message(run.context, MessageLevel::Note,
            "--voxel-size: not given; voxels are 1 wide (world), and the box takes " +
                std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z) +
                " of them");
}

MaskOptions readMaskOptions(const Run& run) {
    const Arguments& arguments = run.arguments;
    MaskOptions options;
    if (!parseMaskKind(arguments.inputs[0], options.kind))
        throw Error(ErrorCode::InvalidOption,
                    "mask " + arguments.inputs[0] + ": unknown kind; one of box, ball, inside, range");
    // Inside reads its model with voxels of that size; the mask has the model's.
    const bool shape = options.kind == MaskKind::Box || options.kind == MaskKind::Ball;
    if (shape && arguments.has("voxel-size")) options.voxelSize = arguments.real("voxel-size");
    if (arguments.has("box")) {
        Affine transform = kIdentity;
        for (std::size_t axis = 0; axis < 3; ++axis) transform[5 * axis] = options.voxelSize.value_or(1);
        options.box = voxelsOf(arguments.box("box"), transform, "--box " + arguments.text("box"));
        if (shape) sayVoxels(run, *options.box);
    }
    if (arguments.has("center")) {
        const std::array<double, 3> c = arguments.triple("center");
        options.center = Vec3d{c[0], c[1], c[2]};
    }
    if (arguments.has("radius")) options.radius = arguments.real("radius");
    if (arguments.has("range")) options.range = arguments.range("range");
    validate(options);
    return options;
}

FloatGridConstPtr readRangeGrid(Run& run, const std::string& path) {
    if (extensionOf(path) != "vdb")
        throw Error(ErrorCode::InvalidOption, path + ": mask range reads a .vdb file");
    run.reserveOutputs();
    run.noteInput(path);
    return readVdbFloatGrid(path, run.arguments.text("grid"), run.context);
}

void mask(Run& run) {
    run.requireInputs(1, 2);
    const std::string path = run.outputPath();
    const MaskOptions options = readMaskOptions(run);
    const bool wantsModel = options.kind == MaskKind::Inside || options.kind == MaskKind::Range;
    run.requireInputs(wantsModel ? 2 : 1, wantsModel ? 2 : 1);
    FloatGridConstPtr grid;
    if (options.kind == MaskKind::Inside) {
        requireModelPath(run.arguments.inputs[1]);
        grid = run.load(run.arguments.inputs[1]).grid;
    } else if (options.kind == MaskKind::Range) {
        grid = readRangeGrid(run, run.arguments.inputs[1]);
    }
    const GridPtr made = makeMask(options, grid, run.context);
    writeVdb(run.outputs().add(path), {made}, run.metadata());
    run.finish();
}

}  // namespace

const Command kMask{"mask", "mask box|ball|inside|range [MODEL] -o OUT.vdb [options]",
                    "Make a mask grid: a box, a ball, a model's inside, a grid's range",
                    "vdb_synth mask inside bunny.off -o inside.vdb --resolution 64", mask};

}  // namespace vdbsynth::cli
