#include "libvdbsynth/pipeline/make/make_points.h"

#include <catch2/catch.hpp>

#include <cstring>

#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/procedural/kinds.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

MakePointsOptions optionsFor(const std::string& kind, int resolution = 48) {
    openvdb::initialize();
    MakePointsOptions options;
    options.model.exemplar.kind = kind;
    options.model.exemplar.resolution = resolution;
    return options;
}

bool sameBits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

std::vector<Primitive> ringsOf(const TexturePoints& made, double feature) {
    ExemplarRequest request;
    request.domain = {{0, 0, 0}, {int(made.box.high.x), int(made.box.high.y), int(made.box.high.z)}};
    request.box = request.domain.expanded(40);
    request.feature = feature;
    return chainmailPrimitives(request);
}

const Primitive& nearest(const std::vector<Primitive>& shapes, const Vec3d& p) {
    return *std::min_element(shapes.begin(), shapes.end(), [&](const Primitive& a, const Primitive& b) {
        return a.distance(p) < b.distance(p);
    });
}

}  // namespace

TEST_CASE("makePoints: points lie on the rings, face outwards and have no caps", "[pipeline][oracle]") {
    const TexturePoints made = makePoints(optionsFor("chainmail"));
    const std::vector<Primitive> rings = ringsOf(made, 24);
    REQUIRE(made.cloud.normals.size() == made.cloud.points.size());
    double farthest = 0, worst = 1;
    for (std::size_t i = 0; i < made.cloud.points.size(); i += 7) {
        const Vec3d p = cast<double>(made.cloud.points[i]);
        const Primitive& ring = nearest(rings, p);
        farthest = std::max(farthest, std::abs(ring.distance(p)));
        // The middle of the tube beside the point.
        const Vec3d out = p - ring.a, flat = out - ring.b * dot(out, ring.b);
        const Vec3d middle = ring.a + normalized(flat) * ring.ring;
        worst = std::min(worst, dot(normalized(p - middle), cast<double>(made.cloud.normals[i])));
    }
    CHECK(farthest < 1e-4);  // [voxels]
    CHECK(worst > 0.99999);
}

TEST_CASE("makePoints: the domain, the margin and the spacing", "[pipeline][property]") {
    const TexturePoints made = makePoints(optionsFor("chainmail"));
    CHECK(length(made.box.low - Vec3d{-0.5, -0.5, -0.5}) == 0);
    CHECK(length(made.box.high - Vec3d{47.5, 47.5, 21.5}) == 0);
    CHECK(made.box.plane == HeightPlane::XY);
    float low = 0, high = 0;
    for (const Vec3f& p : made.cloud.points) {
        low = std::min({low, p.x, p.y});
        high = std::max({high, p.x, p.y});
    }
    CHECK(low >= -16.5f);  // two thirds of 24 voxels beyond the domain
    CHECK(low < -16);
    CHECK(high <= 63.5f);
    CHECK(high > 63);
    const PointNeighbours near(made.cloud.points);
    double least = 1e9, sum = 0;
    for (const Vec3f& p : made.cloud.points) {
        std::uint32_t numbers[2];
        float squared[2];
        near.nearest(p, 2, numbers, squared);
        const double gap = std::sqrt(double(squared[1]));
        least = std::min(least, gap);
        sum += gap;
    }
    CHECK(least >= 0.3 * 0.99);  // a quarter of a tube's 1.2 voxels
    CHECK(sum / double(made.cloud.points.size()) < 0.34);
}

TEST_CASE("makePoints: every kind, on any threads, in the world's units", "[pipeline][determinism]") {
    for (const ExemplarKind& kind : exemplarKinds()) {
        INFO(kind.name);
        MakePointsOptions options = optionsFor(kind.name, 16);
        options.model.exemplar.feature = 10;
        options.spacing = 1;
        options.margin = 2;
        const auto run = [&](int threads, double side) {
            options.model.voxelSize = side;
            RunContext ctx;
            ctx.threads = threads;
            ctx.seed = 3;
            return makePoints(options, ctx);
        };
        const TexturePoints one = run(1, 1);
        CHECK(one.cloud.points.size() > 80);
        CHECK(one.box.plane.has_value() == kind.isSheet());
        const TexturePoints other = run(3, 1);
        CHECK(sameBits(other.cloud.points, one.cloud.points));
        CHECK(sameBits(other.cloud.normals, one.cloud.normals));
        double outside = 0;
        for (std::size_t i = 0; i < one.cloud.points.size(); ++i) {
            CHECK(double(length(one.cloud.normals[i])) == Approx(1).margin(1e-5));
            for (int axis = 0; axis < 3; ++axis) {
                const double at = double(one.cloud.points[i][axis]);
                outside = std::max({outside, one.box.low[axis] - at, at - one.box.high[axis]});
            }
        }
        CHECK(outside <= (kind.isSheet() ? 6.0 : 2.0));
        if (kind.name != "weave") continue;
        const TexturePoints small = run(2, 0.25);
        REQUIRE(small.cloud.points.size() == one.cloud.points.size());
        CHECK(length(small.cloud.points[50] * 4.f - one.cloud.points[50]) < 1e-4f);
        CHECK(length(small.box.high * 4.0 - one.box.high) < 1e-12);
    }
}

TEST_CASE("makePoints: a margin of nothing, of a part of a voxel", "[pipeline]") {
    MakePointsOptions options = optionsFor("weave", 32);
    for (const double margin : {0.0, 0.25}) {
        options.margin = margin;
        for (const Vec3f& p : makePoints(options).cloud.points)
            for (int axis = 0; axis < 2; ++axis) {
                REQUIRE(double(p[axis]) >= -0.5 - margin - 1e-6);
                REQUIRE(double(p[axis]) <= 31.5 + margin + 1e-6);
            }
    }
}

TEST_CASE("makePoints: says which kinds are packed anew", "[pipeline]") {
    for (const char* kind : {"balls", "weave"}) {
        std::string said;
        RunContext ctx;
        ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
        MakePointsOptions options = optionsFor(kind, 24);
        options.margin = 2;
        makePoints(options, ctx);
        CHECK(test::contains(said, "packed anew") == (std::string(kind) == "balls"));
    }
}

TEST_CASE("makePoints: each error", "[pipeline][error]") {
    const auto fails = [](const MakePointsOptions& options, const char* says,
                          ErrorCode code = ErrorCode::InvalidOption) {
        const test::Thrown thrown = test::thrownBy([&] { makePoints(options); });
        INFO(thrown.message);
        CHECK(thrown.code == int(code));
        CHECK(test::contains(thrown.message, says));
    };
    MakePointsOptions options = optionsFor("weave", 32);
    options.spacing = 0.1;
    fails(options, "`spacing` 0.1");
    options.spacing = std::nan("");
    fails(options, "`spacing` nan");
    options.spacing = 0;
    options.margin = 5000;
    fails(options, "`margin` 5000");
    options.margin = std::nan("");
    fails(options, "`margin` nan");
    options.margin = -1;
    options.model.voxelSize = 0;
    fails(options, "`voxelSize`");
    fails(optionsFor("cubes"), "unknown kind");
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { makePoints(optionsFor("weave"), ctx); }).code == int(ErrorCode::Cancelled));
}
