#include "libvdbsynth/base/hash.h"

#include <catch2/catch.hpp>

#include <unistd.h>
#include <cstdio>
#include <fstream>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("contentHash: the empty input has XXH3's published value", "[base][oracle]") {
    CHECK(contentHash("", 0) == "99aa06d3014798d86001c324468d497f");
}

TEST_CASE("fileHash: a file hashes like its bytes, whatever its length", "[base][property]") {
    const std::string path = "/tmp/vdbsynth_hash_test." + std::to_string(::getpid());
    for (std::size_t size :
         {std::size_t(0), std::size_t(1), std::size_t(1 << 20), std::size_t((1 << 20) + 17)}) {
        const std::string bytes(size, 'x');
        std::ofstream(path, std::ios::binary) << bytes;
        CHECK(fileHash(path) == contentHash(bytes.data(), bytes.size()));
    }
    std::remove(path.c_str());
    CHECK(test::thrownBy([&] { fileHash(path); }).code == int(ErrorCode::Io));
}
