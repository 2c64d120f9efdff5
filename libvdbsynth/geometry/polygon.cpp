#include "libvdbsynth/geometry/polygon.h"

namespace vdbsynth {

void appendPolygons(Mesh& mesh, const PolygonList& polygons, const std::vector<Vec3d>&) {
    std::size_t at = 0;
    for (const std::uint32_t count : polygons.sizes) {
        appendPolygon(mesh, polygons.corners.data() + at, count);
        at += count;
    }
}

}  // namespace vdbsynth
