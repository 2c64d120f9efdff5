#include "tools/vdb_synth/mask_option.h"

#include "libvdbsynth/vdb/control_grids.h"

namespace vdbsynth::cli {

GridConstPtr maskOf(Run& run, const std::string& name, double voxelSize, double halfWidth) {
    const std::string text = run.arguments.text(name);
    if (namesGrid(text)) return run.loadGrid(name);
    ModelOptions model;
    model.voxelSize = voxelSize;
    model.halfWidth = halfWidth;
    return asControl(run.load(text, model).grid);
}

}  // namespace vdbsynth::cli
