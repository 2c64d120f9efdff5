#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("makeModel: every kind is a valid capped level set on its domain", "[pipeline][property]") {
    openvdb::initialize();
    for (const ExemplarKind& kind : exemplarKinds()) {
        INFO(kind.name);
        MakeOptions options;
        options.exemplar.kind = kind.name;
        options.exemplar.resolution = 48;
        options.voxelSize = 0.25;
        const LevelSet model = makeModel(options);
        CHECK(model.domainRecorded);
        CHECK(model.domain.contains(solidBox(*model.grid, "made")));
        CHECK(voxelSizeOf(*model.grid) == 0.25);
        CHECK(model.grid->background() == 0.75f);
        CHECK(model.grid->getName() == "surface");
        const BandQuality quality = measureBand(*model.grid);
        CHECK(quality.finite);
        CHECK(quality.missingNeighbours == 0);
        CHECK(quality.gradientErrorMean < 0.13);
    }
    MakeOptions bad;
    bad.exemplar.kind = "grid";
    bad.voxelSize = 0;
    CHECK(test::contains(test::thrownBy([&] { makeModel(bad); }).message, "`voxelSize`"));
}
