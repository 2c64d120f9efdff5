#include "libvdbsynth/pipeline/render/shown_model.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/render/surface_colours.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/read/field_kind.h"
#include "libvdbsynth/vdb/read/grid_names.h"
#include "libvdbsynth/vdb/vdb_file.h"

namespace vdbsynth {

ShownFog readFog(const std::string& path, const std::string& gridName, const RunContext& ctx) {
    if (readExtensionOf(path) != "vdb") return {};
    return fogOf(path, readVdbGrids(path, ctx), gridName, ctx);
}

ShownFog fogOf(const std::string& name, const std::vector<GridPtr>& grids, const std::string& gridName,
               const RunContext& ctx) {
    ShownFog fog;
    fog.others = grids;
    VdbReadOptions options;
    options.gridName = gridName;
    const FloatGridPtr field = asFloat(pickedGrid(name, fog.others, options));
    if (!field || kindOf(*field, ctx) != FieldKind::Density) return {};
    fog.density = field;
    fog.name = field->getName();
    return fog;
}

UpAxis upOf(const ShownModel& model, const RenderOptions& options) {
    return options.up.value_or(model.up);
}

Vec3d viewOf(const ShownModel& model, const RenderOptions& options) {
    return options.view.value_or(usualView(upOf(model, options)));
}

GridPtr shownColours(const std::vector<GridPtr>& grids, const std::string& name, const std::string& path) {
    if (name == "none") return nullptr;
    if (name.empty()) return colourGridOf(grids);
    const GridPtr grid = gridNamed(grids, name, nullptr);
    if (!grid)
        throw Error(ErrorCode::BadData, "`color` " + name + ": not in " + path + ", which has " +
                                            (grids.empty() ? "no attributes" : listOf(grids)));
    return grid;
}

UpAxis customaryUp(const std::string& path) {
    MeshFormat format{};
    if (!meshFormatOf(path, format)) return UpAxis::Z;
    return format == MeshFormat::Obj || format == MeshFormat::Gltf || format == MeshFormat::Glb ? UpAxis::Y
                                                                                                : UpAxis::Z;
}

}  // namespace vdbsynth
