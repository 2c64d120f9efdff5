#pragma once
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"

#include <openvdb/Types.h>

namespace vdbsynth {

inline openvdb::Coord toCoord(const Index3& p) {
    return {p.x, p.y, p.z};
}
inline Index3 fromCoord(const openvdb::Coord& p) {
    return {p.x(), p.y(), p.z()};
}
inline openvdb::CoordBBox toBBox(const IndexBox& box) {
    return {toCoord(box.min), toCoord(box.max)};
}
inline IndexBox fromBBox(const openvdb::CoordBBox& box) {
    return {fromCoord(box.min()), fromCoord(box.max())};
}
inline Vec3d fromVec(const openvdb::Vec3d& v) {
    return {v.x(), v.y(), v.z()};
}
inline openvdb::Vec3d toVec(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

}  // namespace vdbsynth
