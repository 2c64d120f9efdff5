#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/stl_files.h"

using namespace vdbsynth;

namespace {

// The corners of a unit cube in the order of a hexahedron, and the tip of a pyramid on top of it.
const char* const kCube =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n10\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 "
    "0\n"
    "1 1 1 0\n0 1 1 0\n0.5 0.5 2 0\nnan nan nan 0\n";

MeshSummary summaryOf(const std::string& elements, const RunContext& ctx = {}) {
    return summarize(meshOf("a.mesh", readMedit("a.mesh", kCube + elements + "End\n", ctx), ctx));
}

}  // namespace

TEST_CASE("readMedit: the outside of hexahedra, prisms and pyramids", "[io][oracle]") {
    const MeshSummary cube = summaryOf("Hexahedra\n1\n1 2 3 4 5 6 7 8 0\n");
    CHECK(cube.closedManifold());
    CHECK(cube.signedVolume == Approx(1));
    const MeshSummary house = summaryOf("Hexahedra\n1\n1 2 3 4 5 6 7 8 0\nPyramids\n1\n5 6 7 8 9 0\n");
    CHECK(house.closedManifold());
    CHECK(house.signedVolume == Approx(4 / 3.0));
    const MeshSummary halves = summaryOf("Prisms\n2\n1 2 3 5 6 7 0\n1 3 4 5 7 8 0\n");
    CHECK(halves.closedManifold());
    CHECK(halves.signedVolume == Approx(1));
}

TEST_CASE("readMedit: line ends, comments, curved elements", "[io][error]") {
    const std::string whole = kCube + std::string("# sides\nHexahedra\n1\n1 2 3 4 5 6 7 8 0\nEnd\n");
    for (const char* end : {"\r", "\r\n"})
        CHECK(readMedit("a.mesh", test::replaced(whole, "\n", end)).polygons.sizes.size() == 6);
    test::Said said;
    summaryOf("TrianglesP2\n1\n1 2 3 4 5 6 0\nTriangles\n1\n1 2 3 0\n", said.ctx);
    CHECK(said.warned("a.mesh: 1 curved element (TrianglesP2) left out"));
    CHECK(test::thrownBy([&] { summaryOf("Hexahedra\n1\n1 2 3 4 5 6 7 11 0\n"); }).code ==
          int(ErrorCode::BadData));
    CHECK(test::thrownBy([&] { summaryOf("Hexahedra\n1\n1 2 3 4 5 6 7 10 0\n"); }).code ==
          int(ErrorCode::BadData));
}
