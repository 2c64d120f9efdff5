#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/map/element_sources.h"

#include <functional>

namespace vdbsynth {

/// The source with the largest weight of every point, vertex or corner as attributes, the form of a map in
/// point and mesh files: `source` (3, the exemplar's voxel), `exemplar` (1, -1: none) and, where any is not
/// 0, `source_offset` (3, from that voxel to the copied position), `source_rotation` (3, rotation vector
/// [radians]); where any is not 1 `source_scale`, `source_weight` (1). Exact for voxels up to 2^24.
/// @throw Error InvalidOption (a voxel map, which is written as grids), Unusable (a voxel beyond 2^24)
Attributes sourceAttributes(const ElementSources& sources);

/// The inverse. @param attributes  may hold others
/// @throw Error BadData (no `source` and `exemplar`, other widths or lengths, invalid numbers)
ElementSources sourcesFromAttributes(const Attributes& attributes, ElementKind kind);

/// Reads an exemplar's attribute at a position.
struct AttributeReader {
    std::string name;
    std::size_t width = 1;   ///< 1 to 3
    bool direction = false;  ///< three floats that are rotated with their source
    /// Writes `width` floats. @param position  index space of the exemplar
    /// @return false if the exemplar has no value there
    std::function<bool(std::int32_t exemplar, const Vec3d& position, float* out)> read;
};

/// An attribute of the exemplars, transferred to every element of a result.
/// @param blended  the mean over all sources that have a value, by their weights; false: the value of the
/// source with the largest weight that has one
/// @return one row per element, of any kind; 0 where no source has a value
/// @par Cost    O(sources) reads   @par Repeats same bits for any number of threads
Attribute transferredAttribute(const ElementSources& sources, const AttributeReader& reader, bool blended,
                               const RunContext& ctx = {});

}  // namespace vdbsynth
