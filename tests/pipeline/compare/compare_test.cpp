#include "libvdbsynth/pipeline/compare/compare.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/pipeline/crop/crop.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <atomic>
#include <cmath>

using namespace vdbsynth;

namespace {

LevelSet made(const char* kind, int resolution, std::uint64_t seed = 0, double voxel = 1) {
    openvdb::initialize();
    MakeOptions options;
    options.exemplar.kind = kind;
    options.exemplar.resolution = resolution;
    options.voxelSize = voxel;
    RunContext ctx;
    ctx.seed = seed;
    return makeModel(options, ctx);
}

// An object (no recorded domain) of exact distances.
LevelSet object(const Index3& size, double voxel, const std::function<double(const Vec3d&)>& distance) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(float(3 * voxel));
    auto accessor = grid->getAccessor();
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < size.z; ++z) {
                const double d = distance({double(x), double(y), double(z)});
                if (std::abs(d) < 3)
                    accessor.setValueOn({x, y, z}, float(d * voxel));
                else if (d < 0)
                    accessor.setValueOff({x, y, z}, float(-3 * voxel));
            }
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    LevelSet model;
    model.grid = grid;
    model.domain = solidBox(*grid, "object");
    stampLevelSet(model);
    return model;
}

LevelSet ball(double radius, double voxel = 1) {
    return object({64, 64, 64}, voxel, [=](const Vec3d& p) {
        return length(p - Vec3d{31.3, 32.1, 31.7}) - radius;
    });
}

double valueOf(const ModelStatistics& model, const std::string& name) {
    for (const Statistic& statistic : model.statistics)
        if (statistic.name == name) return statistic.values.front();
    FAIL(name);
    return 0;
}

Comparison compared(const LevelSet& reference, const LevelSet& other, const CompareOptions& options = {},
                    const RunContext& ctx = {}) {
    return compareModels({"reference", reference, {}}, {{"other", other, {}}}, options, ctx);
}

}  // namespace

TEST_CASE("compareModels: a ball and a torus have their closed forms", "[pipeline][oracle]") {
    const double radius = 20.3, wide = 18.2, thin = 7.4;
    const LevelSet torus = object({64, 64, 40}, 1, [=](const Vec3d& p) {
        const double ring = std::hypot(p.x - 31.6, p.y - 32.3) - wide;
        return std::hypot(ring, p.z - 19.8) - thin;
    });
    const Comparison c = compared(ball(radius), torus);
    const auto total = [](const ModelStatistics& m, const char* name) {
        return valueOf(m, name) * double(m.domain.volume());
    };
    CHECK(total(c.reference, "volume fraction") ==
          Approx(4.0 / 3 * kPi * radius * radius * radius).epsilon(0.005));
    CHECK(total(c.reference, "surface area per volume") == Approx(4 * kPi * radius * radius).epsilon(0.005));
    CHECK(total(c.reference, "mean curvature per volume") == Approx(4 * kPi * radius).epsilon(0.01));
    CHECK(c.reference.topology.eulerCharacteristic == 1);
    CHECK(c.reference.topology.tunnels == 0);
    CHECK(valueOf(c.reference, "local thickness mean") == Approx(2 * radius).margin(1));
    CHECK(c.reference.gradient.mean < 0.01);
    CHECK(c.reference.bandCompleteness == 1);
    const ModelStatistics& t = c.others.front();
    CHECK(total(t, "volume fraction") == Approx(2 * kPi * kPi * wide * thin * thin).epsilon(0.005));
    CHECK(total(t, "surface area per volume") == Approx(4 * kPi * kPi * wide * thin).epsilon(0.005));
    CHECK(total(t, "mean curvature per volume") == Approx(2 * kPi * kPi * wide).epsilon(0.01));
    CHECK(t.topology.eulerCharacteristic == 0);
    CHECK(t.topology.tunnels == 1);
    CHECK(valueOf(t, "local thickness mean") == Approx(2 * thin).margin(1));
    CHECK(c.parts == 0);
    CHECK(c.distances.front().verdicts.empty());
}

TEST_CASE("compareModels: a thresholded random field of known covariance", "[pipeline][oracle]") {
    // Covariance exp(-r^2 / (2 l^2)) from 200 random waves; thresholded at 0.
    openvdb::initialize();
    const double l = 5;
    const int n = 72, margin = 6;
    std::vector<std::array<double, 4>> waves;
    for (std::uint64_t w = 0; w < 200; ++w) {
        Random random(3, w);
        waves.push_back(
            {random.normal() / l, random.normal() / l, random.normal() / l, random.uniform(0, 2 * kPi)});
    }
    const IndexBox box = IndexBox::fromSize({n, n, n}).expanded(margin);
    const BrickField field = BrickField::generate(box, {}, [&](const IndexBox& brick, float* samples) {
        for (int x = brick.min.x; x <= brick.max.x; ++x)
            for (int y = brick.min.y; y <= brick.max.y; ++y)
                for (int z = brick.min.z; z <= brick.max.z; ++z) {
                    double sum = 0;
                    for (const auto& w : waves) sum += cosine(w[0] * x + w[1] * y + w[2] * z + w[3]);
                    // In voxels, more or less: only the zero level is meant.
                    *samples++ = float(std::clamp(sum * std::sqrt(2.0 / 200) * l, -4.0, 4.0));
                }
    });
    const LevelSet model = modelFromField(field, 4, false, 0, IndexBox::fromSize({n, n, n}), 1, "field", "");
    const Comparison c = compared(model, model);
    CHECK(valueOf(c.reference, "volume fraction") == Approx(0.5).margin(0.04));
    // Rice: a line crosses the level 1 / (pi l) times a voxel; the area is twice that.
    CHECK(valueOf(c.reference, "surface area per volume") == Approx(2 / (kPi * l)).epsilon(0.05));
    for (const Statistic& statistic : c.reference.statistics)
        if (statistic.name == "two-point correlation")
            for (int r = 1; r <= 12; ++r) {
                const double rho = std::exp(-r * r / (2 * l * l));
                INFO("r = " << r);
                CHECK(statistic.values[std::size_t(r)] ==
                      Approx(0.25 + std::asin(rho) / (2 * kPi)).margin(0.04));
            }
    CHECK(c.stationary == std::array<bool, 3>{true, true, true});
}

TEST_CASE("compareModels: a model and itself are nowhere apart and pass", "[pipeline][property]") {
    const LevelSet grid = made("grid", 64);
    const Comparison c = compared(grid, grid);
    const ModelDistances& d = c.distances.front();
    REQUIRE(d.scales.size() == 3);
    for (const ModelDistances::Scale& scale : d.scales) {
        CHECK(scale.wasserstein == 0);
        CHECK(scale.coherence == 0);
        CHECK(scale.completeness == 0);
    }
    CHECK(d.localPatches.shareIoU == 1);
    REQUIRE(d.surface);
    CHECK(d.surface->hausdorff == Approx(0).margin(1e-5));
    CHECK(d.sourceKind == SourceKind::Matching);
    CHECK(d.novelty.verbatimShare == 1);
    CHECK(d.novelty.largestRun == double(d.novelty.voxels));
    CHECK(c.parts == 8);
    for (const Verdict& verdict : d.verdicts) {
        INFO(verdict.name);
        CHECK(verdict.passes());
    }
}

TEST_CASE("compareModels: a terrain is stationary along x and y, an object along none",
          "[pipeline][property]") {
    CHECK(compared(made("terrain", 64), made("terrain", 64, 1)).stationary ==
          std::array<bool, 3>{true, true, false});
    CHECK(compared(ball(12), ball(12)).stationary == std::array<bool, 3>{false, false, false});
}

TEST_CASE("compareModels: two versions of one object, in voxels of the reference", "[pipeline][oracle]") {
    const Comparison c = compared(ball(20, 0.5), ball(21, 0.5));
    REQUIRE(c.distances.front().surface);
    CHECK(c.distances.front().surface->mean == Approx(1).margin(0.02));
    CHECK(c.distances.front().surface->hausdorff == Approx(1).margin(0.1));
    // The same ball in voxels of another size lies in the same place of the world.
    const LevelSet coarse = object({32, 32, 32}, 1, [](const Vec3d& p) {
        return length(p * 2.0 - Vec3d{31.3, 32.1, 31.7}) / 2 - 10;
    });
    const Comparison other = compared(ball(20, 0.5), coarse);
    REQUIRE(other.distances.front().surface);
    CHECK(other.distances.front().surface->mean < 0.1);
    // Two textures in one place are not.
    CHECK_FALSE(compared(made("balls", 48), made("balls", 48, 5)).distances.front().surface);
}

TEST_CASE("compareModels: islands are counted against the reference's smallest parts", "[pipeline][oracle]") {
    const LevelSet two = object({64, 64, 64}, 1, [](const Vec3d& p) {
        return std::min(length(p - Vec3d{20, 20, 20}) - 12.5, length(p - Vec3d{45, 45, 45}) - 2.2);
    });
    const Comparison c = compared(ball(12), two);
    CHECK(c.others.front().islands == 1);
    CHECK(c.reference.islands == 0);
    CHECK(c.others.front().topology.solid.sizes.size() == 2);
}

TEST_CASE("compareModels: a source map that holds is used, one that does not is not",
          "[pipeline][property]") {
    const LevelSet exemplar = made("balls", 48);
    const LevelSet result = cropModel(exemplar, {{4, 4, 4}, {43, 43, 43}});
    auto source = openvdb::Vec3IGrid::create(openvdb::Vec3i(0));
    source->setName("source");
    source->setTransform(exemplar.grid->transform().copy());
    for (auto it = result.grid->cbeginValueOn(); it; ++it)
        source->tree().setValueOn(it.getCoord(),
                                  openvdb::Vec3i(it.getCoord().x(), it.getCoord().y(), it.getCoord().z()));
    CompareInput input{"result", result, {}};
    REQUIRE(takeSourceMap({source}, input));
    const ModelDistances good = compareModels({"reference", exemplar, {}}, {input}).distances.front();
    CHECK(good.sourceKind == SourceKind::Map);
    CHECK(good.verified > 0.95);
    CHECK(good.novelty.verbatimShare > 0.99);
    CHECK(good.novelty.seamShare == 0);
    CHECK(good.novelty.exemplarUsed < 0.7);

    for (auto it = source->beginValueOn(); it; ++it) it.setValue(*it + openvdb::Vec3i(3, 0, 0));
    REQUIRE(takeSourceMap({source}, input));
    const ModelDistances bad = compareModels({"reference", exemplar, {}}, {input}).distances.front();
    CHECK(bad.sourceKind == SourceKind::Matching);
    CHECK(bad.verified < 0.9);
    CHECK(bad.verified > 0);
    CHECK(bad.novelty.verbatimShare > 0.8);

    source->setTransform(openvdb::math::Transform::createLinearTransform(2));
    CHECK_FALSE(takeSourceMap({source}, input));
    CHECK_FALSE(takeSourceMap({}, input));
}

TEST_CASE("compareModels: the yardstick is 0 for the exemplar itself and about 1 for fresh ones",
          "[pipeline][property]") {
    CompareOptions options;
    options.process = ExemplarOptions{};
    options.process->kind = "balls";
    options.fresh = 4;
    const LevelSet reference = made("balls", 48);
    const Comparison c =
        compareModels({"reference", reference, {}},
                      {{"a", made("balls", 48, 11), {}}, {"b", made("balls", 48, 12), {}}}, options);
    REQUIRE(c.yardsticks.size() == c.reference.statistics.size() + 3);
    double mean = 0;
    for (const Yardstick& y : c.yardsticks) mean += y.ratio() / double(c.yardsticks.size());
    CHECK(mean > 0.4);
    CHECK(mean < 1.6);
    for (const Yardstick& y : compared(reference, reference, options).yardsticks) CHECK(y.ratio() == 0);
    // Another process is further away than a fresh sample of this one.
    double other = 0;
    for (const Yardstick& y : compared(reference, made("sponge", 48), options).yardsticks)
        other += y.ratio() / double(c.yardsticks.size());
    CHECK(other > 3);
}

TEST_CASE("compareModels: errors, cancel, threads", "[pipeline][error]") {
    CompareOptions options;
    options.process = ExemplarOptions{};
    options.process->kind = "balls";
    const auto noDomain = test::thrownBy([&] { compared(ball(12), ball(12), options); });
    CHECK(noDomain.code == int(ErrorCode::Unusable));
    CHECK(test::contains(noDomain.message, "`process`"));
    options.fresh = 1;
    CHECK(test::thrownBy([&] { compared(ball(12), ball(12), options); }).code ==
          int(ErrorCode::InvalidOption));
    RunContext small;
    small.maxMemory = 1000;
    CHECK(test::thrownBy([&] { compared(ball(12), ball(12), {}, small); }).code == int(ErrorCode::Memory));
    std::atomic<bool> stop{true};
    RunContext cancelled;
    cancelled.cancel = &stop;
    CHECK(test::thrownBy([&] { compared(ball(12), ball(12), {}, cancelled); }).code ==
          int(ErrorCode::Cancelled));

    RunContext one;
    one.threads = 1;
    const LevelSet a = made("sponge", 40), b = made("sponge", 40, 2);
    const Comparison first = compared(a, b, {}, one), second = compared(a, b);
    for (std::size_t s = 0; s < first.others[0].statistics.size(); ++s)
        CHECK(first.others[0].statistics[s].values == second.others[0].statistics[s].values);
    for (std::size_t s = 0; s < first.distances[0].scales.size(); ++s) {
        CHECK(first.distances[0].scales[s].wasserstein == second.distances[0].scales[s].wasserstein);
        CHECK(first.distances[0].scales[s].coherence == second.distances[0].scales[s].coherence);
    }
    CHECK(first.distances[0].novelty.seamRatio == second.distances[0].novelty.seamRatio);
}

TEST_CASE("compareModels: domains of one, two and eight voxels give numbers", "[pipeline][degenerate]") {
    const LevelSet balls = made("balls", 48);
    int measured = 0;
    for (const IndexBox& box : {IndexBox{{10, 10, 10}, {11, 11, 11}}, IndexBox{{10, 10, 10}, {40, 40, 10}},
                                IndexBox{{10, 10, 10}, {17, 17, 17}}, IndexBox{{10, 10, 10}, {10, 10, 40}}}) {
        LevelSet part;
        try {
            part = cropModel(balls, box);
        } catch (const Error&) {
            continue;  // no surface there
        }
        INFO(boxText(box));
        ++measured;
        const Comparison c = compared(part, part);
        for (const Statistic& statistic : c.reference.statistics)
            for (double value : statistic.values) CHECK(std::isfinite(value));
        CHECK(std::isfinite(c.reference.topology.eulerCharacteristic));
        const Comparison other = compared(balls, part);
        for (const ModelDistances::Scale& scale : other.distances.front().scales) {
            CHECK(std::isfinite(scale.wasserstein));
            CHECK(std::isfinite(scale.coherence));
        }
    }
    CHECK(measured >= 2);
}

TEST_CASE("compareModels: an object beside a texture, both ways, with axes given", "[pipeline][degenerate]") {
    CompareOptions options;
    options.stationary = std::array<bool, 3>{true, true, true};
    for (const Comparison& c :
         {compared(ball(20), made("balls", 40), options), compared(made("balls", 40), ball(20), options)}) {
        REQUIRE(c.reference.statistics.size() == c.others.front().statistics.size());
        for (std::size_t i = 0; i < c.reference.statistics.size(); ++i)
            CHECK(c.reference.statistics[i].name == c.others.front().statistics[i].name);
    }
    CHECK(compared(ball(12), ball(12)).distances.front().localPatches.shareIoU == 1);
}

TEST_CASE("compareModels: caps of two textures in one place are no distance between them",
          "[pipeline][property]") {
    // Rods along x, cut by domains that begin and end three voxels apart.
    openvdb::initialize();
    const auto rods = [](int from) {
        const IndexBox domain{{from, 0, 0}, {from + 47, 39, 39}};
        const BrickField field =
            BrickField::generate(domain.expanded(6), {}, [](const IndexBox& brick, float* samples) {
                for (int x = brick.min.x; x <= brick.max.x; ++x)
                    for (int y = brick.min.y; y <= brick.max.y; ++y)
                        for (int z = brick.min.z; z <= brick.max.z; ++z) {
                            const double cy = y - (std::floor(y / 20.0) * 20 + 9.5),
                                         cz = z - (std::floor(z / 20.0) * 20 + 9.5);
                            *samples++ = float(std::clamp(std::hypot(cy, cz) - 6, -4.0, 4.0));
                        }
            });
        return modelFromField(field, 4, false, 0, domain, 1, "rods", "");
    };
    const Comparison c = compared(rods(0), rods(3));
    const ModelDistances& d = c.distances.front();
    REQUIRE(d.surface.has_value());
    CHECK(d.surface->hausdorff < 0.05);
    CHECK(d.localPatches.shareIoU == 1);
    CHECK(d.novelty.exemplarUsed > 0.2);
    CHECK(d.novelty.exemplarUsed <= 1);
}

TEST_CASE("compareModels: an object has no pores, and no row, verdict or yardstick of them",
          "[pipeline][property]") {
    const auto pores = [](const ModelStatistics& m) {
        for (const Statistic& statistic : m.statistics)
            if (statistic.name == "pore size mean") return statistic.measured();
        return true;
    };
    CompareOptions options;
    options.stationary = std::array<bool, 3>{true, false, false};
    options.process = ExemplarOptions{};
    options.process->kind = "balls";
    options.fresh = 2;
    const LevelSet texture = made("balls", 32);
    const Comparison c = compared(texture, ball(14), options);
    CHECK(pores(c.reference));
    CHECK_FALSE(pores(c.others.front()));
    for (const Verdict& verdict : c.distances.front().verdicts)
        CHECK(verdict.name.find("pore") == std::string::npos);
    for (const Yardstick& row : c.yardsticks) CHECK(row.name.find("pore") == std::string::npos);
    CHECK(c.yardsticks.size() > 10);
    options.stationary.reset();
    const Comparison textures = compared(texture, made("balls", 32, 5), options);
    CHECK(textures.yardsticks.size() == c.yardsticks.size() + 3);
}

TEST_CASE("compareModels: relief is measured over a base of one radius", "[pipeline]") {
    CompareOptions options;
    options.reliefRadius = 3;
    const Comparison c = compared(made("foam", 48), made("foam", 48), options);
    REQUIRE(c.reference.relief.has_value());
    REQUIRE(c.others.front().relief.has_value());
    CHECK(c.reference.relief->sq > 0.01);
    CHECK(c.reference.relief->sq == c.others.front().relief->sq);
    CHECK_FALSE(compared(ball(10), ball(10)).reference.relief.has_value());
    options.reliefRadius = 0;
    CHECK_THROWS_AS(compared(ball(10), ball(10), options), Error);
}
