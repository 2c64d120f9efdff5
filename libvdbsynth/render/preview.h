#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/render/camera.h"
#include "libvdbsynth/render/shading.h"
#include "libvdbsynth/vdb/level_set.h"

#include <memory>
#include <vector>

namespace vdbsynth {

struct PreviewOptions {
    int width = 800, height = 600;  ///< [pixels], 16..8192
    Vec3d view{1.0, -1.6, 0.9};     ///< direction in the world from the model to the camera, not zero
    UpAxis up = UpAxis::Z;          ///< axis that points up in the picture, unless `view` is along it
    Background background{};
    bool ground = true;       ///< the model stands on a ground that shows its shadow, seen from above only
    GridConstPtr colours;     ///< vectors of the surface's colours, 0..1 as pictures hold them; null: clay
    GridConstPtr directions;  ///< float vectors near the surface, drawn as streaks along them; null: none
    /// [world] the edges of its faces are drawn where they are no more than 1.5 voxels behind the surface;
    /// null: none. Lives as long as the drawing.
    const Mesh* wires = nullptr;
    int samples = 4;     ///< rays per pixel at edges (elsewhere one), 1..64
    double density = 1;  ///< of fog: times the usual one (fog.h), above 0
};

/// @throw Error InvalidOption (a field out of its range), BadData (directions or colours of another type)
void validate(const PreviewOptions& options);
/// @throw Error InvalidOption
void requirePictureSize(int width, int height);

/// A model laid out to be drawn, from any number of cameras.
class Drawing {
public:
    virtual ~Drawing() = default;
    /// [world] places around the model, for `framed`.
    virtual const std::vector<Vec3d>& outline() const = 0;
    /// @throw Error Cancelled   @par Repeats same bits for any number of threads
    virtual Picture drawn(const Camera& camera, const RunContext& ctx = {}) const = 0;
};

/// A level set to be drawn with what `options` says; its grid is not needed afterwards, other grids are kept.
/// @throw Error InvalidOption, BadData, EmptyInput, Memory, Cancelled
/// @par Cost  TracedSurface's; a picture a microsecond or two a pixel and core
std::unique_ptr<Drawing> drawingOf(const openvdb::FloatGrid& grid, const PreviewOptions& options = {},
                                   const RunContext& ctx = {});

/// A shaded picture of a level set: a perspective camera whose picture the model fills (camera.h), light from
/// a key light with soft shadow and a sky (shading.h), edges refined with `samples` rays per pixel at fixed
/// places. Directions are drawn by line integral convolution (streaks.h).
/// @throw Error InvalidOption, BadData (grids of another type), EmptyInput, Memory, Cancelled
/// @par Repeats same bits for any number of threads
Picture renderPreview(const openvdb::FloatGrid& grid, const PreviewOptions& options = {},
                      const RunContext& ctx = {});

}  // namespace vdbsynth
