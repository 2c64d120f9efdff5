#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <cstddef>
#include <string>

namespace vdbsynth {

/// A model's surface in few bytes, for a page that draws it. Numbers are little-endian.
struct PackedMesh {
    std::size_t vertices = 0, triangles = 0;
    std::size_t before = 0;  ///< triangles of the zero level, at its own voxels
    Vec3d low, high;         ///< [world] box of the vertices
    bool coloured = false;
    std::string positions;  ///< three 16-bit numbers a vertex: 0 is `low`, 65535 `high`
    std::string normals;    ///< two signed bytes a vertex: the octahedral map [cigolle2014]
    std::string open;       ///< a byte a vertex: how much of the sky it sees, 255 all
    std::string colours;    ///< three bytes a vertex as pictures hold them; empty unless coloured
    /// The corners of the triangles: how far each is below the number of vertices met so far, 0 for the next
    /// new one, in groups of seven bits, the lowest first, all but the last with the high bit set.
    std::string corners;

    std::size_t bytes() const {
        return positions.size() + normals.size() + open.size() + colours.size() + corners.size();
    }
};

/// The zero level of a level set, with at most `most` triangles: where it has more, that of samples as far
/// apart as gives so few, its vertices moved onto the surface; what is thinner than that is lost. Normals,
/// colours and what of the sky a vertex sees come from the level set itself.
/// @param colours  as PreviewOptions'; null: none
/// @param most     at least 100
/// @throw Error InvalidOption, BadData (colours of another type), EmptyInput, Memory, Cancelled
/// @par Repeats same bits for any number of threads
PackedMesh packedMesh(const openvdb::FloatGrid& grid, const GridConstPtr& colours, std::size_t most,
                      const RunContext& ctx = {});

}  // namespace vdbsynth
