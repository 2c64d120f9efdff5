// The only file that includes nanoflann.
#include "libvdbsynth/geometry/point_neighbours.h"

#include <nanoflann.hpp>

namespace vdbsynth {
namespace {

struct Cloud {
    const std::vector<Vec3f>& points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][int(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, std::uint32_t>;

}  // namespace

struct PointNeighbours::Impl {
    Cloud cloud;
    Tree tree;
    explicit Impl(const std::vector<Vec3f>& points) : cloud{points}, tree(3, cloud) {}
};

PointNeighbours::PointNeighbours(const std::vector<Vec3f>& points) : mImpl(new Impl(points)) {}
PointNeighbours::~PointNeighbours() = default;

std::size_t PointNeighbours::nearest(const Vec3f& place, std::size_t count, std::uint32_t* numbers,
                                     float* squared) const {
    const float query[3] = {place.x, place.y, place.z};
    return mImpl->tree.knnSearch(query, count, numbers, squared);
}

}  // namespace vdbsynth
