#pragma once
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/render/slice.h"
#include "tools/vdb_synth/command.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// What `render` was asked for.
struct RenderRequest {
    PreviewOptions preview;  ///< but view and up, which each model has its own of
    std::optional<SliceOptions> slice;
    std::optional<Vec3d> view;
    std::optional<UpAxis> up;
    std::vector<std::string> labels;  ///< one a model; empty: none
    std::string colours;              ///< a grid's name, "none", or empty
    std::size_t columns = 64;         ///< pictures side by side
    int turntable = 0;                ///< pictures, 0: a single one
    bool wireframe = false, sameScale = false, page = false;
};

/// Reads and checks the options of `render`, without opening a file. @throw Error InvalidOption
RenderRequest readRenderRequest(const Run& run);

/// A model ready to be drawn.
struct ShownInput {
    std::string path;
    LevelSet model;    ///< empty where it is fog
    FloatGridPtr fog;  ///< null where it is a level set
    GridPtr colours;   ///< null: none
    UpAxis up = UpAxis::Z;
    Vec3d view;
};

/// Reads an input: a VDB's fog volume as fog unless --iso is given, all else as a level set. What is chosen
/// for the user is said. @throw Error as Run::load
ShownInput loadShown(Run& run, const std::string& path, const RenderRequest& request);

/// "studio", "transparent", "white", "grey", "black" or "#rrggbb". @return false if it is none of these
bool readBackground(const std::string& text, Background& background);

}  // namespace vdbsynth::cli
