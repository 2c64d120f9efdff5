// Every reader on files cut short and with bytes changed: a result or an Error, nothing else. The fuzz
// targets (tests/fuzz) look deeper; this runs every time.
#include <catch2/catch.hpp>

#include <functional>
#include <map>

#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

// Small whole files by name.
std::map<std::string, std::string> wholeFiles(const test::TemporaryFolder& folder) {
    std::map<std::string, std::string> files;
    const Mesh mesh = test::boxMesh({0, 0, 0}, {1, 2, 3});
    const std::pair<const char*, MeshFormat> formats[] = {{"a.obj", MeshFormat::Obj},
                                                          {"a.ply", MeshFormat::Ply},
                                                          {"a.stl", MeshFormat::Stl},
                                                          {"a.off", MeshFormat::Off}};
    for (const auto& [name, format] : formats) {
        writeMesh(folder.path(name), format, mesh);
        files[name] = test::contentOf(folder.path(name));
    }
    files["a.mesh"] =
        "MeshVersionFormatted 1\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles 1\n1 2 3 "
        "0\nEnd\n";
    files["a.xyz"] = "0 0 0 0 0 1\n1 0 0 0 0 1\n";
    files["a.pcd"] =
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
        "binary\n" +
        std::string(24, '\0');
    const std::vector<float> heights{0, 0.25f, 1, 0.5f};
    writeGreyPng(folder.path("a.png"), 2, 2, heights);
    files["a.png"] = test::contentOf(folder.path("a.png"));
    writeGreyExr(folder.path("a.exr"), 2, 2, heights);
    files["a.exr"] = test::contentOf(folder.path("a.exr"));
    files["a.pgm"] = test::pgm(2, 2, 255, "abcd");
    files["a.tif"] = test::tiff(2, 1, 16, 2, {"abcd", "efgh"}, "-1", {3, 3, 0});
    files["a.npy"] = test::npy("<f4", "(2, 2)", test::raw(heights));
    files["a.nii"] = test::nifti(2, 2, 1, "abcd", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    files["a.vti"] = test::vti("0 1 0 1 0 0", "", "type=\"UInt8\" format=\"binary\"", "BAAAAAABAgM=");
    files["a.sgems"] = "2 2 1\n1\nv\n1\n2\n3\n4\n";
    std::string header =
        "#INRIMAGE-4#{\nXDIM=2\nYDIM=2\nZDIM=1\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n";
    header.resize(252, '\n');
    files["a.inr"] = header + "##}\n" + test::raw(heights);
    if (!test::sample("textures/embark-1.jpg").empty())
        files["a.jpg"] = test::contentOf(test::sample("textures/embark-1.jpg"));
    return files;
}

void readAny(const std::string& path) {
    RunContext ctx;
    ctx.maxMemory = 500000000;
    if (isRasterPath(path))
        readRaster(path, ctx);
    else if (isPointPath(path) || holdsPoints(path))
        readPoints(path, ctx);
    else
        readMesh(path, ctx);
}

}  // namespace

TEST_CASE("readers: files cut short or with bytes changed give a result or an Error", "[io][property]") {
    const test::TemporaryFolder folder;
    std::size_t refusals = 0;
    for (const auto& [name, whole] : wholeFiles(folder)) {
        CAPTURE(name);
        REQUIRE(test::thrownBy([&, path = folder.write(name, whole)] { readAny(path); }).message == "");
        Random random(5, hash64(name.data(), name.size(), 0));
        for (int round = 0; round < 150; ++round) {
            std::string content = whole;
            if (round % 3 == 0) content.resize(std::size_t(random.uniform(0, double(content.size()))));
            for (int i = 0; i < round % 8 && !content.empty(); ++i)
                content[std::size_t(random.uniform(0, double(content.size())))] =
                    char(random.uniform(0, 256));
            const test::Thrown thrown =
                test::thrownBy([&, path = folder.write(name, content)] { readAny(path); });
            refusals += thrown.code >= 0;
            if (thrown.code >= 0) CHECK(test::contains(thrown.message, name));
        }
    }
    CHECK(refusals > 500);
}
