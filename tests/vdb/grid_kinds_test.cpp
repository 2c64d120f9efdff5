#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

namespace {

std::vector<openvdb::GridBase::Ptr> allKinds() {
    openvdb::initialize();
    return {openvdb::FloatGrid::create(), openvdb::DoubleGrid::create(), openvdb::Int32Grid::create(),
            openvdb::Int64Grid::create(), openvdb::BoolGrid::create(),   openvdb::MaskGrid::create(),
            openvdb::Vec3IGrid::create(), openvdb::Vec3SGrid::create(),  openvdb::Vec3DGrid::create()};
}

// The kinds that a list takes: "mask" of "Tree_mask_5_4_3". A mask's values are of type bool.
template <typename Kinds>
std::vector<std::string> taken() {
    std::vector<std::string> names;
    for (const auto& grid : allKinds())
        if (grid->apply<Kinds>([](const auto&) {}))
            names.push_back(grid->type().substr(5, grid->type().size() - 11));
    return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("kinds of grid: scalars, vectors, those with a mean, attributes and masks", "[vdb][oracle]") {
    using namespace vdbsynth;
    CHECK(taken<RealScalarGrids>() == Names{"float", "double"});
    CHECK(taken<ScalarGrids>() == Names{"float", "double", "int32", "int64", "bool", "mask"});
    CHECK(taken<VectorGrids>() == Names{"vec3s", "vec3d"});
    CHECK(taken<RealGrids>() == Names{"float", "double", "vec3s", "vec3d"});
    CHECK(taken<AttributeGrids>() ==
          Names{"float", "double", "int32", "int64", "bool", "vec3i", "vec3s", "vec3d"});
    CHECK(taken<MaskGrids>() == Names{"float", "int32", "bool", "mask"});
}

using namespace vdbsynth;

TEST_CASE("emptyGrid: a grid of the kind asked for, like one that create makes", "[vdb]") {
    const openvdb::Vec3IGrid::Ptr vectors = emptyGrid<openvdb::Vec3IGrid>();
    REQUIRE(vectors);
    CHECK(vectors->background() == openvdb::Vec3i(0));
    CHECK(anyKind(*vectors).activeVoxelCount() == 0);
    CHECK(vectors->metaCount() == 0);
    const openvdb::MaskGrid::Ptr mask = emptyGrid<openvdb::MaskGrid>();
    REQUIRE(mask);
    CHECK_FALSE(mask->background());
    REQUIRE(emptyGrid<openvdb::BoolGrid>());
}

TEST_CASE("anyKind: the same grid", "[vdb]") {
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(2.f);
    CHECK(&anyKind(*grid) == grid.get());
    const openvdb::GridBase::Ptr copy = anyKind(*grid).copyGridWithNewTree();
    CHECK(openvdb::gridPtrCast<openvdb::FloatGrid>(copy)->background() == 2.f);
}
