#include "libvdbsynth/patch/patch_candidates.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/patch_shapes.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace vdbsynth;

namespace {

const PatchLattice kLattice{1, 20, 18, 3};  // an odd height: a column is no multiple of eight values

PatchOverlap noisyOverlap(std::uint64_t seed) {
    PatchOverlap overlap = ownOverlap(test::noisePatchField(kLattice, seed), {3, 4}, 6, 2);
    return overlap;
}

// d^2 by its definition.
double costAt(const PatchField& exemplar, const PatchOverlap& overlap, const PatchPlace& place) {
    double sum = 0;
    for (std::size_t c = 0; c < overlap.columns.size(); ++c) {
        const float* there = exemplar.column(place.i + overlap.columns[c].i, place.j + overlap.columns[c].j);
        for (std::size_t v = 0; v < exemplar.columnLength(); ++v) {
            const double apart = double(there[v] - overlap.values[c * exemplar.columnLength() + v]);
            sum += apart * apart;
        }
    }
    return sum;
}

std::vector<PatchCandidate> byDefinition(const PatchField& exemplar, const PatchOverlap& overlap,
                                         double tolerance) {
    std::vector<PatchCandidate> all, candidates;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i + overlap.nx <= exemplar.lattice.nx; ++i)
        for (int j = 0; j + overlap.ny <= exemplar.lattice.ny; ++j) {
            all.push_back({{i, j}, costAt(exemplar, overlap, {i, j})});
            least = std::min(least, all.back().cost);
        }
    const double most = (1 + tolerance) * std::sqrt(least) + 1e-3 * std::sqrt(double(overlap.values.size()));
    for (const PatchCandidate& candidate : all)
        if (std::sqrt(candidate.cost) <= most) candidates.push_back(candidate);
    return candidates;
}

}  // namespace

TEST_CASE("ownOverlap: the columns left and below, by hand") {
    const PatchField field = test::noisePatchField(kLattice, 1);
    const PatchOverlap overlap = ownOverlap(field, {4, 7}, 3, 1);
    CHECK(overlap.nx == 3);
    CHECK(overlap.ny == 3);
    REQUIRE(overlap.columns.size() == 5);
    const int places[5][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 0}, {2, 0}};
    for (std::size_t c = 0; c < 5; ++c) {
        CHECK(overlap.columns[c].i == places[c][0]);
        CHECK(overlap.columns[c].j == places[c][1]);
        const float* there = field.column(4 + places[c][0], 7 + places[c][1]);
        CHECK(std::equal(there, there + 12, overlap.values.data() + c * 12));
    }
}

TEST_CASE("patchCandidates: a query cut from the exemplar has distance 0 there and nowhere else") {
    const PatchField field = test::noisePatchField(kLattice, 2);
    for (const PatchPlace place : {PatchPlace{0, 0}, PatchPlace{5, 9}, PatchPlace{14, 12}}) {
        const auto found = patchCandidates(field, ownOverlap(field, place, 6, 2), {});
        REQUIRE(found.size() == 1);
        CHECK(found[0].place == place);
        CHECK(found[0].cost == 0);
    }
}

TEST_CASE("patchCandidates: in a texture that repeats, all its periods, in order") {
    const test::EggCrate crate;
    const PatchField field = test::measuredField(test::eggCrateExemplar(crate, 48), 2);
    CandidateOptions options;
    options.tolerance = 0;
    const auto found = patchCandidates(field, ownOverlap(field, {9, 3}, 8, 3), options);
    CHECK(found.size() == 1);  // points are not where they were a period ago
    options.tolerance = 10;
    options.excluded = {{9, 3}};
    options.exclusion = 2;
    const auto others = patchCandidates(field, ownOverlap(field, {9, 3}, 8, 3), {0.1, {{9, 3}}, 2});
    for (const PatchCandidate& other : others) {
        // Half a period along both axes is the same too.
        CHECK((other.place.i - 9) % 4 == 0);
        CHECK((other.place.j - 3) % 4 == 0);
        CHECK((other.place.i - 9 + other.place.j - 3) % 8 == 0);
    }
    CHECK(!others.empty());
}

TEST_CASE("patchCandidates: as by the definition, whatever the tolerance") {
    for (std::uint64_t seed = 10; seed < 14; ++seed) {
        const PatchField field = test::noisePatchField(kLattice, seed);
        const PatchOverlap overlap = noisyOverlap(seed + 100);
        for (const double tolerance : {0.0, 0.05, 0.1, 0.5, 10.0}) {
            CandidateOptions options;
            options.tolerance = tolerance;
            const auto found = patchCandidates(field, overlap, options),
                       wanted = byDefinition(field, overlap, tolerance);
            CAPTURE(seed, tolerance);
            REQUIRE(found.size() == wanted.size());
            for (std::size_t n = 0; n < found.size(); ++n) {
                REQUIRE(found[n].place == wanted[n].place);
                REQUIRE(found[n].cost == Approx(wanted[n].cost).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("patchCandidates: places that are left out, and all of them") {
    const PatchField field = test::noisePatchField(kLattice, 3);
    const PatchOverlap overlap = ownOverlap(field, {5, 9}, 6, 2);
    const auto others = patchCandidates(field, overlap, {10, {{5, 9}}, 2});
    CHECK(!others.empty());
    for (const PatchCandidate& other : others)
        CHECK((std::abs(other.place.i - 5) > 2 || std::abs(other.place.j - 9) > 2));
    CHECK(patchCandidates(field, overlap, {10, {{5, 9}}, 30}).empty());
}

TEST_CASE("patchCandidates: nothing known, a patch as large as the exemplar, and one that is larger") {
    const PatchField field = test::noisePatchField(kLattice, 4);
    PatchOverlap overlap;
    overlap.nx = 6;
    overlap.ny = 6;
    CHECK(patchCandidates(field, overlap, {}).size() == 15 * 13);
    overlap.nx = 20;
    overlap.ny = 18;
    CHECK(patchCandidates(field, overlap, {}).size() == 1);
    overlap.nx = 21;
    CHECK(test::thrownBy([&] { patchCandidates(field, overlap, {}); }).code == int(ErrorCode::Unusable));
}

TEST_CASE("patchCandidates: same bits for any number of threads, and cancelled", "[patch][tsan]") {
    const PatchField field = test::noisePatchField({1, 40, 40, 3}, 5);
    const PatchOverlap overlap = noisyOverlap(7);
    const CandidateOptions options{0.5, {}, 0};
    const auto one = patchCandidates(field, overlap, options, test::onThreads(1)),
               three = patchCandidates(field, overlap, options, test::onThreads(3));
    REQUIRE(one.size() == three.size());
    for (std::size_t n = 0; n < one.size(); ++n) {
        CHECK(one[n].place == three[n].place);
        CHECK(one[n].cost == three[n].cost);
    }
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              patchCandidates(field, overlap, options, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE(
    "nearMatchLevel: nothing where the texture repeats, what noise differs by, infinite without another") {
    const PatchField noise = test::noisePatchField(kLattice, 6);
    const PatchField repeating = test::patchFieldFrom(kLattice, [&](int i, int j, int k) {
        test::NodeValues node;
        std::copy_n(noise.column(i % 5, j % 4) + k * kFieldValues, std::size_t(kFieldValues), node.begin());
        return node;
    });
    CHECK(nearMatchLevel(repeating, 6, 2, 5, 3) == 0);
    // Two uniform values in [-3, 3) differ by 6 in the mean of squares, two in [-1, 1) by 2/3: 2 altogether.
    const double level = nearMatchLevel(noise, 6, 2, 5, 3);
    CHECK(level > 1);
    CHECK(level < 2);
    CHECK(std::isinf(nearMatchLevel(noise, 6, 2, 5, 30)));
    CHECK(std::isinf(nearMatchLevel(noise, 18, 2, 5, 3)));
    CHECK(nearMatchLevel(noise, 6, 2, 5, 3, test::onThreads(3)) == level);
    RunContext other;
    other.seed = 77;
    CHECK(nearMatchLevel(noise, 6, 2, 5, 3, other) != level);
}
