#pragma once
#include "libvdbsynth/geometry/mesh.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

// Steps of removeSlivers.
namespace vdbsynth {

/// Sine of a triangle's smallest angle; 0 if it has no area.
double smallestSine(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Some triangles replaced by others with the same outline, without one of their vertices or with all.
struct SliverChange {
    std::vector<std::uint32_t> removed;  ///< indices of triangles
    std::vector<Triangle> added;         ///< no more than are removed
    double moved = 0;                    ///< [world] how far the surface moves, earlier changes included
    std::ptrdiff_t gain = 0;             ///< slivers fewer
    double sine = 0;                     ///< smallest of the added triangles
    bool flip = false;

    bool better(const SliverChange& other) const {
        return gain != other.gain ? gain > other.gain : sine > other.sine;
    }
};

/// Triangles that know their neighbours, while slivers are removed from them.
class SliverSurface {
public:
    /// @param sine  of the smallest angle of a triangle that is no sliver
    SliverSurface(std::vector<Vec3d> points, std::vector<Triangle> triangles, double sine, double tolerance);

    std::size_t size() const { return mTriangles.size(); }
    bool alive(std::size_t face) const {
        return mTriangles[face][0] != mTriangles[face][1] || mTriangles[face][1] != mTriangles[face][2];
    }
    double sineOf(std::size_t face) const;
    bool isSliver(std::size_t face) const { return alive(face) && sineOf(face) < mSine; }
    /// The best allowed change of a sliver. @return false if there is none
    bool bestChange(std::size_t face, SliverChange& best) const;
    void apply(const SliverChange& change);
    /// What is left, in the order of the triangles.
    std::vector<Triangle> triangles() const;

private:
    using Ring = std::vector<std::uint32_t>;

    template <typename Visit>
    void forFacesOf(std::uint32_t vertex, const Visit& visit) const;
    std::vector<std::uint32_t>& editableFaces(std::uint32_t vertex);
    bool joined(std::uint32_t a, std::uint32_t b) const;
    Vec3d areaVector(const Triangle& t) const;
    double sineOf(const Triangle& t) const;
    bool ringOf(std::uint32_t vertex, Ring& ring, std::vector<std::uint32_t>& faces) const;
    bool linkHolds(std::uint32_t vertex, const Ring& ring, std::size_t apex) const;
    bool keepsNormals(const SliverChange& change) const;
    double movedByCollapse(std::uint32_t vertex, const Ring& ring, const SliverChange& change) const;
    bool measure(SliverChange& change) const;
    void tryCollapses(std::uint32_t vertex, SliverChange& best) const;
    void tryFlip(std::uint32_t a, std::uint32_t b, SliverChange& best) const;

    std::vector<Vec3d> mPoints;
    std::vector<Triangle> mTriangles;  // removed ones have three equal corners
    std::vector<float> mMoved;         // [triangles, world] that the surface moved so far
    double mSine, mTolerance;
    std::vector<std::size_t> mFirst;                                         // [vertices + 1] into mFaces
    std::vector<std::uint32_t> mFaces;                                       // of each vertex, as given
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> mChanged;  // faces of vertices since
};

}  // namespace vdbsynth
