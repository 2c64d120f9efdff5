#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <functional>
#include <string>
#include <vector>

namespace vdbsynth {

/// A direction given at a position. [world]
struct Stroke {
    Vec3d position, direction;
};

/// Which way a texture runs over a surface, or through space.
struct DirectionSource {
    enum class Kind {
        Automatic,  ///< along the least curvature (curvature_direction.h)
        Axis,       ///< along `axis`
        Around,     ///< around `axis` through the middle of the model
        Radial,     ///< away from the middle of the model
        Grid,       ///< the vectors of `grid`, or the gradient of its scalars
        Strokes     ///< the `strokes`, diffused in between
    } kind = Kind::Automatic;
    Vec3d axis{0, 0, 1};  ///< [world]
    GridConstPtr grid;
    std::vector<Stroke> strokes;
};

/// Metadata of a level set with the direction of its texture, in the form that
/// parseDirection reads; `make` writes it.
inline constexpr const char* kDirectionKey = "vdbsynth:direction";

/// `axis:x`, `axis:-z`, `around:y`, `radial`, `curvature`, or a vector `1,0.5,0`, which is an axis too.
/// @return false if the text is none of these; `source` may then have changed
bool parseDirection(const std::string& text, DirectionSource& source);

/// @param field  the options' field that the source is from
/// @throw Error InvalidOption unless what the kind needs is there: a grid, an axis that is not 0, strokes of
/// finite numbers
void requireDirection(const DirectionSource& source, const char* field);

/// Reads a source that is neither Automatic nor Strokes at positions in the world: directions of any length,
/// 0 or not finite where there is none. Borrows the source; from one thread, so one for each.
/// @param middle  of the model, for Around and Radial [world]
/// @throw Error BadData (a grid of neither vectors nor real scalars)
std::function<Vec3d(const Vec3d& world)> directionReader(const DirectionSource& source, const Vec3d& middle,
                                                         const std::string& field);

}  // namespace vdbsynth
