#include "libvdbsynth/io/readers/base64.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

std::string decoded(const std::string& text, std::size_t most = std::string::npos) {
    std::string bytes;
    decodeBase64("a.gltf", text, 0, most, bytes);
    return bytes;
}

}  // namespace

TEST_CASE("base64: padding, white space, the alphabet of addresses, an end", "[io][oracle]") {
    CHECK(decoded("") == "");
    CHECK(decoded("TWFu") == "Man");
    CHECK(decoded("TWE=") == "Ma");
    CHECK(decoded("TQ") == "M");
    CHECK(decoded("T W\r\nFu\t") == "Man");
    CHECK(decoded("+/+/") == decoded("-_-_"));
    CHECK(decoded("TWFuTWFu", 3) == "Man");
    std::string bytes;
    CHECK(decodeBase64("a.gltf", "xxTWFuTWFu", 2, 3, bytes) == 4);
    CHECK(bytes == "Man");
}

TEST_CASE("base64: other letters are an error that names the file", "[io][error]") {
    const test::Thrown thrown = test::thrownBy([] { decoded("TW*u"); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(thrown.message == "a.gltf: its base64 is invalid");
}
