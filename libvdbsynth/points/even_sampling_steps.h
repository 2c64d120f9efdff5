#pragma once
#include "libvdbsynth/points/even_sampling.h"
#include "libvdbsynth/points/point_blocks_steps.h"

#include <cstdint>
#include <optional>
#include <vector>

// Steps of even_sampling.h. Lengths are those of the world times a scale, so that floats hold their squares.
namespace vdbsynth {

/// A neighbour as it is seen in the tangent plane of a place.
struct PlanarNeighbour {
    std::uint32_t number = 0;
    double distance = 0;  ///< [scaled] in space
    double x = 0, y = 0;  ///< direction in the plane, length 1
    double turn = 0;      ///< grows with the angle of (x, y), 0..4
};

/// Points that neighbours are looked for in.
class SampledPoints {
public:
    /// @param points   [n] at least one   @param normals  [n]   @param reach  [scaled] of neighbours
    SampledPoints(std::vector<Vec3f> points, std::vector<Vec3f> normals, double reach);

    /// The points within `reach` of a place that are of its sheet, but `self`, by the angle of their
    /// direction, then by number. Coinciding ones are left out.
    void around(const Vec3d& place, const Vec3d& normal, std::int64_t self,
                std::vector<PlanarNeighbour>& neighbours) const;
    /// Whether a place has such a point within the distance, at most `reach`.
    bool any(const Vec3d& place, const Vec3d& normal, double distance) const;

    const std::vector<Vec3f>& points() const { return mPoints.point; }
    const std::vector<Vec3f>& normals() const { return mPoints.normal; }

private:
    OrientedPoints mPoints;
    PointBlocks mBlocks;
};

/// Two directions of length 1 perpendicular to a normal and to each other.
struct TangentFrame {
    Vec3d u, v;
    explicit TangentFrame(const Vec3d& normal);
};

/// Whether there are neighbours all around: no two that follow each other are 150 degrees or more apart.
bool isSurrounded(const std::vector<PlanarNeighbour>& neighbours);

/// Numbers of the points that stay if of those within a distance only the first stays, fixed ones before
/// others.
std::vector<std::uint32_t> withoutNear(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                                       const std::vector<char>& fixed, double distance,
                                       const RunContext& ctx);

/// As PointSetSurface::project, for lengths that are scaled.
std::optional<SurfaceFoot> projectScaled(const PointSetSurface& surface, const Vec3d& place,
                                         const Vec3d& facing, double scale);

struct AddedPoint {
    SurfaceFoot foot;
    std::uint32_t nearest = 0;  ///< the point it was looked for from
};
/// The middles of circles on the surface, of at least `radius`, that hold no point, but have one of those
/// looked from on them and others around; none within `radius` of another.
/// @param from  numbers of points
std::vector<AddedPoint> middlesOfHoles(const PointSetSurface& surface, double scale,
                                       const SampledPoints& sampled, const std::vector<std::uint32_t>& from,
                                       double radius, const RunContext& ctx);

}  // namespace vdbsynth
