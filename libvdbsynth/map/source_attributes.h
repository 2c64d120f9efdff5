#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/map/element_sources.h"

#include <functional>

namespace vdbsynth {

/// The strongest source of every point, vertex or corner as attributes, the way point and mesh files hold a
/// map: `source` (3, the exemplar's voxel), `exemplar` (1, -1: none) and, where any is not 0, `source_offset`
/// (3, from that voxel to the place copied), `source_rotation` (3, rotation vector [radians]); where any is
/// not 1 `source_scale`, `source_weight` (1). Exact for voxels up to 2^24.
/// @throw Error InvalidOption (a voxel map, which is written as grids), Unusable (a voxel beyond 2^24)
Attributes sourceAttributes(const ElementSources& sources);

/// The same back. @param attributes  may hold others
/// @throw Error BadData (no `source` and `exemplar`, other widths or lengths, numbers that are no source)
ElementSources sourcesFromAttributes(const Attributes& attributes, ElementKind kind);

/// How an exemplar's attribute is read at a place.
struct AttributeReader {
    std::string name;
    std::size_t width = 1;   ///< 1 to 3
    bool direction = false;  ///< three floats that are rotated with their source
    /// Writes `width` floats. @param position  index space of the exemplar
    /// @return false where the exemplar has no value there
    std::function<bool(std::int32_t exemplar, const Vec3d& position, float* out)> read;
};

/// An attribute of the exemplars on every element of a result.
/// @param blended  the mean over all sources that have a value, by their weights; false: the value of the
///                 strongest that has one
/// @return one row an element, of any kind; 0 where no source has a value
/// @par Cost    O(sources) reads   @par Repeats same bits for any number of threads
Attribute transferredAttribute(const ElementSources& sources, const AttributeReader& reader, bool blended,
                               const RunContext& ctx = {});

}  // namespace vdbsynth
