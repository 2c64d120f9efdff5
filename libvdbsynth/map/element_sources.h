#pragma once
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// One position of an exemplar that an element of a result was copied from.
struct Source {
    std::int32_t exemplar = 0;  ///< its number among the map's exemplars
    Vec3d position;             ///< [voxels] index space of the exemplar, may lie between voxels
    Vec3f rotation;             ///< [radians] axis times angle, from the exemplar to the result
    float scale = 1;   ///< feature size in the result over that in the exemplar, each in its own voxels
    float weight = 1;  ///< over 0, relative to the element's other sources
};

/// The kind of elements that a map covers.
enum class ElementKind {
    Voxel,   ///< of a level set
    Point,   ///< of a point set
    Vertex,  ///< of a mesh
    Corner   ///< of a face of a mesh, where neighbouring faces may differ
};

/// The sources of single elements of a result, any number each, as written by methods that do not copy
/// blocks. Elements other than voxels are identified by their number in the point set or mesh.
class ElementSources {
public:
    /// The sources of one element, the one with the largest weight first.
    struct Range {
        const Source *first, *last;
        const Source* begin() const { return first; }
        const Source* end() const { return last; }
        bool empty() const { return first == last; }
    };

    ElementSources() = default;
    explicit ElementSources(ElementKind kind) : mKind(kind) {}

    ElementKind kind() const { return mKind; }
    /// Number of elements, including those without a source.
    std::size_t size() const { return mEnd.size(); }
    /// Appends an element that is not a voxel. Sources are sorted by weight; equal ones stay in their order.
    /// @throw Error InvalidOption (a voxel's map; a weight not over 0; a position that is not finite)
    void add(std::vector<Source> sources);
    /// Appends a voxel. @param voxel  index space of the result; the caller must add each only once
    /// @throw Error InvalidOption (a map of another kind; as above)
    void add(const Index3& voxel, const Source& source);

    Range operator[](std::size_t element) const {
        return {mSources.data() + (element == 0 ? 0 : mEnd[element - 1]), mSources.data() + mEnd[element]};
    }
    /// The source with the largest weight, the first of equal ones; null: none.
    const Source* strongest(std::size_t element) const {
        const Range range = (*this)[element];
        return range.empty() ? nullptr : range.first;
    }
    /// [elements] of a voxel map, in the order added; else empty.
    const std::vector<Index3>& voxels() const { return mVoxels; }

private:
    void append(const Source& source);

    ElementKind mKind = ElementKind::Voxel;
    std::vector<std::size_t> mEnd;  // [elements] one past the last source of each
    std::vector<Source> mSources;
    std::vector<Index3> mVoxels;
};

}  // namespace vdbsynth
