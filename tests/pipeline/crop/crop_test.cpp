#include "libvdbsynth/pipeline/crop/crop.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("cropModel: the inside is unchanged, the box is recorded and capped", "[pipeline][property]") {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = "balls";
    options.exemplar.resolution = 48;
    const LevelSet model = makeModel(options);
    const IndexBox box{{10, 8, 6}, {33, 40, 29}};
    const LevelSet part = cropModel(model, box);
    CHECK(part.domain == box);
    CHECK(part.domainRecorded);
    const auto a = model.grid->getConstAccessor(), b = part.grid->getConstAccessor();
    for (int x = 14; x < 30; ++x)
        for (int y = 12; y < 36; ++y)
            for (int z = 10; z < 26; ++z) REQUIRE(a.getValue({x, y, z}) == b.getValue({x, y, z}));
    CHECK(box.contains(solidBox(*part.grid, "part")));
    // A box without bound costs no more than the model.
    const IndexBox all{{-1000000, -1000000, -1000000}, {1000000, 1000000, 1000000}};
    const LevelSet whole = cropModel(model, all);
    CHECK(whole.domain == all);
    CHECK(solidBox(*whole.grid, "whole") == solidBox(*model.grid, "model"));
    const test::Thrown thrown = test::thrownBy([&] { cropModel(model, IndexBox::cube({500, 0, 0}, 9)); });
    CHECK(thrown.code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(thrown.message, "no surface in it; the model's domain is 0,0,0,47,47,47"));
}
