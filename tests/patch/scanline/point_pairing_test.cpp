#include "libvdbsynth/patch/scanline/point_pairing.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/patch/scanline/thin_plate_warp.h"
#include "libvdbsynth/points/point_clusters.h"
#include "libvdbsynth/points/surface_variation.h"
#include "tests/support/makers.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace vdbsynth;

namespace {

void append(PairingPoints& points, const Vec3f& place, const Vec3f& normal = {0, 0, 1}, float variation = 0) {
    points.points.push_back(place);
    points.normals.push_back(normal);
    points.variation.push_back(variation);
}

PairingPoints randomPoints(std::size_t count, std::uint64_t seed) {
    PairingPoints points;
    for (std::size_t n = 0; n < count; ++n) {
        Random random(seed, n);
        const auto draw = [&](double low, double high) { return float(random.uniform(low, high)); };
        const Vec3f place{draw(0, 8), draw(0, 8), draw(0, 2)};
        append(points, place, normalized(Vec3f{draw(-0.7, 0.7), draw(-0.7, 0.7), 1}), draw(0, 0.2));
    }
    return points;
}

// The header's definition, with nothing left out.
class ByDefinition {
public:
    ByDefinition(const PairingPoints& sources, const PairingPoints& targets, double spacing,
                 const PairingOptions& options)
        : mS(sources), mQ(targets), mSpacing(spacing), mOptions(options) {}

    std::vector<std::int32_t> pairs() const {
        std::vector<std::int32_t> pairs = once(nullptr);
        for (int round = 0; round < mOptions.rounds; ++round) pairs = once(&pairs);
        return pairs;
    }
    double c(std::size_t s, std::size_t q) const {
        const double far = length(apart(s, q));
        const double together = double(dot(mS.normals[s], mQ.normals[q]));
        const double varies = std::abs(double(mS.variation[s] - mQ.variation[q]));
        if (far > mOptions.limits.position || together < cosine(mOptions.limits.normal * kPi / 180) ||
            varies > mOptions.limits.variation)
            return std::numeric_limits<double>::infinity();
        const PairingWeights& w = mOptions.weights;
        return w.position * far * far + w.normal / 2 * (1 - together) + w.variation * varies * varies;
    }
    double g(std::size_t s, std::size_t q, const std::vector<std::int32_t>& pairs) const {
        double sum = 0, far = 0;
        Vec3d along;
        for (std::size_t r = 0; r < pairs.size(); ++r) {
            const double away = length(cast<double>(mQ.points[r] - mQ.points[q])) / mSpacing;
            if (r == q || pairs[r] < 0 || away > 3 * mOptions.coherence) continue;
            const double theta = exponential(-away * away / (2 * mOptions.coherence * mOptions.coherence));
            sum += theta;
            far += theta * length(apart(std::size_t(pairs[r]), r));
            along = along + apart(std::size_t(pairs[r]), r) * theta;
        }
        if (sum <= 0) return 0;
        const Vec3d own = apart(s, q);
        const double together = length(own) > 0 ? dot(normalized(along), own) / length(own) : 0;
        return mOptions.weights.length * std::abs(length(own) - far / sum) +
               mOptions.weights.direction / 2 * (1 - together);
    }

private:
    Vec3d apart(std::size_t s, std::size_t q) const {
        return cast<double>(mS.points[s] - mQ.points[q]) * (1 / mSpacing);
    }
    std::vector<std::int32_t> once(const std::vector<std::int32_t>* before) const {
        std::vector<std::int32_t> pairs(mQ.points.size(), -1);
        std::vector<bool> taken(mS.points.size(), false);
        for (std::size_t q = 0; q < pairs.size(); ++q) {
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t s = 0; s < mS.points.size(); ++s) {
                if (taken[s]) continue;
                const double cost = c(s, q) + (before ? g(s, q, *before) : 0);
                if (!(cost < least)) continue;
                least = cost;
                pairs[q] = std::int32_t(s);
            }
            if (pairs[q] >= 0) taken[std::size_t(pairs[q])] = true;
        }
        return pairs;
    }

    const PairingPoints &mS, &mQ;
    double mSpacing;
    PairingOptions mOptions;
};

PairingOptions withRounds(int rounds) {
    PairingOptions options;
    options.rounds = rounds;
    return options;
}

}  // namespace

TEST_CASE("pairPoints: nearest free sources in the order of targets, by hand") {
    PairingPoints sources, targets;
    append(sources, {0, 0, 0});
    append(sources, {3, 0, 0});
    append(sources, {0, 3, 0});
    append(targets, {1, 0, 0});
    append(targets, {0.5f, 0, 0});
    // The second would have the first source, which is gone: the next is the third at 3.04.
    CHECK(pairPoints(sources, targets, 1, withRounds(0)) == std::vector<std::int32_t>{0, 1});
    append(targets, {2.9f, 0, 0});
    CHECK(pairPoints(sources, targets, 1, withRounds(0)) == std::vector<std::int32_t>{0, 1, 2});
    // Of two as good the first.
    PairingPoints between;
    append(between, {1.5f, 0, 0});
    PairingPoints swapped;
    append(swapped, {3, 0, 0});
    append(swapped, {0, 0, 0});
    CHECK(pairPoints(swapped, between, 1, withRounds(0)) == std::vector<std::int32_t>{0});
    CHECK(pairPoints(sources, between, 1, withRounds(0)) == std::vector<std::int32_t>{0});
}

TEST_CASE("pairPoints: beyond any limit there is no pair") {
    const auto pairOf = [](const Vec3f& place, const Vec3f& normal, float variation) {
        PairingPoints sources, targets;
        append(sources, {0, 0, 0});
        append(targets, place, normal, variation);
        return pairPoints(sources, targets, 0.5, withRounds(2))[0];
    };
    CHECK(pairOf({2.9f, 0, 0}, {0, 0, 1}, 0) == 0);
    CHECK(pairOf({3.1f, 0, 0}, {0, 0, 1}, 0) == -1);  // 6.2 spacings
    CHECK(pairOf({0, 0, 0}, normalized(Vec3f{1.7f, 0, 1}), 0) == 0);
    CHECK(pairOf({0, 0, 0}, normalized(Vec3f{1.8f, 0, 1}), 0) == -1);  // 61 degrees
    CHECK(pairOf({0, 0, 0}, {0, 0, 1}, 0.09f) == 0);
    CHECK(pairOf({0, 0, 0}, {0, 0, 1}, 0.11f) == -1);
}

TEST_CASE("pairingCost: by hand") {
    // Two targets three spacings apart, moved by 1 and by 2 spacings along x.
    PairingPoints sources, targets;
    append(sources, {1, 0, 0}, {0, 0.6f, 0.8f}, 0.05f);
    append(sources, {2, 3, 0});
    append(targets, {0, 0, 0});
    append(targets, {0, 3, 0});
    PairingOptions options;
    options.weights = {1, 3, 30, 9, 7};
    const double c = 1 + 1.5 * 0.2 + 30 * 0.0025 + 4;
    // Each has the other's length and direction for its mean.
    CHECK(pairingCost(sources, targets, {0, 1}, 1, options) == Approx(c + 9 + 9));
    // One alone has no neighbours.
    CHECK(pairingCost(sources, targets, {-1, 1}, 1, options) == Approx(4));
    // Against each other's direction.
    sources.points[1].x = -2;
    CHECK(pairingCost(sources, targets, {0, 1}, 1, options) == Approx(c + 9 + 9 + 7 + 7));
    // Of length 0 it is half of that.
    sources.points[1].x = 0;
    CHECK(pairingCost(sources, targets, {0, 1}, 1, options) == Approx(c - 4 + 9 + 9 + 3.5 + 3.5));
    // Where lengths are counted in spacings of another size nothing changes.
    for (PairingPoints* points : {&sources, &targets})
        for (Vec3f& p : points->points) p = p * 0.25f;
    CHECK(pairingCost(sources, targets, {0, 1}, 0.25, options) == Approx(c - 4 + 9 + 9 + 3.5 + 3.5));
}

TEST_CASE("pairPoints and pairingCost: as by the definition") {
    for (std::uint64_t seed = 0; seed < 6; ++seed)
        for (const int rounds : {0, 1, 4}) {
            const PairingPoints sources = randomPoints(120, 2 * seed),
                                targets = randomPoints(50, 2 * seed + 1);
            PairingOptions options = withRounds(rounds);
            options.coherence = 1.5;
            const ByDefinition wanted(sources, targets, 0.7, options);
            const auto pairs = pairPoints(sources, targets, 0.7, options);
            CAPTURE(seed, rounds);
            REQUIRE(pairs == wanted.pairs());
            double cost = 0;
            for (std::size_t q = 0; q < pairs.size(); ++q)
                if (pairs[q] >= 0)
                    cost += wanted.c(std::size_t(pairs[q]), q) + wanted.g(std::size_t(pairs[q]), q, pairs);
            CHECK(pairingCost(sources, targets, pairs, 0.7, options) == Approx(cost));
        }
}

TEST_CASE("pairPoints: with points that are the targets themselves, each is its own") {
    const PairingPoints sources = randomPoints(300, 20);
    PairingPoints targets;
    for (std::size_t n = 0; n < 300; n += 7)
        append(targets, sources.points[n], sources.normals[n], sources.variation[n]);
    const auto pairs = pairPoints(sources, targets, 0.7, {});
    for (std::size_t q = 0; q < pairs.size(); ++q) CHECK(pairs[q] == std::int32_t(7 * q));
}

TEST_CASE("pairPoints: no sources, no targets, and what is refused") {
    const PairingPoints some = randomPoints(5, 1);
    CHECK(pairPoints(some, {}, 1, {}).empty());
    CHECK(pairPoints({}, some, 1, {}) == std::vector<std::int32_t>(5, -1));
    const auto code = [&](const PairingPoints& sources, double spacing, const PairingOptions& options) {
        return test::thrownBy([&] { pairPoints(sources, some, spacing, options); }).code;
    };
    PairingPoints uneven = some;
    uneven.variation.pop_back();
    CHECK(code(uneven, 1, {}) == int(ErrorCode::ShapeMismatch));
    uneven = some;
    uneven.normals.pop_back();
    CHECK(code(uneven, 1, {}) == int(ErrorCode::ShapeMismatch));
    const int invalid = int(ErrorCode::InvalidOption);
    for (const double spacing : {0.0, -1.0, std::nan("")}) CHECK(code(some, spacing, {}) == invalid);
    const auto refuses = [&](const auto& change) {
        PairingOptions options;
        change(options);
        return code(some, 1, options) == invalid;
    };
    for (const double bad : {-1.0, 1e7, std::nan("")}) {
        CHECK(refuses([&](PairingOptions& o) { o.weights.position = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.weights.normal = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.weights.variation = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.weights.length = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.weights.direction = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.limits.position = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.limits.normal = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.limits.variation = bad; }));
        CHECK(refuses([&](PairingOptions& o) { o.coherence = bad; }));
    }
    CHECK(refuses([](PairingOptions& o) { o.limits.position = 0; }));
    CHECK(refuses([](PairingOptions& o) { o.coherence = 0; }));
    CHECK(refuses([](PairingOptions& o) { o.rounds = -1; }));
    CHECK(refuses([](PairingOptions& o) { o.rounds = 21; }));
}

namespace {

// A smooth warp, `size` spacings at most.
WarpedPlace knownWarp(const Vec3d& p, double size) {
    const double w = 2 * kPi / 80;
    const double x = size * sine(w * p.y + 1), y = 0.7 * size * cosine(w * p.x),
                 z = 0.5 * size * sine(w * p.x);
    WarpedPlace warped{p + Vec3d{x, y, z}, {}};
    warped.jacobian[0] = {1, -0.7 * size * w * sine(w * p.x), 0.5 * size * w * cosine(w * p.x)};
    warped.jacobian[1] = {size * w * cosine(w * p.y + 1), 1, 0};
    warped.jacobian[2] = {0, 0, 1};
    return warped;
}

struct WarpErrors {
    double wrong = 0, place = 0, degrees = 0;
};

WarpErrors recovered(double size) {
    const test::PointShape shape = test::eggCratePoints({16, 3}, 40, 0);
    const auto variation = surfaceVariation(shape.point, shape.normal);
    PairingPoints sources{shape.point, shape.normal, variation}, targets;
    const auto chosen = clusterPoints(shape.point, shape.normal, {10, 0.05}).representative;
    for (const std::uint32_t n : chosen) {
        const WarpedPlace warped = knownWarp(cast<double>(shape.point[n]), size);
        append(targets, cast<float>(warped.place),
               cast<float>(warpedNormal(warped.jacobian, cast<double>(shape.normal[n]))), variation[n]);
    }
    const auto pairs = pairPoints(sources, targets, 1, withRounds(8));
    std::vector<Vec3d> from, to;
    WarpErrors errors;
    for (std::size_t q = 0; q < pairs.size(); ++q) {
        if (pairs[q] != std::int32_t(chosen[q])) errors.wrong += 1;
        if (pairs[q] < 0) continue;
        from.push_back(cast<double>(sources.points[std::size_t(pairs[q])]));
        to.push_back(cast<double>(targets.points[q]));
    }
    const ThinPlateWarp warp(from, to);
    for (std::size_t n = 0; n < shape.point.size(); ++n) {
        const Vec3d place = cast<double>(shape.point[n]), normal = cast<double>(shape.normal[n]);
        if (place.x < 3 || place.y < 3 || place.x > 37 || place.y > 37) continue;
        const WarpedPlace found = warp.at(place), wanted = knownWarp(place, size);
        errors.place = std::max(errors.place, length(found.place - wanted.place));
        const double apart =
            length(warpedNormal(found.jacobian, normal) - warpedNormal(wanted.jacobian, normal));
        errors.degrees = std::max(errors.degrees, apart * 180 / kPi);
    }
    errors.wrong /= double(pairs.size());
    return errors;
}

}  // namespace

TEST_CASE("pairPoints: a known warp is recovered by pairing and the thin-plate spline") {
    for (const double size : {0.3, 0.6, 1.0}) {
        const WarpErrors errors = recovered(size);
        CAPTURE(size, errors.wrong);
        CHECK(errors.place < 0.05);
        CHECK(errors.degrees < 1);
    }
}
