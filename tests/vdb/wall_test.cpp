#include "libvdbsynth/vdb/wall.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <atomic>
#include <memory>
#include <stdexcept>

using namespace vdbsynth;

namespace {

template <typename Exception>
test::Thrown converted(const Exception& exception, ErrorCode code = ErrorCode::BadData) {
    return test::thrownBy([&] { behindWall(code, "a.vdb", [&]() -> int { throw exception; }); });
}

}  // namespace

TEST_CASE("behindWall: what the work returns, references and objects that only move too", "[vdb][fast]") {
    CHECK(behindWall(ErrorCode::Io, "a", [] { return 7; }) == 7);
    int value = 1;
    behindWall(ErrorCode::Io, "a", [&]() -> int& { return value; }) = 5;
    behindWall(ErrorCode::Io, "a", [&] { ++value; });
    CHECK(value == 6);
    CHECK(*behindWall(ErrorCode::Io, "a", [] { return std::make_unique<int>(3); }) == 3);
}

TEST_CASE("behindWall: exceptions of OpenVDB and of the library get the code and begin with the name",
          "[vdb][error]") {
    const test::Thrown io = converted(openvdb::IoError("no such grid"));
    CHECK(io.code == int(ErrorCode::BadData));
    CHECK(io.message.find("a.vdb: ") == 0);
    CHECK(test::contains(io.message, "no such grid"));
    const test::Thrown standard = converted(std::runtime_error("first\nsecond"), ErrorCode::Unusable);
    CHECK(standard.code == int(ErrorCode::Unusable));
    CHECK(standard.message == "a.vdb: first second");  // one line
}

TEST_CASE("behindWall: the library's own errors pass unchanged, no memory is always Memory", "[vdb][error]") {
    const test::Thrown own = converted(Error(ErrorCode::Cancelled, "stopped"));
    CHECK(own.code == int(ErrorCode::Cancelled));
    CHECK(own.message == "stopped");
    const test::Thrown memory = converted(std::bad_alloc());
    CHECK(memory.code == int(ErrorCode::Memory));
    CHECK(memory.message.find("a.vdb: ") == 0);
    CHECK(test::contains(memory.message, "`maxMemory`"));
}

TEST_CASE("Interrupter: stops exactly while the context is cancelled", "[vdb][cancel]") {
    RunContext ctx;
    Interrupter interrupter(ctx);
    openvdb::util::NullInterrupter& base = interrupter;
    CHECK_FALSE(base.wasInterrupted());
    std::atomic<bool> cancel{false};
    ctx.cancel = &cancel;
    CHECK_FALSE(base.wasInterrupted(50));
    cancel = true;
    CHECK(base.wasInterrupted());
    CHECK(base.wasInterrupted(50));
}
