// Options that a file of its kind makes no use of.
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/model_steps.h"

#include <vector>

namespace vdbsynth {
namespace {

enum class Kind { Mesh, Points, Raster, Vdb };

Kind kindOf(const std::string& path) {
    if (isPointPath(path) || holdsPoints(path)) return Kind::Points;
    if (isMeshPath(path)) return Kind::Mesh;
    return isRasterPath(path) ? Kind::Raster : Kind::Vdb;
}

}  // namespace

void noteUnusedOptions(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    const Kind kind = kindOf(path);
    const bool faces = kind == Kind::Mesh || kind == Kind::Points;
    const char* const names[] = {"a mesh", "points", "an image or volume", "a VDB"};
    const auto note = [&](bool given, bool used, const char* option) {
        if (given && !used)
            message(ctx, MessageLevel::Note,
                    path + ": `" + option + "` has no effect on " + names[int(kind)]);
    };
    note(options.iso.has_value(), kind == Kind::Vdb, "iso");
    note(!options.grid.empty(), !faces, "grid");
    note(options.solid.open == OpenMesh::Shell, faces, "open");
    note(options.volume.threshold.has_value(), kind == Kind::Raster, "threshold");
    note(options.volume.below.has_value(), kind == Kind::Raster, "below");
    note(!options.volume.labels.empty(), kind == Kind::Raster, "labels");
    note(options.heights.pixelSize > 0 || options.heights.pixelSides.x > 0, kind == Kind::Raster,
         "pixelSize");
    note(options.heights.base > 0, kind == Kind::Raster, "base");
}

}  // namespace vdbsynth
