#pragma once
#include "libvdbsynth/io/readers/mesh_content.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace vdbsynth {

/// Facets that are given by the coordinates of their corners, as in STL: corners with the same bits become
/// one vertex, in the order of their first use.
class FacetSoup {
public:
    FacetSoup();
    ~FacetSoup();
    FacetSoup(const FacetSoup&) = delete;
    FacetSoup& operator=(const FacetSoup&) = delete;

    /// Adds a facet; one that has no three different corners, or one that is not finite, becomes no face.
    /// @param keys    decide which corners are one vertex
    /// @param points  the corners
    void add(const Vec3f* keys, const Vec3d* points, std::size_t count);

    std::size_t facets() const { return mFacets; }
    /// True if there is a face and every edge belongs to an even number of faces.
    /// @par Cost    O(corners log corners)
    bool isClosed() const;
    /// The mesh, and a warning if facets were not finite; the soup is then empty.
    /// @throw Error BadData (more than half of the facets are not finite)
    MeshContent take(const std::string& path, const RunContext& ctx);

private:
    struct Vertices;
    MeshContent mMesh;
    std::unique_ptr<Vertices> mVertices;
    std::size_t mFacets = 0, mUnfinite = 0;
};

}  // namespace vdbsynth
