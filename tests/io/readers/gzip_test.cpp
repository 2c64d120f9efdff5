#include "libvdbsynth/io/readers/gzip.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <string>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// Content as the gzip program packs it.
std::string packed(const test::TemporaryFolder& folder, const std::string& content) {
    const std::string path = folder.write("raw", content);
    REQUIRE(std::system(("gzip -k -f " + path).c_str()) == 0);
    return test::contentOf(path + ".gz");
}

}  // namespace

TEST_CASE("gunzip: gives back what gzip packed, several members and padding too", "[io][oracle]") {
    const test::TemporaryFolder folder;
    std::string content;
    for (int i = 0; i < 200000; ++i) content += char('a' + (i * i) % 26);
    const std::string gz = packed(folder, content);
    CHECK(isGzip(gz));
    CHECK_FALSE(isGzip(content));
    CHECK_FALSE(isGzip(""));
    CHECK(gunzip("x", gz) == content);
    CHECK(gunzip("x", gz + gz) == content + content);
    CHECK(gunzip("x", gz + std::string(512, '\0')) == content);
    CHECK(gunzip("x", packed(folder, "")).empty());
}

TEST_CASE("gunzip: truncated and corrupt files are named", "[io][error]") {
    const test::TemporaryFolder folder;
    const std::string gz = packed(folder, std::string(100000, 'x') + "yz");
    for (std::size_t length : {std::size_t(3), std::size_t(11), gz.size() / 2, gz.size() - 1})
        CHECK(test::contains(test::thrownBy([&] { gunzip("a.gz", gz.substr(0, length)); }).message,
                             "a.gz: the gzip file is truncated"));
    std::string bad = gz;
    bad[gz.size() / 2] ^= 0x55;
    CHECK(test::thrownBy([&] { gunzip("a.gz", bad); }).code == int(ErrorCode::BadData));
}

TEST_CASE("readMesh: a packed mesh is the mesh, by its inner extension", "[io][property]") {
    const test::TemporaryFolder folder;
    const Mesh mesh = test::sphereMesh(1, 2);
    writeMesh(folder.path("a.off"), MeshFormat::Off, mesh);
    REQUIRE(std::system(("gzip -k " + folder.path("a.off")).c_str()) == 0);
    CHECK(readMesh(folder.path("a.off.gz")).points.size() == mesh.points.size());
    CHECK(readExtensionOf("b/a.OFF.GZ") == "off");
    CHECK(readExtensionOf("a.gz").empty());
    MeshFormat format{};
    CHECK(meshFormatOf("a.ply.gz", format));
    CHECK_FALSE(writableMeshFormatOf("a.ply.gz", format));
    CHECK_FALSE(writableMeshFormatOf("a.mesh", format));
}
