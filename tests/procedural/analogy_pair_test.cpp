#include "libvdbsynth/procedural/analogy_pair.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

AnalogyPairFields made(const std::string& kind, std::uint64_t seed, int threads = 0) {
    ExemplarOptions options;
    options.kind = kind;
    options.resolution = 64;
    RunContext ctx;
    ctx.seed = seed;
    ctx.threads = threads;
    return makeAnalogyPair(options, ctx);
}

}  // namespace

TEST_CASE("makeAnalogyPair: both over one domain, different, and another seed is another pair",
          "[procedural]") {
    for (const AnalogyPairKind& kind : analogyPairKinds()) {
        INFO(kind.name);
        const AnalogyPairFields a = made(kind.name, 1), again = made(kind.name, 1, 1), b = made(kind.name, 2);
        CHECK(a.plain.domain == a.textured.domain);
        CHECK(a.direction == kind.direction);
        const std::vector<float> plain = test::samplesOf(a.plain.field),
                                 textured = test::samplesOf(a.textured.field);
        std::size_t solid = 0, differ = 0;
        for (std::size_t i = 0; i < plain.size(); ++i) {
            solid += plain[i] < 0;
            differ += (plain[i] < 0) != (textured[i] < 0);
        }
        CHECK(solid > plain.size() / 50);
        CHECK(differ > plain.size() / 500);
        CHECK(textured == test::samplesOf(again.textured.field));
        CHECK(textured != test::samplesOf(b.textured.field));
    }
}

TEST_CASE("makeAnalogyPair: what cannot be made is refused", "[procedural]") {
    ExemplarOptions options;
    options.kind = "feathers";
    CHECK(test::thrownBy([&] { makeAnalogyPair(options); }).code == int(ErrorCode::InvalidOption));
    options.kind = "pits";
    options.feature = 32;
    options.resolution = 64;
    CHECK(test::contains(test::thrownBy([&] { makeAnalogyPair(options); }).message, "`resolution`"));
}
