#include "tools/vdb_synth/mask_option.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/vdb/control_grids.h"

#include <algorithm>

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

GridConstPtr maskOf(Run& run, const std::string& name, double voxelSize, double halfWidth) {
    const std::string text = run.arguments.text(name);
    if (namesGrid(text)) return run.loadGrid(name);
    ModelOptions model;
    model.voxelSize = voxelSizeOf(run, text, voxelSize);
    model.halfWidth = halfWidth;
    return asControl(run.load(text, model).grid);
}

}  // namespace vdbsynth::cli
