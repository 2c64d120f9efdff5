#include "libvdbsynth/pipeline/patch/patch_outputs.h"

#include "libvdbsynth/pipeline/patch/patch.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Interpolation.h>
#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/support/patch_sources.h"

using namespace vdbsynth;

namespace {

PatchSheet crate(const PatchSource& source) {
    PatchOptions options;
    options.width = 60;
    options.depth = 48;
    return makePatchSheet(source, options);
}

}  // namespace

TEST_CASE("sheetCloud: the sheet without its border, with what it is a copy of", "[pipeline][patch]") {
    PatchSource source = test::eggCrateSource();
    Attribute colour{"Cd", 1, {}};
    for (std::size_t p = 0; p < source.exemplar.points.size(); ++p) colour.values.push_back(float(p % 251));
    source.attributes = {colour};
    const PatchSheet sheet = crate(source);
    const PointCloud cloud = sheetCloud(source, sheet);
    REQUIRE(cloud.points.size() < sheet.result.sheet.size());
    const Attribute *number = findAttribute(cloud.attributes, "source"),
                    *patch = findAttribute(cloud.attributes, "patch"),
                    *carried = findAttribute(cloud.attributes, "Cd");
    REQUIRE(number);
    REQUIRE(patch);
    REQUIRE(carried);
    for (std::size_t p = 0; p < cloud.points.size(); ++p) {
        const Vec3d at = cast<double>(cloud.points[p]) - source.exemplar.corner;
        CHECK((at.x >= -1e-3 && at.x < 60.001 && at.y >= -1e-3 && at.y < 48.001));
        CHECK(carried->values[p] == float(std::size_t(number->values[p]) % 251));
    }
}

TEST_CASE("sheetLevelSet: valid, capped at the sheet's sides, on the points", "[pipeline][patch]") {
    openvdb::initialize();
    for (const PatchPlane plane : {PatchPlane::XY, PatchPlane::YZ, PatchPlane::ZX}) {
        const PatchSource source = test::eggCrateSource(plane);
        const PatchSheet sheet = crate(source);
        const LevelSet model = sheetLevelSet(source, sheet, 1, 3);
        CHECK(model.domainRecorded);
        const Vec3d size = toPlane(plane, {double(model.domain.size().x), double(model.domain.size().y),
                                           double(model.domain.size().z)});
        CHECK(size.x == Approx(60).margin(1));
        CHECK(size.y == Approx(48).margin(1));
        const BandQuality quality = measureBand(*model.grid);
        CHECK(quality.finite);
        CHECK(quality.missingNeighbours == 0);
        openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sampler(*model.grid);
        double worst = 0;
        const PointCloud cloud = sheetCloud(source, sheet);
        for (const Vec3f& point : cloud.points) {
            const Vec3d at = toPlane(plane, cast<double>(point) - source.exemplar.corner);
            if (at.x < 4 || at.y < 4 || at.x > 56 || at.y > 44) continue;
            worst = std::max(worst, std::abs(double(sampler.wsSample({point.x, point.y, point.z}))));
        }
        CHECK(worst < 0.35);
    }
}

TEST_CASE("sheetLevelSet: same bits for any number of threads", "[pipeline][patch][threads]") {
    openvdb::initialize();
    const PatchSource source = test::eggCrateSource();
    const PatchSheet sheet = crate(source);
    RunContext one, three;
    one.threads = 1;
    three.threads = 3;
    const LevelSet a = sheetLevelSet(source, sheet, 1.5, 3, one),
                   b = sheetLevelSet(source, sheet, 1.5, 3, three);
    REQUIRE(a.grid->activeVoxelCount() == b.grid->activeVoxelCount());
    for (auto it = a.grid->cbeginValueOn(); it; ++it)
        CHECK(b.grid->tree().getValue(it.getCoord()) == it.getValue());
}
