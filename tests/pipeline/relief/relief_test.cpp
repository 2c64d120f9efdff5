#include "libvdbsynth/pipeline/relief/relief.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/contexts.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace vdbsynth;

namespace {

LevelSet asModel(const FloatGridPtr& grid) {
    LevelSet model;
    model.grid = grid;
    model.domain = solidBox(*grid, "test");
    stampLevelSet(model);
    return model;
}

LevelSet ball(float radius, float voxel = 1, const openvdb::Vec3f& middle = {0, 0, 0}) {
    openvdb::initialize();
    return asModel(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, middle, voxel, 3));
}

// A surface round the z axis: radius(z), closed at both ends.
Mesh turned(const std::function<double(double z, double angle)>& radius, double height, int around,
            int along) {
    Mesh mesh;
    for (int j = 0; j <= along; ++j)
        for (int i = 0; i < around; ++i) {
            const double angle = 2 * kPi * i / around, z = height * j / along, r = radius(z, angle);
            mesh.points.push_back({float(r * cosine(angle)), float(r * sine(angle)), float(z)});
        }
    const auto at = [around](int j, int i) { return std::uint32_t(j * around + i % around); };
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < around; ++i) {
            mesh.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i + 1)});
            mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j + 1, i)});
        }
    const std::uint32_t low = std::uint32_t(mesh.points.size()), high = low + 1;
    mesh.points.push_back({0, 0, 0});
    mesh.points.push_back({0, 0, float(height)});
    for (int i = 0; i < around; ++i) {
        mesh.triangles.push_back({low, at(0, i + 1), at(0, i)});
        mesh.triangles.push_back({high, at(along, i), at(along, i + 1)});
    }
    return mesh;
}

LevelSet solid(const Mesh& mesh, double voxel = 1) {
    openvdb::initialize();
    return asModel(meshToSolid(mesh, voxel, 3, "test"));
}

LevelSet cylinder(double radius, double height) {
    return solid(turned([radius](double, double) { return radius; }, height, 256, 8));
}

ReliefSource wavePicture(int side, int period, double height) {
    ReliefSource source;
    source.heights = {side, side, 1, true, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            source.heights.values.push_back(float(0.5 + 0.5 * sine(2 * kPi * (x + 0.5) / period)));
    source.height = height;
    return source;
}

ReliefOptions around(const char* text = "around:z") {
    ReliefOptions options;
    options.direction.emplace();
    REQUIRE(parseDirection(text, *options.direction));
    return options;
}

// The radius of a model round the z axis at a height, by angle; 0 where nothing is met.
std::vector<double> radiiOf(const LevelSet& model, double z, int count, double most) {
    std::vector<double> radii;
    auto read = model.grid->getConstAccessor();
    const double voxel = voxelSizeOf(*model.grid);
    const auto at = [&](double angle, double r) {
        const openvdb::Vec3d p(r * cosine(angle) / voxel, r * sine(angle) / voxel, z / voxel);
        double sum = 0;
        const openvdb::Vec3d base(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
        for (int k = 0; k < 8; ++k) {
            const openvdb::Vec3d corner = base + openvdb::Vec3d(k & 1, (k >> 1) & 1, k >> 2);
            double weight = 1;
            for (int a = 0; a < 3; ++a) weight *= 1 - std::abs(p[a] - corner[a]);
            sum += weight *
                   double(read.getValue(openvdb::Coord(int(corner.x()), int(corner.y()), int(corner.z()))));
        }
        return sum;
    };
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * kPi * i / count;
        double r = most;
        while (r > 0 && at(angle, r) > 0) r -= 0.1;
        double inside = r, outside = r + 0.1;
        for (int step = 0; step < 20; ++step) {
            const double middle = (inside + outside) / 2;
            (at(angle, middle) > 0 ? outside : inside) = middle;
        }
        radii.push_back(inside);
    }
    return radii;
}

}  // namespace

TEST_CASE("transferRelief: a picture of waves round a cylinder closes with whole waves of the right height",
          "[pipeline]") {
    ReliefOptions options = around();
    options.fit = true;
    ReliefSource source = wavePicture(64, 16, 3);
    const LevelSet target = cylinder(40, 60);
    const ReliefResult result = transferRelief({source}, target, nullptr, options);
    // Round it go 251.3 voxels, 3.93 pictures of 64: four.
    CHECK(result.fitted == Approx(2 * kPi * 40 / 256).epsilon(0.01));
    const std::vector<double> radii = radiiOf(result.model, 30, 720, 48);
    int crossings = 0;
    double low = 100, high = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        crossings += (radii[i] > 40) != (radii[(i + 1) % radii.size()] > 40);
        low = std::min(low, radii[i]);
        high = std::max(high, radii[i]);
    }
    CHECK(crossings == 32);  // 16 waves
    CHECK((high - low) / 2 == Approx(1.5).epsilon(0.05));
    CHECK(measureBand(*result.model.grid).gradientErrorMean < 0.1);
}

TEST_CASE("transferRelief: waves of a scan arrive with their height", "[pipeline]") {
    // Rings round a cylinder, wavelength 12, amplitude 1.
    const LevelSet scan =
        solid(turned([](double z, double) { return 30 + sine(2 * kPi * z / 12); }, 96, 256, 192));
    ReliefOptions options = around("axis:z");
    options.exemplarDirection = options.direction;
    options.baseRadius = 8;
    const ReliefResult result = transferRelief({{&scan, {}, 0, 0}}, cylinder(36, 90), nullptr, options);
    CHECK(result.baseRadius == Approx(8));
    CHECK(result.covered.front() > 0.8);
    CHECK_FALSE(result.folds);
    // Along the axis at one angle: amplitude.
    double low = 100, high = 0;
    for (double z = 25; z < 65; z += 0.5) {
        const double r = radiiOf(result.model, z, 1, 44).front();
        low = std::min(low, r);
        high = std::max(high, r);
    }
    CHECK((high - low) / 2 == Approx(1).margin(0.15));
}

TEST_CASE("transferRelief: a mask keeps the target's bits outside, --fade rises inside", "[pipeline]") {
    const LevelSet target = ball(30), mask = ball(20, 1, {30, 0, 0});
    ReliefOptions options;
    options.maskModel = &mask;
    options.fade = 6;
    const ReliefResult result = transferRelief({wavePicture(32, 8, 3)}, target, nullptr, options);
    CHECK(result.unchanged > 0.6);
    auto before = target.grid->getConstAccessor(), after = result.model.grid->getConstAccessor();
    std::size_t outside = 0, changed = 0, inside = 0;
    for (auto voxel = target.grid->cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Coord at = voxel.getCoord();
        const double far = (openvdb::Vec3d(at.x() - 30, at.y(), at.z())).length() - 20;
        if (far > 10) {
            ++outside;
            changed += after.getValue(at) != *voxel || !after.isValueOn(at);
        } else if (far < -6) {
            inside += after.getValue(at) != before.getValue(at);
        }
    }
    CHECK(outside > 10000);
    CHECK(changed == 0);
    CHECK(inside > 500);
}

TEST_CASE("transferRelief: parts that carving cuts off are said, a least wall keeps them", "[pipeline]") {
    // A rod of radius 3 that waves four voxels deep cut through.
    const LevelSet rod = cylinder(3, 60);
    ReliefOptions options = around("axis:z");
    const auto parts = [&](double minWall, std::string& said) {
        options.minWall = minWall;
        RunContext ctx;
        ctx.onMessage = [&](MessageLevel level, const std::string& text) {
            if (level == MessageLevel::Warning) said += text;
        };
        return transferRelief({wavePicture(64, 16, 12)}, rod, nullptr, options, ctx).parts;
    };
    std::string cut, kept;
    CHECK(parts(0, cut) > 1);
    CHECK(cut.find("1 part became") != std::string::npos);
    CHECK(cut.find("`minWall`") != std::string::npos);
    CHECK(parts(4, kept) == 1);
    CHECK(kept.empty());
}

TEST_CASE("transferRelief: several samples by place, sources are written", "[pipeline]") {
    const LevelSet target = ball(25);
    const ReliefLabels halves = [](const TextureShape& sites) {
        std::vector<std::int32_t> labels;
        for (const Vec3f& p : sites.site) labels.push_back(double(p.x) + sites.origin.x > 0);
        return labels;
    };
    const ReliefResult result =
        transferRelief({wavePicture(32, 8, 1), wavePicture(32, 16, 4)}, target, halves, {});
    REQUIRE(result.sources.size() == 3);
    const auto exemplar = openvdb::gridPtrCast<openvdb::FloatGrid>(result.sources[2]);
    REQUIRE(exemplar);
    CHECK(exemplar->getName() == "exemplar");
    std::size_t wrong = 0, counted = 0;
    for (auto voxel = exemplar->cbeginValueOn(); voxel; ++voxel) {
        if (std::abs(voxel.getCoord().x()) < 3) continue;
        ++counted;
        wrong += (*voxel > 0.5f) != (voxel.getCoord().x() > 0);
    }
    CHECK(counted > 5000);
    CHECK(wrong == 0);
    CHECK_THROWS_AS(transferRelief({wavePicture(32, 8, 1)}, target, halves, {}), Error);
}

TEST_CASE("transferRelief: the paper's method grows a scan's relief", "[pipeline]") {
    const LevelSet scan =
        solid(turned([](double z, double) { return 12 + 0.8 * sine(2 * kPi * z / 8); }, 40, 96, 120));
    ReliefOptions options = around("axis:z");
    options.exemplarDirection = options.direction;
    options.method = ReliefMethod::Paper;
    options.baseRadius = 5;
    options.neighbourhood = 4;
    const ReliefResult result = transferRelief({{&scan, {}, 0, 0}}, cylinder(14, 40), nullptr, options);
    double low = 100, high = 0;
    for (double z = 12; z < 28; z += 0.5) {
        const double r = radiiOf(result.model, z, 1, 20).front();
        low = std::min(low, r);
        high = std::max(high, r);
    }
    CHECK((high - low) / 2 == Approx(0.8).margin(0.3));
    CHECK(result.mismatch > 0);
}

TEST_CASE("transferRelief: same bits for any number of threads", "[pipeline][threads]") {
    const LevelSet target = ball(18);
    const auto values = [&](int threads) {
        const ReliefResult result =
            transferRelief({wavePicture(32, 8, 2)}, target, nullptr, {}, test::onThreads(threads));
        return levelSetHash(*result.model.grid);
    };
    CHECK(values(1) == values(4));
}

TEST_CASE("transferRelief: every error, cancel", "[pipeline]") {
    const LevelSet target = ball(12);
    const std::vector<ReliefSource> picture{wavePicture(16, 8, 2)};
    const auto refused = [&](const std::function<void(ReliefOptions&)>& change, ErrorCode code) {
        ReliefOptions options;
        change(options);
        try {
            transferRelief(picture, target, nullptr, options);
            FAIL("nothing was thrown");
        } catch (const Error& error) {
            CHECK(int(error.code()) == int(code));
        }
    };
    refused([](auto& o) { o.baseRadius = -1; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.scale = 0; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.strength = 101; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.minWall = -1; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.neighbourhood = -1; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.top = 101; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.fade = 1; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.fit = true; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.halfWidth = 1; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.method = ReliefMethod::Paper; }, ErrorCode::InvalidOption);
    refused([](auto& o) { o.maskAttribute = "painted"; }, ErrorCode::Unusable);
    refused(
        [](auto& o) {
            o.strength = 90;
            o.scale = 20;
        },
        ErrorCode::Unusable);  // reaches too far

    ReliefSource flat = wavePicture(16, 8, 2);
    std::fill(flat.heights.values.begin(), flat.heights.values.end(), 0.5f);
    CHECK_THROWS_AS(transferRelief({flat}, target, nullptr, {}), Error);
    CHECK_THROWS_AS(transferRelief({}, target, nullptr, {}), Error);
    const LevelSet plain = ball(12);
    ReliefOptions fine;
    fine.baseRadius = 2;
    CHECK_THROWS_AS(transferRelief({{&plain, {}, 0, 0}}, target, nullptr, fine), Error);  // no relief
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { transferRelief(picture, target, nullptr, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
