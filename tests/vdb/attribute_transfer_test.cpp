#include "libvdbsynth/vdb/attribute_transfer.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;

namespace {

template <typename Grid>
typename Grid::Ptr named(const char* name, const typename Grid::ValueType& background) {
    openvdb::initialize();
    const auto grid = Grid::create(background);
    grid->setName(name);
    return grid;
}

// A number at every voxel of a box that tells its place.
openvdb::FloatGrid::Ptr placesIn(const IndexBox& box, float shift = 0) {
    const auto grid = named<openvdb::FloatGrid>("place", -1.f);
    forEachVoxel(box, [&](const Index3& p) {
        grid->tree().setValueOn(toCoord(p), shift + float(p.x + 100 * p.y + 10000 * p.z));
    });
    return grid;
}

LevelSet modelWith(std::vector<GridPtr> attributes) {
    LevelSet model;
    model.grid = named<openvdb::FloatGrid>("surface", 3.f);
    model.attributes = std::move(attributes);
    return model;
}

MappedVoxel mapped(const Index3& to, const Vec3d& from, std::int32_t exemplar = 0,
                   const Vec3f& rotation = {}) {
    Source source;
    source.exemplar = exemplar;
    source.position = from;
    source.rotation = rotation;
    return {to, source};
}

template <typename Grid = openvdb::FloatGrid>
typename Grid::Ptr gridOf(const std::vector<GridPtr>& grids, const std::string& name) {
    for (const GridPtr& grid : grids)
        if (grid->getName() == name && grid->isType<Grid>()) return openvdb::gridPtrCast<Grid>(grid);
    FAIL(name);
    return nullptr;
}

float valueAt(const openvdb::FloatGrid& grid, const Index3& p) {
    return grid.tree().getValue(toCoord(p));
}

// A target of 16 x 8 x 8 by three blocks of 8 that begin every 4 along x.
SourceMap threeBlocks() {
    SourceMap map;
    map.targetBox = map.targetDomain = IndexBox::fromSize({16, 8, 8});
    map.exemplars.resize(1);
    map.exemplars[0].box = IndexBox::fromSize({20, 20, 20});
    map.patches.target = map.targetBox.size();
    map.patches.block = 8;
    map.patches.stride = 4;
    map.patches.allocate();
    map.patches.source = {{0, 1, 2}, {9, 5, 4}, {3, 0, 0}};
    map.patches.exemplar = {0, 0, 0};
    return map;
}

openvdb::FloatGrid::Ptr resultOver(const IndexBox& box) {
    const auto grid = named<openvdb::FloatGrid>("surface", 3.f);
    grid->tree().denseFill(toBBox(box), 1.f, true);
    return grid;
}

}  // namespace

TEST_CASE("transferToVoxels: the source's value, else that of the nearest active voxel within two",
          "[vdb][oracle]") {
    const LevelSet exemplar = modelWith({placesIn(IndexBox::cube({0, 0, 0}, 4))});
    const auto result = resultOver({{0, 0, 0}, {9, 9, 9}});
    const auto grids = transferToVoxels({mapped({5, 5, 5}, {1, 2, 3}), mapped({6, 5, 5}, {1.4, 1.6, 3.3}),
                                         mapped({7, 5, 5}, {5, 1, 1}), mapped({8, 5, 5}, {6, 1, 1})},
                                        {&exemplar}, *result, {});
    REQUIRE(grids.size() == 1);
    const auto place = gridOf(grids, "place");
    CHECK(place->activeVoxelCount() == 3);
    CHECK(valueAt(*place, {5, 5, 5}) == 30201);
    CHECK(valueAt(*place, {6, 5, 5}) == 30201);
    CHECK(valueAt(*place, {7, 5, 5}) == 10103);  // two beyond the last one
    CHECK_FALSE(place->tree().isValueOn({8, 5, 5}));
    CHECK(place->background() == -1);
}

TEST_CASE("transferToVoxels: kind, name, metadata and background of the exemplar's, transform of the result",
          "[vdb][property]") {
    const auto number = named<openvdb::Int32Grid>("number", -7);
    number->tree().setValueOn({1, 1, 1}, 42);
    number->insertMeta("unit", openvdb::StringMetadata("class"));
    // In voxels of its own: half the size, so that world (1, 1, 1) is voxel 2.
    const auto fine = named<openvdb::DoubleGrid>("fine", 0.0);
    fine->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    fine->tree().setValueOn({2, 2, 2}, 0.25);
    LevelSet exemplar = modelWith({number, fine, named<openvdb::Vec3IGrid>("source", openvdb::Vec3i(0))});
    const auto result = resultOver({{0, 0, 0}, {3, 3, 3}});
    result->setTransform(openvdb::math::Transform::createLinearTransform(3.0));
    const auto grids = transferToVoxels({mapped({2, 2, 2}, {1, 1, 1})}, {&exemplar}, *result, {});
    REQUIRE(grids.size() == 2);  // those of a source map stay behind
    const auto copied = gridOf<openvdb::Int32Grid>(grids, "number");
    CHECK(copied->tree().getValue({2, 2, 2}) == 42);
    CHECK(copied->background() == -7);
    CHECK(copied->metaValue<std::string>("unit") == "class");
    CHECK(copied->transform() == result->transform());
    CHECK(gridOf<openvdb::DoubleGrid>(grids, "fine")->tree().getValue({2, 2, 2}) == 0.25);
    CHECK(number->transform().voxelSize().x() == 1);  // the exemplar's own is left alone
}

TEST_CASE("transferToVoxels: vectors with a direction turn with their source, colours do not",
          "[vdb][oracle]") {
    const auto flow = named<openvdb::Vec3SGrid>("flow", openvdb::Vec3f(0));
    flow->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    const auto colour = named<openvdb::Vec3SGrid>("Cd", openvdb::Vec3f(0));
    for (const auto& grid : {flow, colour}) grid->tree().setValueOn({0, 0, 0}, openvdb::Vec3f(1, 2, 3));
    const LevelSet exemplar = modelWith({flow, colour});
    const auto grids = transferToVoxels(
        {mapped({0, 0, 0}, {0, 0, 0}, 0, {0, 0, float(kPi / 2)}), mapped({1, 0, 0}, {0, 0, 0})}, {&exemplar},
        *resultOver({{0, 0, 0}, {1, 1, 1}}), {});
    const auto turned = gridOf<openvdb::Vec3SGrid>(grids, "flow");
    CHECK((turned->tree().getValue({0, 0, 0}) - openvdb::Vec3f(-2, 1, 3)).length() < 1e-5f);
    CHECK(turned->tree().getValue({1, 0, 0}) == openvdb::Vec3f(1, 2, 3));
    CHECK(gridOf<openvdb::Vec3SGrid>(grids, "Cd")->tree().getValue({0, 0, 0}) == openvdb::Vec3f(1, 2, 3));
}

TEST_CASE("transferToVoxels: grids of one name and kind become one, given ones are written into",
          "[vdb][property]") {
    const LevelSet a = modelWith({placesIn(IndexBox::cube({0, 0, 0}, 4))});
    const LevelSet b =
        modelWith({placesIn(IndexBox::cube({0, 0, 0}, 4), 0.5f), named<openvdb::Int32Grid>("place", 0)});
    const auto kept = placesIn({{9, 9, 9}, {9, 9, 9}});
    const auto grids = transferToVoxels({mapped({0, 0, 0}, {1, 0, 0}), mapped({1, 0, 0}, {2, 0, 0}, 1)},
                                        {&a, &b}, *resultOver({{0, 0, 0}, {9, 9, 9}}), {kept});
    REQUIRE(grids.size() == 2);
    CHECK(grids[0] == kept);
    CHECK(valueAt(*kept, {0, 0, 0}) == 1);
    CHECK(valueAt(*kept, {1, 0, 0}) == 2.5f);
    CHECK(valueAt(*kept, {9, 9, 9}) == 90909);
    CHECK(grids[1]->isType<openvdb::Int32Grid>());
    CHECK(transferToVoxels({}, {&a}, *resultOver({{0, 0, 0}, {1, 1, 1}}), {kept}) ==
          std::vector<GridPtr>{kept});
}

TEST_CASE("transferToVoxels: kinds and transforms that are not supported are left out with a warning",
          "[vdb][error]") {
    const auto bent = named<openvdb::FloatGrid>("bent", 0.f);
    bent->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(8)), 0.5, 10));
    const LevelSet exemplar = modelWith({named<openvdb::MaskGrid>("mask", false), bent});
    std::vector<std::string> warnings;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Warning) warnings.push_back(text);
    };
    CHECK(transferToVoxels({mapped({0, 0, 0}, {0, 0, 0})}, {&exemplar}, *resultOver({{0, 0, 0}, {1, 1, 1}}),
                           {}, ctx)
              .empty());
    REQUIRE(warnings.size() == 2);
    CHECK(test::contains(warnings[0], "\"mask\""));
    CHECK(test::contains(warnings[1], "\"bent\""));
}

TEST_CASE("transferAttributes: on the band inside the domain, copied or blended as votes are weighted",
          "[vdb][oracle]") {
    const LevelSet exemplar = modelWith({placesIn(IndexBox::cube({0, 0, 0}, 20))});
    const SourceMap map = threeBlocks();
    const auto result = resultOver({{-2, 0, 0}, {15, 7, 7}});
    const auto copied =
        gridOf(transferAttributes(map, {&exemplar}, *result, AttributeValues::Copied), "place");
    const auto blended =
        gridOf(transferAttributes(map, {&exemplar}, *result, AttributeValues::Blended), "place");
    CHECK(copied->activeVoxelCount() == 16 * 8 * 8);
    CHECK(blended->activeVoxelCount() == copied->activeVoxelCount());
    // Voxel 3 is voxel 3 of the first block alone; voxel 4 is voxel 4 of the first and 0 of the second, whose
    // tents are 3.5 and 0.5, squared.
    CHECK(valueAt(*copied, {3, 3, 3}) == 3 + 400 + 50000);
    CHECK(valueAt(*blended, {3, 3, 3}) == 3 + 400 + 50000);
    const double first = 4 + 400 + 50000, second = 9 + 800 + 70000;
    CHECK(valueAt(*copied, {4, 3, 3}) == float(first));
    CHECK(double(valueAt(*blended, {4, 3, 3})) == Approx((49 * first + second) / 50));
}

TEST_CASE("transferAttributes: blended values of single voxels are copies, and where none is there is none",
          "[vdb][property][degenerate]") {
    const LevelSet exemplar = modelWith({placesIn(IndexBox::cube({0, 0, 0}, 4))});
    SourceMap map;
    map.method = MapMethod::Analogy;
    map.exemplars.resize(1);
    map.elements.add({2, 2, 2}, mapped({}, {1, 2, 3}).from);
    map.elements.add({3, 2, 2}, mapped({}, {90, 2, 3}).from);
    const auto result = resultOver({{0, 0, 0}, {4, 4, 4}});
    for (AttributeValues values : {AttributeValues::Copied, AttributeValues::Blended}) {
        const auto place = gridOf(transferAttributes(map, {&exemplar}, *result, values), "place");
        CHECK(place->activeVoxelCount() == 1);
        CHECK(valueAt(*place, {2, 2, 2}) == 30201);
    }
    const LevelSet bare = modelWith({});
    CHECK(transferAttributes(map, {&bare}, *result, AttributeValues::Copied).empty());
}

TEST_CASE("transferAttributes: same bits for any number of threads, cancelled when asked",
          "[vdb][determinism][cancel]") {
    const LevelSet exemplar = modelWith({placesIn(IndexBox::cube({0, 0, 0}, 20), 0.1f)});
    const SourceMap map = threeBlocks();
    const auto result = resultOver(map.targetBox);
    RunContext one, four, stopped;
    one.threads = 1;
    four.threads = 4;
    const auto blend = [&](const RunContext& ctx) {
        return gridOf(transferAttributes(map, {&exemplar}, *result, AttributeValues::Blended, ctx), "place");
    };
    CHECK(levelSetHash(*blend(one)) == levelSetHash(*blend(four)));
    std::atomic<bool> cancel{true};
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { blend(stopped); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("hasAttribute, keepAttributes: by name, the others' order stays", "[vdb][oracle]") {
    LevelSet model = modelWith({named<openvdb::FloatGrid>("a", 0.f), named<openvdb::Int32Grid>("b", 0),
                                named<openvdb::FloatGrid>("c", 0.f), named<openvdb::Int32Grid>("a", 0)});
    CHECK(hasAttribute(model, "b"));
    CHECK_FALSE(hasAttribute(model, "surface"));
    CHECK_FALSE(hasAttribute(model, ""));
    keepAttributes(model, {"c", "a", "none"});
    REQUIRE(model.attributes.size() == 3);
    CHECK(model.attributes[1]->getName() == "c");
    CHECK_FALSE(hasAttribute(model, "b"));
    keepAttributes(model, {});
    CHECK(model.attributes.empty());
}
