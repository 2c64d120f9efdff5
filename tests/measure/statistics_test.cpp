#include "libvdbsynth/measure/statistics.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/shapes.h"

#include <atomic>

using namespace vdbsynth;

namespace {

MeasuredModel preparedModel(const std::shared_ptr<const BrickField>& field, Beyond beyond, int edge = 0,
                            const RunContext& ctx = {}) {
    MeasuredModel model;
    model.field = field;
    model.counted = field->box().expanded(-edge);
    model.beyond = beyond;
    model.surface = zeroLevel(*field, field->box(), Facing::Outward, ctx);
    prepare(model, 1, ctx);
    return model;
}

std::shared_ptr<const BrickField> field(const Index3& size,
                                        const std::function<double(const Vec3d&)>& distance) {
    return std::make_shared<const BrickField>(test::fieldFrom(size, [&](const Index3& p) {
        return float(std::clamp(distance({double(p.x), double(p.y), double(p.z)}), -3.0, 3.0));
    }));
}

std::shared_ptr<const BrickField> slabs() {
    return field({60, 48, 50}, [](const Vec3d& p) { return std::abs(std::fmod(p.x, 12) - 5.75) - 3; });
}

const Statistic& named(const std::vector<Statistic>& all, const std::string& name) {
    for (const Statistic& statistic : all)
        if (statistic.name == name) return statistic;
    FAIL(name);
    return all.front();
}
double valueOf(const std::vector<Statistic>& all, const std::string& name, std::size_t i = 0) {
    return named(all, name).values.at(i);
}

}  // namespace

TEST_CASE("statisticDistance: differences of numbers, root of the mean square of curves",
          "[measure][oracle]") {
    const Statistic a{"c", 0, true, {0, 1, 2, 3}}, b{"c", 0, true, {0, 1, 2, 5}};
    CHECK(statisticDistance(a, b) == Approx(1));
    CHECK(statisticDistance({"c", 0, true, {1, 2}}, {"c", 0, true, {1, 5, 100}}) == Approx(std::sqrt(4.5)));
    CHECK(statisticDistance({"n", 0, false, {2}}, {"n", 0, false, {-1.5}}) == 3.5);
    CHECK(statisticDistance({"n", 0, false, {}}, {"n", 0, false, {4}}) == 0);
}

TEST_CASE("measureStatistics: a lattice of slabs, by hand", "[measure][oracle]") {
    MeasuredModel model;
    model.field = slabs();
    model.counted = model.field->box();
    prepare(model, 1);
    const std::vector<Statistic> all = measureStatistics(model, model.counted, 20);
    CHECK(valueOf(all, "volume fraction") == Approx(0.5));
    CHECK(valueOf(all, "local thickness mean") == Approx(6).margin(0.5));
    CHECK(valueOf(all, "local thickness deviation") < 0.4);
    CHECK(valueOf(all, "pore size mean") == Approx(6).margin(0.7));
    CHECK(valueOf(all, "mean chord", 0) == Approx(6).epsilon(0.03));
    CHECK(valueOf(all, "Euler characteristic per volume") == Approx(0).margin(1e-12));
    CHECK(valueOf(all, "two-point correlation by axis", 6) < 0.1);
    CHECK(valueOf(all, "two-point correlation by axis", 12) == Approx(0.5).margin(0.02));
    CHECK(measureGradient(model).mean == Approx(0).margin(1e-5));
    const Topology topology = measureTopology(model);
    CHECK(topology.solid.sizes.size() == 5);
    CHECK(topology.empty.sizes.size() == 6);
    CHECK(topology.tunnels == 0);
    const std::shared_ptr<const BrickField> flat = model.field;
    model.field = std::make_shared<const BrickField>(
        test::fieldFrom({60, 48, 50}, [&](const Index3& p) { return 1.2f * flat->at(p); }));
    CHECK(measureGradient(model).mean == Approx(0.2).margin(0.02));
}

TEST_CASE("measureStatistics: one order for any model, curves as long as the reach, no pores of an object",
          "[measure][property]") {
    const auto ball = field({32, 32, 32}, [](const Vec3d& p) {
        return length(p - Vec3d{15.5, 15.5, 15.5}) - 9;
    });
    const std::vector<Statistic> object = measureStatistics(
        preparedModel(ball, Beyond::Void, 2), IndexBox::fromSize({32, 32, 32}).expanded(-2), 10);
    const std::vector<Statistic> texture =
        measureStatistics(preparedModel(slabs(), Beyond::Unknown), {{3, 4, 5}, {30, 40, 20}}, 10);
    REQUIRE(object.size() == texture.size());
    for (std::size_t i = 0; i < object.size(); ++i) {
        INFO(object[i].name);
        CHECK(object[i].name == texture[i].name);
        CHECK(object[i].power == texture[i].power);
        CHECK(object[i].curve == texture[i].curve);
        CHECK(texture[i].measured());
        CHECK(object[i].measured() == !test::contains(object[i].name, "pore size"));
        if (object[i].measured()) CHECK(object[i].values.size() == texture[i].values.size());
        if (!object[i].curve) CHECK((texture[i].values.size() == 1 || texture[i].values.size() == 3));
        for (double value : texture[i].values) CHECK(std::isfinite(value));
    }
}

TEST_CASE("measureStatistics: of a whole object totals over the box's volume", "[measure][oracle]") {
    const double radius = 10;
    const auto shell = field({32, 32, 32}, [&](const Vec3d& p) {
        return std::max(length(p - Vec3d{15.5, 15.5, 15.5}) - radius,
                        5 - length(p - Vec3d{15.5, 15.5, 15.5}));
    });
    const MeasuredModel model = preparedModel(shell, Beyond::Void, 3);
    const double volume = double(model.counted.volume());
    REQUIRE(volume == 26 * 26 * 26);
    const std::vector<Statistic> all = measureStatistics(model, model.counted, 12);
    CHECK(valueOf(all, "volume fraction") * volume == Approx(4 * kPi / 3 * (1000 - 125)).epsilon(0.02));
    CHECK(valueOf(all, "surface area per volume") * volume == Approx(4 * kPi * (100 + 25)).epsilon(0.02));
    // Of a ball 4 pi r; the cavity turns the other way.
    CHECK(valueOf(all, "mean curvature per volume") * volume == Approx(4 * kPi * (10 - 5)).epsilon(0.05));
    CHECK(valueOf(all, "Euler characteristic per volume") * volume == Approx(2));
    const Topology topology = measureTopology(model);
    CHECK(topology.eulerCharacteristic == 2);
    CHECK(topology.enclosed == 1);
    CHECK(topology.solid.sizes.size() == 1);
    CHECK(topology.empty.sizes.size() == 2);
    CHECK(topology.tunnels == 0);
    const auto ring = field({40, 40, 20}, [](const Vec3d& p) {
        return std::hypot(std::hypot(p.x - 19.5, p.y - 19.5) - 11, p.z - 9.5) - 4;
    });
    CHECK(measureTopology(preparedModel(ring, Beyond::Void, 2)).tunnels == 1);
}

TEST_CASE("measureStatistics: a ball that no side of its volume cuts is whole", "[measure][oracle]") {
    constexpr double kRadius = 15, kPi = 3.14159265358979;
    const auto ball = field({64, 60, 56}, [](const Vec3d& p) {
        return length(p - Vec3d{30, 29, 28}) - kRadius;
    });
    const MeasuredModel model = preparedModel(ball, Beyond::Unknown);
    const std::vector<Statistic> all = measureStatistics(model, model.counted, 8);
    const double volume = 64.0 * 60 * 56;
    CHECK(valueOf(all, "surface area per volume") * volume ==
          Approx(4 * kPi * kRadius * kRadius).epsilon(0.01));
    CHECK(valueOf(all, "Euler characteristic per volume") * volume == Approx(1).epsilon(1e-9));
    const Topology topology = measureTopology(model);
    CHECK(topology.eulerCharacteristic == 1);
    CHECK(topology.tunnels == 0);
    // One that a side cuts is a part of what continues.
    const auto cut = field({64, 60, 56}, [](const Vec3d& p) {
        return length(p - Vec3d{8, 29, 28}) - kRadius;
    });
    CHECK(measureTopology(preparedModel(cut, Beyond::Unknown)).eulerCharacteristic != 1);
}

TEST_CASE("measureStatistics: means over any partition's parts, the thinnest too",
          "[measure][property][degenerate]") {
    const MeasuredModel model = preparedModel(slabs(), Beyond::Unknown);
    const auto fraction = [&](const IndexBox& box) {
        return valueOf(measureStatistics(model, box, 3), "volume fraction");
    };
    double sum = 0;
    for (int x = 0; x < 60; x += 4) sum += fraction({{x, 0, 0}, {x + 3, 47, 49}}) / 15;
    CHECK(sum == Approx(fraction(model.counted)));
    const auto smallest = measureStatistics(model, IndexBox::cube({8, 8, 8}, 4), 3);
    for (const Statistic& statistic : smallest)
        for (double value : statistic.values) CHECK(std::isfinite(value));
}

TEST_CASE("prepare, measureStatistics: the same bits for any threads, too little memory, cancelled",
          "[measure][determinism][error][cancel]") {
    const auto balls = std::make_shared<const BrickField>(test::ballsField({36, 40, 44}, 3, 3.f, 12));
    const auto values = [&](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        const MeasuredModel model = preparedModel(balls, Beyond::Unknown, 0, ctx);
        std::vector<double> all;
        for (const Statistic& statistic : measureStatistics(model, model.counted, 12, ctx))
            all.insert(all.end(), statistic.values.begin(), statistic.values.end());
        all.push_back(measureGradient(model, ctx).percentile99);
        all.push_back(measureTopology(model, ctx).eulerCharacteristic);
        return all;
    };
    CHECK(values(1) == values(4));
    MeasuredModel model;
    model.field = balls;
    model.counted = balls->box();
    RunContext small, stopped;
    small.maxMemory = 1000;
    CHECK(test::thrownBy([&] { prepare(model, 1, small); }).code == int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { prepare(model, 1, stopped); }).code == int(ErrorCode::Cancelled));
}
