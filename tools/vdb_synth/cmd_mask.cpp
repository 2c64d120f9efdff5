#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/world_box.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/vdb/mask.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace vdbsynth::cli {
namespace {

double maskVoxelSize(const Arguments& arguments) {
    return arguments.has("voxel-size") ? arguments.real("voxel-size") : 1;
}

GridPtr makeBall(const Run& run) {
    const Arguments& arguments = run.arguments;
    if (!arguments.has("center") || !arguments.has("radius"))
        throw Error(ErrorCode::InvalidOption, "mask ball: give --center X,Y,Z and --radius R (world)");
    const std::array<double, 3> c = arguments.triple("center");
    const double radius = arguments.real("radius"), voxel = maskVoxelSize(arguments);
    for (double value : c)
        if (!(std::abs(value) / voxel < 1e8))
            throw Error(ErrorCode::InvalidOption, "--center " + arguments.text("center") +
                                                      ": must be within 100 million voxels of the origin");
    requireMemory(run.context, std::pow(2 * radius / voxel, 3), "--radius " + arguments.text("radius"),
                  "use a smaller radius or a larger --voxel-size");
    return ballMask({c[0], c[1], c[2]}, radius, voxel);
}

GridPtr makeRange(Run& run) {
    if (!run.arguments.has("range"))
        throw Error(ErrorCode::InvalidOption, "mask range: give --range LOW,HIGH");
    const auto [low, high] = run.arguments.range("range");
    const std::string path = run.arguments.inputs[1];
    if (extensionOf(path) != "vdb")
        throw Error(ErrorCode::InvalidOption, path + ": mask range reads a .vdb file");
    run.reserveOutputs();
    run.noteInput(path);
    return rangeMask(*readVdbFloatGrid(path, run.arguments.text("grid"), run.context), low, high);
}

void mask(Run& run) {
    run.requireInputs(1, 2);
    const std::string kind = run.arguments.inputs[0];
    const std::string path = run.outputPath();
    const bool wantsModel = kind == "inside" || kind == "range";
    if (kind != "box" && kind != "ball" && !wantsModel)
        throw Error(ErrorCode::InvalidOption,
                    "mask " + kind + ": unknown kind; one of box, ball, inside, range");
    run.requireInputs(wantsModel ? 2 : 1, wantsModel ? 2 : 1);
    GridPtr grid;
    if (kind == "box") {
        if (!run.arguments.has("box"))
            throw Error(ErrorCode::InvalidOption, "mask box: give --box i,j,k,I,J,K");
        Affine transform = kIdentity;
        for (std::size_t axis = 0; axis < 3; ++axis) transform[5 * axis] = maskVoxelSize(run.arguments);
        const IndexBox box =
            voxelsOf(run.arguments.box("box"), transform, "--box " + run.arguments.text("box"));
        const Vec3d s{double(box.size().x), double(box.size().y), double(box.size().z)};
        // Leaf nodes along the surface, tiles of 128^3 inside.
        requireMemory(run.context,
                      (s.x * s.y + s.y * s.z + s.z * s.x) / 32 * 128 + s.x * s.y * s.z / 2e6 * 64,
                      "a mask of " + boxText(box), "use a smaller --box");
        grid = boxMask(box, maskVoxelSize(run.arguments));
    } else if (kind == "ball") {
        grid = makeBall(run);
    } else if (kind == "inside") {
        requireModelPath(run.arguments.inputs[1]);
        grid = insideMask(*run.load(run.arguments.inputs[1]).grid);
    } else {
        grid = makeRange(run);
    }
    writeVdb(run.outputs().add(path), {grid}, run.metadata());
    run.finish();
}

}  // namespace

const Command kMask{"mask", "mask box|ball|inside|range [MODEL] -o OUT.vdb [options]",
                    "Make a mask grid: a box, a ball, a model's inside, a grid's range",
                    "vdb_synth mask inside bunny.off -o inside.vdb --resolution 64", mask};

}  // namespace vdbsynth::cli
