#include "libvdbsynth/io/texture_box.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("textureBoxComments: by hand", "[io][oracle]") {
    TextureBox box{{-0.5, 0, 1e-3}, {63.5, 64, 21.5}, HeightPlane::XY};
    CHECK(textureBoxComments(box) ==
          std::vector<std::string>{"vdbsynth:domain -0.5,0,0.001,63.5,64,21.5", "vdbsynth:plane xy"});
    box.plane = std::nullopt;
    CHECK(textureBoxComments(box).size() == 1);
}

TEST_CASE("textureBoxOf: the same box comes back through a file", "[io][property]") {
    const test::TemporaryFolder folder;
    PointCloud cloud;
    cloud.points = {{0, 0, 0}, {1, 0, 0}};
    for (const std::optional<HeightPlane> plane :
         {std::optional<HeightPlane>(), std::optional(HeightPlane::XY), std::optional(HeightPlane::YZ),
          std::optional(HeightPlane::ZX)}) {
        const TextureBox box{{1.0 / 3, -1e9, 0.1}, {7.0 / 3, 1e9, 0.3}, plane};
        writePly(folder.path("a.ply"), cloud, textureBoxComments(box));
        const PointFile file = readPoints(folder.path("a.ply"));
        CHECK(file.comments.front() == "vdb_synth");
        for (const auto& comments : {file.comments, plyComments(folder.path("a.ply"))}) {
            const std::optional<TextureBox> read = textureBoxOf("a.ply", comments);
            REQUIRE(read);
            CHECK(length(read->low - box.low) == 0);
            CHECK(length(read->high - box.high) == 0);
            CHECK(read->plane == plane);
        }
    }
}

TEST_CASE("textureBoxOf: none, several, and comments of other kinds", "[io]") {
    CHECK_FALSE(textureBoxOf("a", {}));
    CHECK_FALSE(textureBoxOf("a", {"vdb_synth", "vdbsynth:domains 1", "vdbsynth:plane xy", ""}));
    const auto last = textureBoxOf("a", {"vdbsynth:domain 0,0,0,1,1,1", "vdbsynth:domain 0,0,0,2,2,2"});
    REQUIRE(last);
    CHECK(last->high.x == 2);
}

TEST_CASE("textureBoxOf: each error", "[io][error]") {
    const auto fails = [](const std::string& comment, const std::string& says) {
        const test::Thrown thrown = test::thrownBy([&] { textureBoxOf("a.ply", {comment}); });
        INFO(comment << " gave " << thrown.message);
        CHECK(thrown.code == int(ErrorCode::BadData));
        CHECK(test::contains(thrown.message, "a.ply: its comment"));
        CHECK(test::contains(thrown.message, says));
    };
    for (const char* numbers : {"", "1,2,3", "0,0,0,1,1,1,1", "0,0,0,1,1,nan", "0,0,0,1,1,x", "0,0,0,1,1,"})
        fails(std::string("vdbsynth:domain ") + numbers, "six numbers");
    fails("vdbsynth:domain 0,0,0,1,0,1", "a lower and a higher corner");
    fails("vdbsynth:domain 2,0,0,1,1,1", "a lower and a higher corner");
    fails("vdbsynth:plane xz", "a plane xy, yz or zx");
}
