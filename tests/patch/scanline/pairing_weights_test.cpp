#include "libvdbsynth/patch/scanline/pairing_weights.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/points/surface_variation.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

PairingWeights weightsOf(const PatchExemplar& exemplar, double step, int patch, const RunContext& ctx = {}) {
    const auto variation = surfaceVariation(exemplar.points, exemplar.normals);
    return nearMatchWeights(exemplar, variation, test::measuredField(exemplar, step), patch, 3, 6, ctx);
}

std::vector<double> listed(const PairingWeights& w) {
    return {w.position, w.normal, w.variation, w.length, w.direction};
}

}  // namespace

TEST_CASE("nearMatchWeights: every term counts in units of what it costs, where it costs anything") {
    const PairingWeights weights = weightsOf(test::eggCrateExemplar({13.3, 3}, 48), 2, 12);
    CHECK(weights.position == 1);
    for (const double weight : listed(weights)) {
        CHECK(weight > 0);
        CHECK(weight <= 1e6);
    }
    // Normals and variation of true pairs differ by far less than their places do in spacings.
    CHECK(weights.normal > 5);
    CHECK(weights.variation > weights.normal);
    // On a plane they do not differ at all.
    const PairingWeights plane = weightsOf(test::exemplarOf(test::eggCratePoints({16, 0}, 48, 8), 48), 2, 12);
    CHECK(plane.normal == 1);
    CHECK(plane.variation == 1);
    CHECK(plane.length > 0);
}

TEST_CASE("nearMatchWeights: by hand, of rows that are moved by half a spacing") {
    // A flat exemplar whose points lie on a lattice, those right of the middle moved along y: where both
    // overlaps are of one side pairs cost nothing, else (1/2)^2 each, all with the same length and direction.
    test::PointShape shape = test::latticePlane(40);
    for (Vec3f& p : shape.point) p = p + Vec3f{0.5f, p.x >= 20 ? 0.75f : 0.5f, 0};
    const PairingWeights weights = weightsOf(test::exemplarOf(shape, 40), 2, 12);
    CHECK(weights.normal == 1);
    CHECK(weights.variation == 1);
}

TEST_CASE("nearMatchWeights: without another place, or pairs, the defaults") {
    const std::vector<double> defaults = listed(PairingWeights{});
    const PatchExemplar exemplar = test::eggCrateExemplar({13.3, 3}, 48);
    CHECK(listed(weightsOf(exemplar, 2, 24)) == defaults);
    PatchExemplar none = exemplar;
    for (Vec3f& p : none.points) p.z += 1000;  // the field below is empty
    const auto variation = surfaceVariation(exemplar.points, exemplar.normals);
    const PatchField field = test::measuredField(exemplar, 2);
    none.points.clear();
    none.normals.clear();
    CHECK(listed(nearMatchWeights(none, {}, field, 12, 3, 6)) == defaults);
    CHECK(listed(nearMatchWeights(exemplar, variation, field, 12, 3, 0)) == defaults);
}

TEST_CASE("nearMatchWeights: same bits for any number of threads, another seed other weights, cancelled",
          "[patch][tsan]") {
    const PatchExemplar exemplar = test::eggCrateExemplar({13.3, 3}, 48);
    const auto one = listed(weightsOf(exemplar, 2, 12, test::onThreads(1)));
    CHECK(one == listed(weightsOf(exemplar, 2, 12, test::onThreads(3))));
    RunContext other;
    other.seed = 3;
    CHECK(one != listed(weightsOf(exemplar, 2, 12, other)));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { weightsOf(exemplar, 2, 12, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
