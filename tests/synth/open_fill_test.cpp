#include "libvdbsynth/synth/open_fill.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("fillOpen: a hole in what repeats comes back exactly, and known samples stay",
          "[synth][property]") {
    const auto exemplar = std::make_shared<const BrickField>(test::periodicField({32, 32, 32}, 8));
    const SynthesisPass pass{{exemplar}, {40, 40, 40}, 8, 1};
    const BrickField whole = test::periodicField({40, 40, 40}, 8);
    const IndexBox hole{{11, 13, 12}, {26, 24, 29}};
    const BrickField open =
        test::fieldFrom({40, 40, 40}, [&](const Index3& p) { return hole.contains(p) ? 1.f : 0.f; });
    BrickField field =
        test::fieldFrom({40, 40, 40}, [&](const Index3& p) { return hole.contains(p) ? 99.f : whole.at(p); });
    const PatchMap map = fillOpen(pass, {}, open, field);
    CHECK(test::samplesOf(field) == test::samplesOf(whole));
    CHECK(map.block == 8);
    // A mask without room is an error, not a guess.
    const BrickField nothing(IndexBox::fromSize({32, 32, 32}), 0.f);
    CHECK(test::thrownBy([&] { fillOpen(pass, {&nothing}, open, field); }).code == int(ErrorCode::Unusable));
    const std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { fillOpen(pass, {}, open, field, ctx); }).code == int(ErrorCode::Cancelled));
}
