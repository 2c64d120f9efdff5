#include "libvdbsynth/texture/point_parameterization.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

SampleImage tile() {
    return test::cloudSample(64, 3, true);
}

// The largest difference of lengths between a chart and its flat original, over pairs with and without much
// between them, in spacings; for a rigid motion it is 0.
double rigidError(const PointParameterizationResult& result, const std::vector<Vec3d>& flat) {
    // The motion from the first point's frame by least squares: rotation by the angle of sum of q * conj(p).
    const std::size_t n = flat.size();
    Vec3d p0, q0;
    for (std::size_t i = 0; i < n; ++i) {
        p0 = p0 + flat[i] * (1.0 / double(n));
        q0 = q0 + Vec3d{result.position[i].x, result.position[i].y, 0} * (1.0 / double(n));
    }
    double c = 0, s = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3d p = flat[i] - p0, q = Vec3d{result.position[i].x, result.position[i].y, 0} - q0;
        c += p.x * q.x + p.y * q.y;
        s += p.x * q.y - p.y * q.x;
    }
    const double size = std::sqrt(c * c + s * s);
    c /= size;
    s /= size;
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3d p = flat[i] - p0, q = Vec3d{result.position[i].x, result.position[i].y, 0} - q0;
        worst = std::max(worst, length(Vec3d{c * p.x - s * p.y - q.x, s * p.x + c * p.y - q.y, 0}));
    }
    return worst;
}

// Mean relative error of the lengths between points about a fixed way apart on the unrolled surface.
double lengthError(const PointParameterizationResult& result, const std::vector<Vec3d>& unrolled) {
    double sum = 0, whole = 0;
    Random random(9, 9);
    for (int pair = 0; pair < 4000; ++pair) {
        const std::uint32_t i = random.below(std::uint32_t(unrolled.size()));
        const std::uint32_t j = random.below(std::uint32_t(unrolled.size()));
        if (result.patch[i] != 0 || result.patch[j] != 0) continue;
        const double x = result.position[i].x - result.position[j].x;
        const double y = result.position[i].y - result.position[j].y;
        const double flat = length(unrolled[i] - unrolled[j]) / result.spacing;
        sum += std::abs(std::sqrt(x * x + y * y) - flat);
        whole += flat;
    }
    return sum / whole;
}

// The cylinder of radius 1 with points `step` apart.
double cylinderError(double step) {
    const test::PointShape sheet = test::rolledSheet(3, 5, step);
    std::vector<Vec3d> unrolled;
    for (const Vec3f& p : sheet.point) {
        double angle = std::atan2(double(p.y), double(p.z));
        if (angle < -0.4) angle += 2 * kPi;
        unrolled.push_back({double(p.x), angle, 0});
    }
    const PointParameterizationResult result = parameterizePoints(test::targetOf(sheet), tile());
    CHECK(result.patches == 1);
    return lengthError(result, unrolled);
}

}  // namespace

TEST_CASE("parameterizePoints: a plane of 10^5 random points is moved rigidly, in one patch") {
    const test::PointShape plane = test::randomPlane(100000, 316);
    const PointParameterizationResult result = parameterizePoints(test::targetOf(plane), tile());
    CHECK(result.patches == 1);
    CHECK(result.gaps == 0);
    std::vector<Vec3d> flat;
    for (const Vec3f& p : plane.point) flat.push_back(cast<double>(p) * (1 / result.spacing));
    CHECK(rigidError(result, flat) < 1e-5);
    // +v is up, (0, 1, 0); so +u is (1, 0, 0).
    for (std::size_t i = 0; i < 1000; ++i) REQUIRE(length(result.sites.tangent[i] - Vec3f{1, 0, 0}) < 1e-5f);
    const Vec2f a = result.sites.coordinate[5], b = result.sites.coordinate[7];
    CHECK(double(b.x - a.x) == Approx(flat[7].x - flat[5].x).margin(1e-3));
    CHECK(double(b.y - a.y) == Approx(flat[7].y - flat[5].y).margin(1e-3));
}

TEST_CASE("parameterizePoints: a plane in space is moved rigidly too") {
    test::PointShape plane = test::randomPlane(20000, 141);
    std::vector<Vec3d> flat;
    const Vec3d n = normalized(Vec3d{1, 2, 3}), s = normalized(cross(n, Vec3d{0, 1, 0})), t = cross(n, s);
    for (std::size_t i = 0; i < plane.point.size(); ++i) {
        const Vec3d p = cast<double>(plane.point[i]);
        flat.push_back(p);
        plane.point[i] = cast<float>(s * p.x + t * p.y);
        plane.normal[i] = cast<float>(n);
    }
    const PointParameterizationResult result = parameterizePoints(test::targetOf(plane), tile());
    for (Vec3d& p : flat) p = p * (1 / result.spacing);
    CHECK(result.gaps == 0);
    CHECK(rigidError(result, flat) < 1e-3);  // the points themselves are rounded to 1e-5 of a spacing
}

TEST_CASE("parameterizePoints: a cylinder is unrolled, its error falls as the square of the spacing") {
    const double fine = cylinderError(0.03), coarse = cylinderError(0.06);
    INFO(fine << " " << coarse);
    CHECK(fine < 0.002);
    CHECK(coarse > 2 * fine);
}

TEST_CASE("parameterizePoints: a cone without its apex is unrolled") {
    // Slope 45 degrees: an angle a about the axis is a * sin(45) in the plane.
    test::PointShape cone;
    std::vector<Vec3d> unrolled;
    const double half = std::sqrt(0.5), step = 0.03;
    for (double r = 1; r < 3; r += step)
        for (double a = 0; a < 4; a += step / (r * half)) {
            Random random(2, cone.point.size());
            const double at = r + step * random.uniform(-0.35, 0.35);
            const double angle = a + step / (r * half) * random.uniform(-0.35, 0.35);
            cone.point.push_back(
                cast<float>(Vec3d{at * half * std::cos(angle), at * half * std::sin(angle), -at * half}));
            cone.normal.push_back(cast<float>(Vec3d{half * std::cos(angle), half * std::sin(angle), half}));
            unrolled.push_back({at * std::cos(angle * half), at * std::sin(angle * half), 0});
        }
    const PointParameterizationResult result = parameterizePoints(test::targetOf(cone), tile());
    CHECK(result.patches == 1);
    const double error = lengthError(result, unrolled);
    INFO(error);
    CHECK(error < 0.002);
}

TEST_CASE("parameterizePoints: a cap of a ball has the area of the geodesic chart") {
    // Around its seed a chart is the geodesic one: at an angle t, lengths across are sin(t)/t of the flat
    // ones.
    test::PointShape cap;
    const test::PointShape ball = test::spiralSphere(200000, 1);
    for (std::size_t i = 0; i < ball.point.size(); ++i)
        if (ball.point[i].z > 0.88f) {
            cap.point.push_back(ball.point[i]);
            cap.normal.push_back(ball.normal[i]);
        }
    PointParameterizationOptions options;
    options.distortion.threshold = 1e3;
    const PointParameterizationResult result = parameterizePoints(test::targetOf(cap), tile(), options);
    REQUIRE(result.patches == 1);
    std::size_t seed = 0;
    for (std::size_t i = 0; i < cap.point.size(); ++i)
        if (result.position[i].x == 0 && result.position[i].y == 0) seed = i;
    // Arcs from the seed are kept, and what is an angle about it; the area at an arc t is then t / sin(t) of
    // the ball's.
    const SurfaceSites sites = sitesOfPoints(cap.point, cap.normal, 6);
    double radius = 0, points = 0, area = 0, expected = 0;
    for (std::size_t i = 0; i < cap.point.size(); ++i) {
        const double arc = std::acos(std::min(1.0, double(dot(cap.normal[i], cap.normal[seed]))));
        if (arc < 0.1 || arc > 0.4) continue;
        const double x = result.position[i].x, y = result.position[i].y;
        radius += std::sqrt(x * x + y * y) * result.spacing / arc;
        ++points;
        const std::uint32_t a = sites.neighbours[sites.begin[i]], b = sites.neighbours[sites.begin[i] + 2];
        const Vec3f whole = cross(cap.point[a] - cap.point[i], cap.point[b] - cap.point[i]);
        const ChartPosition qa = result.position[a], qb = result.position[b];
        const double flat = (qa.x - x) * (qb.y - y) - (qa.y - y) * (qb.x - x);
        area += std::abs(flat) * result.spacing * result.spacing;
        expected += double(length(whole)) * arc / std::sin(arc);
    }
    CHECK(radius / points == Approx(1).epsilon(0.01));
    CHECK(area / expected == Approx(1).epsilon(0.01));
}

TEST_CASE("parameterizePoints: patches of a sample that is not tileable stay inside it") {
    SampleImage sample = test::cloudSample(24, 3, false);
    const test::PointShape ball = test::spiralSphere(8000, 1);
    for (const double scale : {0.5, 1.0, 2.0}) {
        PointParameterizationOptions options;
        options.scale = scale;
        const PointParameterizationResult result = parameterizePoints(test::targetOf(ball), sample, options);
        CHECK(result.texel == Approx(result.spacing * scale));
        CHECK(result.patches > 3);
        std::size_t gaps = 0;
        for (std::size_t i = 0; i < ball.point.size(); ++i) {
            REQUIRE(result.sites.sample[i] == 0);
            REQUIRE(length(result.sites.tangent[i]) == Approx(1).epsilon(1e-4));
            REQUIRE(std::abs(dot(result.sites.tangent[i], ball.normal[i])) < 1e-4f);
            if (result.patch[i] == PointPatches::kGap) {
                ++gaps;
                continue;
            }
            const Vec2f at = result.sites.coordinate[i];
            REQUIRE((at.x >= -1e-3f && at.x <= 24.001f && at.y >= -1e-3f && at.y <= 24.001f));
            REQUIRE_FALSE(result.sites.blended[i]);
        }
        CHECK(gaps == result.gaps);
        CHECK(gaps > 0);
    }
}

TEST_CASE("parameterizePoints: gaps mixed by histogram keep the contrast, by weight they lose it") {
    const SampleImage sample = test::cloudSample(64, 3, false);
    const test::PointShape ball = test::spiralSphere(30000, 1);
    const auto inGaps = [&](SampleBlend blend) {
        PointParameterizationOptions options;
        options.patchSize = 0.3;
        options.blend = blend;
        const PointParameterizationResult result = parameterizePoints(test::targetOf(ball), sample, options);
        std::vector<float> gaps, inside;
        for (std::size_t i = 0; i < ball.point.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                if (result.sites.blended[i]) gaps.push_back(result.sites.values[3 * i + c]);
                if (result.patch[i] >= 0) inside.push_back(result.sites.values[3 * i + c]);
            }
        REQUIRE(gaps.size() > 3000);
        return test::contrast(gaps, 3, 1) / test::contrast(inside, 3, 1);
    };
    const double byWeight = inGaps(SampleBlend::Weight), byHistogram = inGaps(SampleBlend::Histogram);
    INFO(byWeight << " " << byHistogram);
    CHECK(byWeight < 0.9);
    CHECK(byHistogram > 0.95);
    CHECK(byHistogram < 1.05);
}

TEST_CASE("parameterizePoints: degenerate targets and samples are coloured") {
    const SampleImage one{1, 1, 3, false, {0.1f, 0.2f, 0.3f}};
    const std::vector<Vec3f> up(3, {0, 0, 1});
    std::vector<TextureTarget> targets;
    targets.push_back({{{0, 0, 0}}, {{0, 0, 1}}, {}, {}});
    targets.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up, {}, {}});
    targets.push_back({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, up, {}, {}});
    targets.push_back({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, up, {}, {}});
    targets.push_back({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, up, {}, {}});            // along the normal
    targets.push_back({{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 0, -1}}, {}, {}});  // no neighbours
    targets.push_back(test::targetOf(test::spiralSphere(500, 1)));
    for (const TextureTarget& target : targets)
        for (const SampleBlend blend :
             {SampleBlend::Automatic, SampleBlend::Weight, SampleBlend::Histogram}) {
            PointParameterizationOptions options;
            options.blend = blend;
            const PointParameterizationResult result = parameterizePoints(target, one, options);
            for (std::size_t i = 0; i < target.point.size(); ++i) {
                REQUIRE(result.sites.sample[i] == 0);
                REQUIRE(length(result.sites.tangent[i]) == Approx(1));
                REQUIRE(result.sites.values[3 * i + 2] == Approx(0.3f));
            }
        }
}

TEST_CASE("parameterizePoints: bad arguments, cancel, threads") {
    const TextureTarget target = test::targetOf(test::spiralSphere(20000, 1));
    const SampleImage sample = test::cloudSample(32, 3, false);
    const auto call = [&](const PointParameterizationOptions& options) {
        parameterizePoints(target, sample, options);
    };
    const auto refused = [&](const char* field, const auto& change) {
        test::requireRefused<PointParameterizationOptions>(call, field, change);
    };
    using Options = PointParameterizationOptions;
    refused("neighbours", [](Options& o) { o.neighbours = 2; });
    refused("scale", [](Options& o) { o.scale = 0; });
    refused("blend", [](Options& o) { o.blend = SampleBlend::Off; });
    refused("patchSize", [](Options& o) { o.patchSize = 1.5; });
    refused("w1", [](Options& o) { o.distortion.w1 = -1; });
    refused("threshold", [](Options& o) { o.distortion.threshold = -1; });
    refused("up", [](Options& o) { o.orientation.up = {0, 0, 0}; });
    CHECK_THROWS_AS(parameterizePoints(target, {}, {}), Error);
    const auto one = parameterizePoints(target, sample, {}, test::onThreads(1));
    const auto four = parameterizePoints(target, sample, {}, test::onThreads(4));
    CHECK(one.sites.values == four.sites.values);
    CHECK(one.patch == four.patch);
    RunContext other;
    other.seed = 5;
    CHECK(parameterizePoints(target, sample, {}, other).patch != one.patch);
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { parameterizePoints(target, sample, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
