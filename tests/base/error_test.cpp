#include "libvdbsynth/base/error.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("exitCode: every code has the contract's exit code", "[base][fast]") {
    CHECK(exitCode(ErrorCode::InvalidOption) == 2);
    CHECK(exitCode(ErrorCode::Io) == 3);
    CHECK(exitCode(ErrorCode::BadData) == 3);
    CHECK(exitCode(ErrorCode::Cancelled) == 130);
    for (ErrorCode code : {ErrorCode::ShapeMismatch, ErrorCode::EmptyInput, ErrorCode::Unusable,
                           ErrorCode::Memory, ErrorCode::Solver})
        CHECK(exitCode(code) == 1);
}

TEST_CASE("requireOption: a bad value names the option, the value and the range", "[base][error]") {
    CHECK_NOTHROW(requireOption(true, "block", "16", "from 4 to 256"));
    const test::Thrown thrown = test::thrownBy([] { requireOption(false, "block", "3", "from 4 to 256"); });
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    CHECK(thrown.message == "`block` 3: must be from 4 to 256");
}
