#include "libvdbsynth/map/source_gather.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

const IndexBox kBox{{-3, 4, 10}, {12, 19, 25}};  // of the map

// Every voxel of the map copies what `from` says.
ElementSources sourcesBy(const std::function<Source(const Index3&)>& from) {
    ElementSources sources;
    for (int x = kBox.min.x; x <= kBox.max.x; ++x)
        for (int y = kBox.min.y; y <= kBox.max.y; ++y)
            for (int z = kBox.min.z; z <= kBox.max.z; ++z) sources.add({x, y, z}, from({x, y, z}));
    return sources;
}

Vec3d vec(const Index3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

std::shared_ptr<const BrickField> shared(BrickField field) {
    return std::make_shared<const BrickField>(std::move(field));
}

}  // namespace

TEST_CASE("gatherThroughSources: sources that continue each other copy the exemplar", "[map][oracle]") {
    // The exemplar's field begins at (100, 0, -8) of its index space.
    const auto field = shared(test::noiseField({24, 24, 24}, 3));
    const Index3 shift{104, 1, -15};
    const ElementSources sources = sourcesBy([&](const Index3& p) {
        Source source;
        source.position = vec(p + shift);
        return source;
    });
    const BrickField otherwise(IndexBox::fromSize(kBox.size()), 9.f);
    const BrickField made =
        gatherThroughSources(sources, kBox, 1, {{field, {100, 0, -8}, 1}}, otherwise, 1e6f);
    // Voxels of the field: p + shift - corner, for p from the box's corner on.
    const Index3 first = kBox.min + shift - Index3{100, 0, -8};
    for (const Index3& p : {Index3{0, 0, 0}, Index3{5, 6, 7}, Index3{15, 15, 15}})
        CHECK(made.at(p) == Approx(field->at(first + p)).margin(1e-6));
}

TEST_CASE("gatherThroughSources: rotated and scaled sources are read so", "[map][oracle]") {
    const auto slope =
        shared(test::fieldFrom({32, 32, 32}, [](const Index3& p) { return float(p.x) + 100 * float(p.y); }));
    // A quarter turn about z takes the exemplar's x to the result's y; features are twice as large.
    const ElementSources sources = sourcesBy([&](const Index3& p) {
        const Index3 in = p - kBox.min;
        Source source;
        source.position = {8 + in.y / 2.0, 16 - in.x / 2.0, 5};
        source.rotation = {0, 0, float(kPi / 2)};
        source.scale = 2;
        return source;
    });
    const BrickField otherwise(IndexBox::fromSize(kBox.size()), 0.f);
    const BrickField made = gatherThroughSources(sources, kBox, 1, {{slope, {0, 0, 0}, 1}}, otherwise, 1e6f);
    CHECK(made.at({4, 6, 3}) == Approx(8 + 3 + 100 * (16 - 2)).epsilon(1e-5));
    CHECK(made.at({7, 1, 9}) == Approx(8.5 + 100 * (16 - 3.5)).epsilon(1e-5));
}

TEST_CASE("gatherThroughSources: the mean counts every voxel around, those that continue each other too",
          "[map][oracle]") {
    const auto field = shared(test::fieldFrom({64, 64, 64}, [](const Index3& p) {
        return float(std::sin(0.3 * p.x) + std::cos(0.25 * p.y) + std::sin(0.2 * p.z));
    }));
    // Patches of 3^3 voxels, each rigidly from a place and rotation of its own.
    const auto sourceOf = [](const Index3& p) {
        const Index3 in = p - kBox.min, patch{in.x / 3, in.y / 3, in.z / 3};
        Random random(8, std::uint64_t((patch.x * 64 + patch.y) * 64 + patch.z));
        Source source;
        source.rotation = {float(random.uniform(-2, 2)), float(random.uniform(-2, 2)), 0.3f};
        source.position = Vec3d{random.uniform(20, 40), random.uniform(20, 40), random.uniform(20, 40)} +
                          transformed(rotationMatrix(-cast<double>(source.rotation)), vec(in - patch * 3));
        return source;
    };
    const BrickField otherwise(IndexBox::fromSize(kBox.size()), 0.f);
    const BrickField made =
        gatherThroughSources(sourcesBy(sourceOf), kBox, 1, {{field, {0, 0, 0}, 1}}, otherwise, 6.f);
    forEachVoxel(IndexBox::fromSize(kBox.size()), [&](const Index3& local) {
        double sum = 0, weights = 0;
        const Index3 voxel = kBox.min + local;
        forEachVoxel(IndexBox{voxel, voxel}.expanded(1).intersection(kBox), [&](const Index3& p) {
            const Source source = sourceOf(p);
            const Vec3d offset = vec(voxel - p);
            const double weight = 1 / ((1 + dot(offset, offset)) * (1 + dot(offset, offset)));
            sum += weight *
                   double(sampleCubic(
                       *field,
                       cast<float>(source.position +
                                   transformed(rotationMatrix(-cast<double>(source.rotation)), offset))));
            weights += weight;
        });
        REQUIRE(double(made.inside(local)) == Approx(sum / weights).margin(1e-3));
    });
}

TEST_CASE("gatherThroughSources: a finer exemplar is read at the same places", "[map][property]") {
    for (int factor : {2, 3}) {
        INFO(factor);
        const auto fine =
            shared(test::fieldFrom({24 * factor, 24 * factor, 24 * factor}, [&](const Index3& p) {
                return float(p.x) / float(factor) + 100 * float(p.z) / float(factor);
            }));
        const ElementSources sources = sourcesBy([&](const Index3& p) {
            Source source;
            source.position = vec(p - kBox.min);
            return source;
        });
        const IndexBox finer = finerBox(kBox, factor);
        const BrickField otherwise(IndexBox::fromSize(finer.size()), 0.f);
        const BrickField made =
            gatherThroughSources(sources, kBox, factor, {{fine, {0, 0, 0}, double(factor)}}, otherwise, 1e6f);
        // A voxel's place in the map is its index over the factor.
        for (const Index3& p : {Index3{8, 8, 8}, Index3{13, 9, 22}}) {
            const Index3 index = p + finer.min;
            const double x = double(index.x) / factor - kBox.min.x, z = double(index.z) / factor - kBox.min.z;
            CHECK(made.at(p) == Approx(x + 100 * z).epsilon(1e-5));
        }
    }
}

TEST_CASE("gatherThroughSources: finer voxels do not jump where the map's voxels meet", "[map][property]") {
    constexpr int kFactor = 4;
    const auto field = shared(test::fieldFrom({96, 96, 96}, [](const Index3& p) {
        return std::sin(float(p.x) / 13) + std::cos(float(p.y + p.z) / 11);
    }));
    // Sources that do not continue each other: every voxel is some voxels off its place.
    const ElementSources sources = sourcesBy([&](const Index3& p) {
        Random random(8, std::uint64_t((p.x * 64 + p.y) * 64 + p.z + 100000));
        Source source;
        source.position = vec(p - kBox.min) + Vec3d{random.uniform(2, 7), random.uniform(2, 7), 4};
        return source;
    });
    const IndexBox finer = IndexBox::fromSize(kBox.size() * kFactor);
    const BrickField made = gatherThroughSources(sources, kBox, kFactor, {{field, {0, 0, 0}, kFactor}},
                                                 BrickField(finer, 0.f), 1e6f);
    double across = 0, within = 0;
    int crossings = 0, steps = 0;
    for (int x = 8; x < 48; ++x)
        for (int y = 8; y < 48; y += 3) {
            const double step = std::abs(double(made.at({x + 1, y, 20}) - made.at({x, y, 20})));
            const bool crosses = (x + 1) % kFactor == 0;
            (crosses ? across : within) += step;
            ++(crosses ? crossings : steps);
        }
    CHECK(across / crossings < 1.5 * within / steps);
}

TEST_CASE("gatherThroughSources: where there is no source it is otherwise, beyond the limit it is clamped",
          "[map]") {
    const auto field = shared(BrickField(IndexBox::fromSize({8, 8, 8}), 5.f));
    ElementSources one;
    one.add({0, 5, 11}, Source{});
    const BrickField otherwise(IndexBox::fromSize(kBox.size()), -1.f);
    const BrickField made = gatherThroughSources(one, kBox, 1, {{field, {0, 0, 0}, 1}}, otherwise, 2.f);
    CHECK(made.at({3, 1, 1}) == 2.f);
    CHECK(made.at({3, 1, 2}) == -1.f);
    CHECK(test::thrownBy([&] { gatherThroughSources(one, kBox, 1, {}, otherwise, 2.f); }).code ==
          int(ErrorCode::ShapeMismatch));
    ElementSources outside;
    outside.add({100, 0, 0}, Source{});
    CHECK(test::thrownBy([&] {
              gatherThroughSources(outside, kBox, 1, {{field, {0, 0, 0}, 1}}, otherwise, 2.f);
          }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("gatherThroughSources: the same bits for any threads, and stops when asked to",
          "[map][determinism][cancel]") {
    const auto field = shared(test::noiseField({24, 24, 24}, 3));
    const ElementSources sources = sourcesBy([&](const Index3& p) {
        Source source;
        Random random(4, std::uint64_t((p.x * 64 + p.y) * 64 + p.z + 100000));
        source.position = {random.uniform(2, 20), random.uniform(2, 20), random.uniform(2, 20)};
        source.rotation = {float(random.uniform(-3, 3)), float(random.uniform(-3, 3)), 0};
        return source;
    });
    const BrickField otherwise(IndexBox::fromSize(kBox.size()), 0.f);
    const auto run = [&](const RunContext& ctx) {
        return test::samplesOf(
            gatherThroughSources(sources, kBox, 1, {{field, {0, 0, 0}, 1}}, otherwise, 6.f, ctx));
    };
    RunContext one, three, stopped;
    one.threads = 1;
    three.threads = 3;
    CHECK(run(one) == run(three));
    const std::atomic<bool> stop{true};
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { run(stopped); }).code == int(ErrorCode::Cancelled));
}
