#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/raster/raster_options.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// The box of a geometry texture whose points continue beyond it: what is between its corners is texture,
/// what is outside only says how it continues.
struct TextureBox {
    Vec3d low, high;  ///< [world] corners, low below high along every axis
    /// The reference plane of a sheet; the box's side across it is the texture's height. None: the texture
    /// fills space.
    std::optional<HeightPlane> plane;
};

/// The comments that say a box in a .ply's header, in world units and in shortest decimals that read back to
/// the same numbers: `vdbsynth:domain x,y,z,X,Y,Z` and, with a plane, `vdbsynth:plane xy` (yz, zx).
std::vector<std::string> textureBoxComments(const TextureBox& box);

/// The box that a header's comments say (PointFile::comments, plyComments), or none without
/// `vdbsynth:domain`. Of several the last counts.
/// @param path  begins the message
/// @throw Error BadData (not six finite numbers, corners in the wrong order, an unknown plane)
std::optional<TextureBox> textureBoxOf(const std::string& path, const std::vector<std::string>& comments);

}  // namespace vdbsynth
