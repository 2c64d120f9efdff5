#include "libvdbsynth/pipeline/mask/mask.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

#include <atomic>
#include <limits>

using namespace vdbsynth;

namespace {

MaskOptions ofBox() {
    MaskOptions options;
    options.box = IndexBox{{-2, 0, 1}, {7, 4, 3}};
    return options;
}

MaskOptions ofBall(double radius) {
    MaskOptions options;
    options.kind = MaskKind::Ball;
    options.center = Vec3d{1, 2, 3};
    options.radius = radius;
    return options;
}

MaskOptions ofRange(double low, double high) {
    MaskOptions options;
    options.kind = MaskKind::Range;
    options.range = {low, high};
    return options;
}

double countOf(const GridPtr& mask) {
    return double(mask->activeVoxelCount());
}

FloatGridPtr sphere() {
    openvdb::initialize();
    return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(6.f, {1.f, 2.f, 3.f}, 0.5f, 3.f);
}

void refuses(const MaskOptions& options, const FloatGridConstPtr& grid, const std::string& says,
             const RunContext& ctx = {}, ErrorCode code = ErrorCode::InvalidOption) {
    const test::Thrown thrown = test::thrownBy([&] { makeMask(options, grid, ctx); });
    INFO(says << " / " << thrown.message);
    CHECK(thrown.code == int(code));
    CHECK(test::contains(thrown.message, says));
}

}  // namespace

TEST_CASE("makeMask: every kind holds what it names", "[pipeline][oracle]") {
    openvdb::initialize();
    MaskOptions options = ofBox();
    const GridPtr box = makeMask(options);
    CHECK(countOf(box) == 10 * 5 * 3);
    CHECK(box->getName() == "mask");
    CHECK(box->isType<openvdb::BoolGrid>());
    CHECK(box->voxelSize()[0] == 1);
    options.voxelSize = 0.25;
    CHECK(makeMask(options)->voxelSize()[2] == 0.25);
    options = ofBall(5);
    options.voxelSize = 0.5;
    CHECK(countOf(makeMask(options)) == Approx(4.18879 * 1000).epsilon(0.02));
    const FloatGridPtr model = sphere();
    options = {};
    options.kind = MaskKind::Inside;
    const GridPtr inside = makeMask(options, model);
    CHECK(countOf(inside) == solidVoxels(*model));
    CHECK(inside->transform() == model->transform());
    // One value that few voxels have, and all of them.
    CHECK(countOf(makeMask(ofRange(-1e9, 1e9), model)) == double(model->activeVoxelCount()));
    const double value = double(*model->cbeginValueOn());
    CHECK(countOf(makeMask(ofRange(value, value), model)) >= 1);
}

TEST_CASE("makeMask: what is missing or out of its range is refused", "[pipeline][error]") {
    const FloatGridPtr model = sphere();
    MaskOptions options;
    refuses(options, nullptr, "mask box: give `box`");
    options.box = IndexBox{{5, 0, 0}, {1, 9, 9}};
    refuses(options, nullptr, "`box` 5,0,0,1,9,9: must be");
    options = ofBall(3);
    options.center.reset();
    refuses(options, nullptr, "mask ball: give `center` and `radius`");
    options = ofBall(3);
    options.radius.reset();
    refuses(options, nullptr, "mask ball: give `center` and `radius`");
    options = ofBall(3);
    options.center = Vec3d{0, 1e9, 0};
    refuses(options, nullptr, "`center` 0,1e+09,0: must be within 100 million voxels of the origin");
    options.center = Vec3d{0, std::numeric_limits<double>::quiet_NaN(), 0};
    refuses(options, nullptr, "`center`");
    for (const double radius : {0.0, -1.0, 1e4}) refuses(ofBall(radius), nullptr, "`radius`");
    options = ofBox();
    for (const double voxel : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
        options.voxelSize = voxel;
        refuses(options, nullptr, "`voxelSize`");
    }
    options = {};
    options.kind = MaskKind::Range;
    refuses(options, model, "mask range: give `range`");
    refuses(ofRange(2, 1), model, "`range` 2,1: must be two numbers, the lower one first");
    refuses(ofRange(0, 1), nullptr, "mask range: give a model or a grid");
    options.kind = MaskKind::Inside;
    refuses(options, nullptr, "mask inside: give a model or a grid");
    refuses(ofBox(), model, "mask box: takes no model");
}

TEST_CASE("makeMask: memory and cancel", "[pipeline][error][cancel]") {
    openvdb::initialize();
    RunContext ctx;
    ctx.maxMemory = 1 << 20;
    refuses(ofBall(2000), nullptr, "`radius` 2000 needs", ctx, ErrorCode::Memory);
    MaskOptions large = ofBox();
    large.box = IndexBox{{0, 0, 0}, {99999, 99999, 99999}};
    refuses(large, nullptr, "a mask of 0,0,0,99999,99999,99999 needs", ctx, ErrorCode::Memory);
    const std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    refuses(ofBall(50), nullptr, "", stopped, ErrorCode::Cancelled);
    const FloatGridPtr model = sphere();
    MaskOptions inside;
    inside.kind = MaskKind::Inside;
    refuses(inside, model, "", stopped, ErrorCode::Cancelled);
    refuses(ofRange(0, 1), model, "", stopped, ErrorCode::Cancelled);
}

TEST_CASE("makeMask: a field of another kind is said", "[pipeline]") {
    openvdb::initialize();
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        CHECK(level == MessageLevel::Note);
        said += text + "\n";
    };
    MaskOptions options = ofBox();
    makeMask(options, nullptr, ctx);
    CHECK(said.empty());
    options.radius = 3;
    options.center = Vec3d{0, 0, 0};
    makeMask(options, nullptr, ctx);
    CHECK(said == "`center` has no effect on mask box\n`radius` has no effect on mask box\n");
    said.clear();
    options.kind = MaskKind::Inside;
    options.voxelSize = 2;
    makeMask(options, sphere(), ctx);
    CHECK(test::contains(said, "`voxelSize` has no effect on mask inside"));
}

TEST_CASE("makeMask: an empty range is said, with the values that there are", "[pipeline]") {
    openvdb::initialize();
    test::Said said;
    MaskOptions options;
    options.kind = MaskKind::Range;
    options.range = {500, 600};
    CHECK(makeMask(options, sphere(), said.ctx)->empty());
    CHECK(said.warned("the mask is empty: no value lies from 500 to 600; the grid's values go from -"));
    options.range = {-1, 1};
    test::Said nothing;
    CHECK_FALSE(makeMask(options, sphere(), nothing.ctx)->empty());
    CHECK(nothing.nothing());
    CHECK(makeMask(options, openvdb::FloatGrid::create(9), said.ctx)->empty());
    CHECK(said.warned("as the grid has no active voxel"));
}

TEST_CASE("parseMaskKind: the words of the kinds, and no others", "[pipeline]") {
    MaskKind kind{};
    CHECK(parseMaskKind("range", kind));
    CHECK(kind == MaskKind::Range);
    CHECK(parseMaskKind("inside", kind));
    CHECK(kind == MaskKind::Inside);
    for (const char* word : {"", "Box", "blob", "boxes"}) CHECK_FALSE(parseMaskKind(word, kind));
    CHECK(kind == MaskKind::Inside);
}
