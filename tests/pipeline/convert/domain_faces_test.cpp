#include "libvdbsynth/pipeline/convert/domain_faces.h"

#include "libvdbsynth/pipeline/make/make.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("grownBox: a margin at the faces that are not cuts") {
    CutFaces cut{};
    cut[0] = cut[5] = true;
    const IndexBox box = grownBox({{0, 0, 0}, {9, 9, 9}}, cut, 4);
    CHECK(box.min == Index3{0, -4, -4});
    CHECK(box.max == Index3{13, 13, 9});
}
