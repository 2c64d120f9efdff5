#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/render/render_options.h"
#include "libvdbsynth/render/camera.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A file's fog volume with its other grids.
struct ShownFog {
    FloatGridPtr density;  ///< null: the file is no VDB, or the grid that a model is made of is no fog
    std::string name;      ///< of the grid
    std::vector<GridPtr> others;
};

/// The fog volume of a VDB file, or nothing. @param gridName  as VdbReadOptions' (vdb/vdb_file.h)
/// @throw Error as readVdbModel
ShownFog readFog(const std::string& path, const std::string& gridName, const RunContext& ctx = {});
/// The same among grids in memory. @param name  begins messages @throw Error as modelFromGrids
ShownFog fogOf(const std::string& name, const std::vector<GridPtr>& grids, const std::string& gridName,
               const RunContext& ctx = {});

/// A model ready to be drawn.
struct ShownModel {
    std::string name;                 ///< begins messages
    LevelSet model;                   ///< its grid null where it is fog; `source` is what a wireframe draws
    FloatGridPtr fog;                 ///< null where it is a level set
    std::vector<GridPtr> attributes;  ///< of which one may hold the colours
    UpAxis up = UpAxis::Z;            ///< its own up axis: customaryUp of its file
};

/// What a picture of a model takes from the options, and else from the model.
UpAxis upOf(const ShownModel& model, const RenderOptions& options);
/// [world] from the model to the camera.
Vec3d viewOf(const ShownModel& model, const RenderOptions& options);

/// The grid of a model's colours. @param name  of a grid; "none": no colours; empty: the usual ones
/// (render/surface_colours.h) @param path  begins the message
/// @throw Error BadData (there is no grid of that name)
GridPtr shownColours(const std::vector<GridPtr>& grids, const std::string& name, const std::string& path);

/// The up axis that a kind of file has by custom: y for .obj, .gltf and .glb, z for all others.
UpAxis customaryUp(const std::string& path);

}  // namespace vdbsynth
