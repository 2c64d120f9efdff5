#include "libvdbsynth/pipeline/pose/pose.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/contexts.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

namespace {

constexpr int kRadius = 16, kHalf = 26;

// A motion, and its inverse.
struct Motion {
    double c = 1, s = 0;
    Vec3d by;
    Vec3d operator()(const Vec3d& p) const { return Vec3d{c * p.x - s * p.y, s * p.x + c * p.y, p.z} + by; }
    Vec3d back(const Vec3d& q) const {
        const Vec3d p = q - by;
        return {c * p.x + s * p.y, c * p.y - s * p.x, p.z};
    }
};

Mesh ballMesh(const Motion& motion) {
    constexpr int kRings = 40, kSegments = 80;
    Mesh mesh;
    for (int i = 0; i <= kRings; ++i)
        for (int j = 0; j < kSegments; ++j) {
            const double polar = 3.14159265358979 * i / kRings, turn = 6.28318530717959 * j / kSegments;
            const Vec3d unit{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                             std::cos(polar)};
            mesh.points.push_back(cast<float>(motion(unit * double(kRadius))));
        }
    const auto at = [](int i, int j) { return std::uint32_t(i * kSegments + j % kSegments); };
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSegments; ++j) {
            if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < kRings) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    return mesh;
}

LevelSet modelOf(const Mesh& mesh) {
    openvdb::initialize();
    LevelSet model;
    model.grid = meshToLevelSet(mesh, 1, 3, "the ball");
    model.domain = solidBox(*model.grid, "the ball");
    model.source = std::make_shared<const Mesh>(mesh);
    stampLevelSet(model);
    return model;
}

// The ball with bumps: about the distance to it.
double bumpy(const Vec3d& p) {
    const double r = std::max(length(p), 1e-9);
    return r - kRadius - 1.5 * std::sin(0.4 * p.x) * std::sin(0.4 * p.y) * std::sin(0.4 * p.z + 1);
}

LevelSet bumpyBall(const Motion& motion = {}) {
    openvdb::initialize();
    LevelSet model;
    const BrickField field =
        test::fieldFrom({2 * kHalf + 1, 2 * kHalf + 1, 2 * kHalf + 1}, [&](const Index3& p) {
            const Vec3d at{double(p.x - kHalf), double(p.y - kHalf), double(p.z - kHalf)};
            return float(std::clamp(bumpy(motion.back(at)), -3.0, 3.0));
        });
    const BrickField band = closedBand(field, {-kHalf, -kHalf, -kHalf}, {});
    model.grid = levelSetFrom(band, 3, 1.0, "the bumpy ball");
    model.domain = solidBox(*model.grid, "the bumpy ball");
    stampLevelSet(model);
    return model;
}

// The largest difference of a posed result from the bumps moved, near its surface.
double worstAgainst(const LevelSet& result, const Motion& motion) {
    const LevelSet wanted = bumpyBall(motion);
    const auto accessor = result.grid->getConstAccessor();
    double worst = 0;
    for (auto value = wanted.grid->cbeginValueOn(); value; ++value)
        if (std::abs(*value) < 0.6f)
            worst = std::max(worst, std::abs(double(accessor.getValue(value.getCoord()) - *value)));
    return worst;
}

}  // namespace

TEST_CASE("poseModel: in the pose at rest the result comes back", "[pipeline][pose]") {
    const LevelSet rest = modelOf(ballMesh({})), made = bumpyBall();
    PoseOptions options;
    options.reach = 3;
    const LevelSet same = poseModel(made, rest, rest, options);
    CHECK(worstAgainst(same, {}) < 0.1);
    requireModel(&same, "the posed model");
    CHECK(measureBand(*same.grid).missingNeighbours == 0);
}

TEST_CASE("poseModel: a rigid motion moves the result as it moves the mesh", "[pipeline][pose][property]") {
    const Motion motion{0.8, 0.6, {4.3, -2.6, 1.2}};
    const LevelSet rest = modelOf(ballMesh({})), posed = modelOf(ballMesh(motion)), made = bumpyBall();
    PoseOptions options;
    options.reach = 3;
    CHECK(worstAgainst(poseModel(made, rest, posed, options), motion) < 0.2);
}

TEST_CASE("poseModel: attributes are transferred, directions are turned", "[pipeline][pose]") {
    const Motion motion{0.8, 0.6, {4.3, -2.6, 1.2}};
    LevelSet made = bumpyBall();
    auto height = openvdb::FloatGrid::create(0);
    height->setName("height");
    auto direction = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
    direction->setName("flow");
    direction->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    for (auto value = made.grid->cbeginValueOn(); value; ++value) {
        height->tree().setValueOn(value.getCoord(), float(value.getCoord().x()));
        direction->tree().setValueOn(value.getCoord(), openvdb::Vec3s(1, 0, 0));
    }
    made.attributes = {height, direction};
    PoseOptions options;
    options.reach = 3;
    const LevelSet result = poseModel(made, modelOf(ballMesh({})), modelOf(ballMesh(motion)), options);
    REQUIRE(result.attributes.size() == 2);
    const auto values = openvdb::gridPtrCast<openvdb::FloatGrid>(result.attributes[0]);
    const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(result.attributes[1]);
    REQUIRE(values);
    REQUIRE(vectors);
    CHECK(values->activeVoxelCount() > result.grid->activeVoxelCount() * 9 / 10);
    for (auto value = values->cbeginValueOn(); value; ++value) {
        const Vec3d at = motion.back(fromVec(values->indexToWorld(value.getCoord())));
        REQUIRE(std::abs(double(*value) - at.x) < 2.6);  // the nearest active voxel's
    }
    for (auto value = vectors->cbeginValueOn(); value; ++value)
        REQUIRE((*value - openvdb::Vec3s(0.8f, 0.6f, 0)).length() < 0.02f);
}

TEST_CASE("poseModel: by a grid of rest positions, and what it does not reach is said", "[pipeline][pose]") {
    const Vec3d by{4, 3, 2};
    const Motion motion{1, 0, by};
    const LevelSet made = bumpyBall();
    LevelSet posed = modelOf(ballMesh(motion));
    posed.source = nullptr;
    const auto withRest = [&](double band) {
        auto rest = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
        rest->setName("rest");
        for (int x = -kHalf; x <= kHalf; ++x)
            for (int y = -kHalf; y <= kHalf; ++y)
                for (int z = -kHalf; z <= kHalf; ++z) {
                    const Vec3d at{double(x), double(y), double(z)};
                    if (std::abs(length(at) - kRadius) < band)
                        rest->tree().setValueOn(toCoord({x + 4, y + 3, z + 2}), openvdb::Vec3s(toVec(at)));
                }
        LevelSet model = posed;
        model.attributes = {rest};
        return model;
    };
    PoseOptions options;
    options.reach = 3;
    test::Said wide;
    CHECK(worstAgainst(poseModel(made, {}, withRest(9), options, wide.ctx), motion) < 0.1);
    CHECK(wide.warnings.empty());
    test::Said narrow;
    poseModel(made, {}, withRest(2), options, narrow.ctx);
    CHECK(narrow.warned("have no place at rest"));
    CHECK(narrow.warned("a grid \"rest\" with a wider band"));
}

TEST_CASE("poseModel: what it refuses", "[pipeline][pose][error]") {
    const LevelSet rest = modelOf(ballMesh({})), made = bumpyBall();
    Mesh fewer = ballMesh({});
    fewer.triangles.pop_back();
    fewer.triangles.push_back(fewer.triangles.front());
    CHECK(test::thrownBy([&] { poseModel(made, rest, modelOf(fewer)); }).code ==
          int(ErrorCode::ShapeMismatch));
    LevelSet bare = rest;
    bare.source = nullptr;
    const test::Thrown neither = test::thrownBy([&] { poseModel(made, rest, bare); });
    CHECK(neither.code == int(ErrorCode::Unusable));
    CHECK(test::contains(neither.message, "\"rest\""));
    PoseOptions options;
    options.reach = 65;
    CHECK(test::thrownBy([&] { poseModel(made, rest, rest, options); }).code ==
          int(ErrorCode::InvalidOption));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              poseModel(made, rest, rest, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("poseModel: same for any number of threads", "[pipeline][pose][tsan]") {
    const Motion motion{0.8, 0.6, {1, 2, 3}};
    const LevelSet rest = modelOf(ballMesh({})), posed = modelOf(ballMesh(motion)), made = bumpyBall();
    const LevelSet one = poseModel(made, rest, posed, {}, test::onThreads(1)),
                   three = poseModel(made, rest, posed, {}, test::onThreads(3));
    CHECK(levelSetHash(*one.grid) == levelSetHash(*three.grid));
}
