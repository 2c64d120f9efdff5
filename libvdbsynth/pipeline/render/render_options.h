#pragma once
#include "libvdbsynth/render/camera.h"
#include "libvdbsynth/render/shading.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// Where a slice lies: across an axis, at a fraction of the domain.
struct SlicePlace {
    int axis = 2;           ///< 0, 1, 2: normal of the slice
    double fraction = 0.5;  ///< 0..1
};

/// How models are drawn side by side.
struct RenderOptions {
    std::array<int, 2> size{800, 600};  ///< [pixels] width and height of each model's picture, 16..8192
    std::optional<Vec3d> view;  ///< direction in the world from the model to the camera; none: the usual one
    std::optional<UpAxis> up;   ///< none: the model's own (ShownModel::up)
    std::optional<SlicePlace> slice;    ///< draws a slice of level sets, with a scale bar
    int turntable = 0;                  ///< pictures of one turn, 2..3600; 0: a single one
    std::vector<std::string> captions;  ///< one a model; empty: none
    int columns = 64;                   ///< pictures side by side, 1..64; more models go below
    bool sameScale = false;             ///< draws all models at one scale; else each fills its picture
    Background background;
    bool ground = true;      ///< with the model's shadow
    bool wireframe = false;  ///< edges of a model's source mesh, of others those of the zero level
    std::string color;       ///< name of the attribute of the colours, "none", or empty: the usual ones
    double density = 1;      ///< of fog: factor on how much light it absorbs, above 0, at most 1000000
    int samples = 4;         ///< rays per pixel at edges, 1..64
    GridConstPtr
        directions;  ///< float vectors near the surface of the one model, drawn as streaks; null: none
};

/// @param models  how many are drawn
/// @throw Error InvalidOption (a field out of its range, fields that cannot be combined, another number of
/// captions than models, no model), BadData (directions of another type)
void validate(const RenderOptions& options, std::size_t models);

/// "studio", "transparent", "white", "grey", "black" or "#rrggbb". @return false if it is none of these
bool parseBackground(const std::string& text, Background& background);

}  // namespace vdbsynth
