#include "libvdbsynth/vdb/coord.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("toCoord, fromCoord: axes in order, there and back", "[vdb][oracle]") {
    const openvdb::Coord c = toCoord({1, -2, 1 << 28});
    CHECK((c.x() == 1 && c.y() == -2 && c.z() == 1 << 28));
    for (const Index3& p : {Index3{0, 0, 0}, Index3{-7, 8, -9}, Index3{1 << 30, -(1 << 30), 5}})
        CHECK(fromCoord(toCoord(p)) == p);
}

TEST_CASE("toBBox, fromBBox: both corners inclusive, there and back", "[vdb][oracle]") {
    const IndexBox box{{-1, 2, 3}, {4, 2, 9}};
    const openvdb::CoordBBox same = toBBox(box);
    CHECK(same.min() == openvdb::Coord(-1, 2, 3));
    CHECK(same.max() == openvdb::Coord(4, 2, 9));
    CHECK(same.volume() == std::uint64_t(box.volume()));
    CHECK(fromBBox(same) == box);
}

TEST_CASE("toBBox, fromBBox: an empty box stays empty", "[vdb][degenerate]") {
    CHECK(toBBox(IndexBox()).empty());
    CHECK(fromBBox(openvdb::CoordBBox()).empty());
}

TEST_CASE("toVec, fromVec: axes in order, every bit kept", "[vdb][oracle]") {
    const openvdb::Vec3d v = toVec({0.1, -1e300, 3});
    CHECK((v.x() == 0.1 && v.y() == -1e300 && v.z() == 3));
    const Vec3d back = fromVec(v);
    CHECK((back.x == 0.1 && back.y == -1e300 && back.z == 3));
}
