#include "tools/vdb_synth/mask_option.h"

#include "tools/vdb_synth/options.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/vdb/control_grids.h"

#include <algorithm>
#include <set>
#include <string>

namespace vdbsynth::cli {
namespace {

constexpr double kMostVoxels = 1000;  // along a mask's longest side: a mesh may be far larger than the model

// A mesh that is large beside the model's voxels is read at larger ones.
double voxelSizeOf(Run& run, const std::string& path, double voxelSize) {
    if (!isMeshPath(path)) return voxelSize;
    const MeshSummary of = summarize(readMesh(path, run.context));
    const Vec3d sides = of.boxMax - of.boxMin;
    const double least = std::max({sides.x, sides.y, sides.z}) / kMostVoxels;
    if (voxelSize >= least) return voxelSize;
    message(run.context, MessageLevel::Note,
            path + ": is far larger than the model; as a mask it is read with voxels of " +
                roundedText(least, 4) + " instead of " + roundedText(voxelSize, 4));
    return least;
}

}  // namespace

void refusePicture(const Arguments& arguments, const std::string& name) {
    // As a model it is a slab of a world unit a pixel.
    static const std::set<std::string> kPictures{"png", "jpg", "jpeg", "pgm", "exr"};
    const std::string text = arguments.text(name);
    if (kPictures.count(extensionOf(text)) == 0) return;
    const bool painted = findOption(arguments.command(), name + "-image") != nullptr;
    throw Error(ErrorCode::InvalidOption,
                "--" + name + " " + text +
                    ": a picture has no place in space; give a model or FILE.vdb:GRID" +
                    (painted ? ", or the picture as --" + name + "-image" : ""));
}

GridConstPtr maskOf(Run& run, const std::string& name, double voxelSize, double halfWidth) {
    const std::string text = run.arguments.text(name);
    if (namesGrid(text)) return run.loadGrid(name);
    refusePicture(run.arguments, name);
    ModelOptions model;
    model.voxelSize = voxelSizeOf(run, text, voxelSize);
    model.halfWidth = halfWidth;
    return asControl(run.load(text, model).grid);
}

}  // namespace vdbsynth::cli
