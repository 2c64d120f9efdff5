#include "libvdbsynth/analogy/filter_analogy.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

// Balls of random places and sizes: densities that go from 1 to 0 over two voxels.
BrickField balls(std::uint64_t seed, int side) {
    std::vector<std::array<double, 4>> made;
    for (std::uint64_t b = 0; b < 24; ++b) {
        Random random(seed, b);
        std::array<double, 4> ball;
        for (int axis = 0; axis < 3; ++axis) ball[std::size_t(axis)] = random.uniform(10, side - 10);
        ball[3] = random.uniform(2, 6);
        made.push_back(ball);
    }
    return test::fieldFrom({side, side, side}, [&](const Index3& p) {
        double distance = 1e9;
        for (const auto& b : made)
            distance = std::min(distance, std::hypot(p.x - b[0], p.y - b[1], p.z - b[2]) - b[3]);
        return float(std::clamp(0.5 - distance / 2, 0.0, 1.0));
    });
}

template <typename Of>
BrickField eachNeighbourhood(const BrickField& field, int half, const Of& of) {
    const int side = 2 * half + 1;
    return test::fieldFrom(field.box().size(), [&](const Index3& p) {
        std::vector<float> samples(std::size_t(side * side * side));
        field.readBox(p - Index3{half, half, half}, {side, side, side}, samples.data());
        return of(samples, side);
    });
}

BrickField blurred(const BrickField& field, double sigma, int half) {
    return eachNeighbourhood(field, half, [&](const std::vector<float>& samples, int side) {
        double sum = 0, weights = 0;
        for (int k = 0; k < side * side * side; ++k) {
            const int x = k / side / side - half, y = k / side % side - half, z = k % side - half;
            const double weight = std::exp(-(x * x + y * y + z * z) / (2 * sigma * sigma));
            sum += weight * double(samples[std::size_t(k)]);
            weights += weight;
        }
        return float(sum / weights);
    });
}

// RMS(made - wanted) / RMS(wanted - before)
double missed(const BrickField& made, const BrickField& wanted, const BrickField& before) {
    double error = 0, change = 0;
    const Index3 size = before.box().size();
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < size.z; ++z) {
                error += std::pow(double(made.inside({x, y, z}) - wanted.inside({x, y, z})), 2);
                change += std::pow(double(wanted.inside({x, y, z}) - before.inside({x, y, z})), 2);
            }
    return std::sqrt(error / change);
}

bool same(const BrickField& a, const BrickField& b) {
    return missed(a, b, BrickField(b.box(), 1e6f)) == 0;
}

}  // namespace

TEST_CASE("makeFilterAnalogy: learns a blur from one set of balls and does it to another",
          "[analogy][property]") {
    const BrickField before = balls(1, 48), target = balls(2, 40);
    for (double sigma : {0.8, 1.5, 2.5}) {
        const int half = int(std::ceil(3 * sigma));
        const BrickField after = blurred(before, sigma, half);
        const FilterAnalogyResult made = makeFilterAnalogy({{&before, &after}}, target, {});
        CAPTURE(sigma, made.stats.affineError / made.stats.change);
        CHECK(missed(made.after, blurred(target, sigma, half), target) < 0.05);
        CHECK(made.stats.affineError < 0.05 * made.stats.change);
    }
}

TEST_CASE("makeFilterAnalogy: a filter within reach that is affine is found whole", "[analogy]") {
    const BrickField before = balls(3, 40), target = balls(4, 32);
    const auto of = [](const std::vector<float>& v, int) { return 0.25f + 2 * v[4] - 0.5f * v[22]; };
    const BrickField after = eachNeighbourhood(before, 1, of), wanted = eachNeighbourhood(target, 1, of);
    const FilterAnalogyResult made = makeFilterAnalogy({{&before, &after}}, target, {});
    CHECK(missed(made.after, wanted, target) < 1e-3);
}

TEST_CASE("makeFilterAnalogy: the search learns what is not linear", "[analogy]") {
    const BrickField before = balls(5, 56), target = balls(6, 32);
    // A dilation: the largest value around.
    const auto of = [](const std::vector<float>& v, int) { return *std::max_element(v.begin(), v.end()); };
    const BrickField after = eachNeighbourhood(before, 1, of), wanted = eachNeighbourhood(target, 1, of);
    const FilterAnalogyResult made = makeFilterAnalogy({{&before, &after}}, target, {});
    CHECK(made.stats.searched);
    CHECK(made.stats.searchError < made.stats.affineError);
    const double error = missed(made.after, wanted, target);
    CAPTURE(error, made.stats.affineError / made.stats.change, made.stats.searchError / made.stats.change);
    CHECK(error < 0.6 * made.stats.affineError / made.stats.change);
}

TEST_CASE("makeFilterAnalogy: same bits for any number of threads", "[analogy][determinism]") {
    const BrickField before = balls(5, 48), target = balls(6, 32);
    const auto of = [](const std::vector<float>& v, int) { return *std::max_element(v.begin(), v.end()); };
    const BrickField after = eachNeighbourhood(before, 1, of);
    RunContext one, three;
    one.threads = 1;
    three.threads = 3;
    CHECK(same(makeFilterAnalogy({{&before, &after}}, target, {}, one).after,
               makeFilterAnalogy({{&before, &after}}, target, {}, three).after));
}

TEST_CASE("makeFilterAnalogy: what it refuses", "[analogy][error]") {
    const BrickField before = balls(1, 24), constant(IndexBox::fromSize({40, 40, 40}), 1);
    const auto code = [&](const BrickField& learnt, int half, int levels, int components) {
        FilterAnalogyOptions options;
        options.half = half;
        options.levels = levels;
        options.components = components;
        return test::thrownBy([&] { makeFilterAnalogy({{&learnt, &learnt}}, before, options); }).code;
    };
    CHECK(code(constant, 2, 3, 16) == int(ErrorCode::Unusable));
    CHECK(code(before, 5, 3, 16) == int(ErrorCode::InvalidOption));
    CHECK(code(before, 2, 5, 16) == int(ErrorCode::InvalidOption));
    CHECK(code(before, 2, 3, 3) == int(ErrorCode::InvalidOption));
}

TEST_CASE("makeFilterAnalogy: a constant target stays one, and it can be stopped", "[analogy]") {
    const BrickField before = balls(1, 40), after = blurred(before, 1, 2);
    const BrickField constant(IndexBox::fromSize({20, 20, 20}), 1);
    const FilterAnalogyResult made = makeFilterAnalogy({{&before, &after}}, constant, {});
    CHECK(made.after.at({0, 0, 0}) == Approx(1).margin(0.02));
    CHECK(made.after.at({0, 0, 0}) == made.after.at({19, 19, 19}));
    RunContext ctx;
    std::atomic<bool> stop{true};
    ctx.cancel = &stop;
    CHECK(test::thrownBy([&] {
              makeFilterAnalogy({{&before, &after}}, before, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}
