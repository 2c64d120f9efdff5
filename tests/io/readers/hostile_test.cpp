// Every reader on files cut short and with bytes changed: a result or an Error, nothing else. The fuzz
// targets (tests/fuzz) look deeper; this runs every time.
#include <catch2/catch.hpp>

#include <map>

#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/comma_locale.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/whole_files.h"

using namespace vdbsynth;

namespace {

void readAny(const std::string& path) {
    RunContext ctx;
    ctx.maxMemory = 500000000;
    if (isRasterPath(path))
        readRaster(path, {}, ctx);
    else if (isPointPath(path) || holdsPoints(path))
        readPoints(path, ctx);
    else
        readMesh(path, ctx);
}

}  // namespace

TEST_CASE("readers: files cut short or with bytes changed give a result or an Error", "[io][property]") {
    const test::TemporaryFolder folder;
    std::size_t refusals = 0;
    for (const auto& [name, whole] : test::wholeFiles(folder)) {
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

namespace {

// Numbers that a decimal comma or dots between thousands would change.
Mesh oddMesh() {
    Mesh mesh = test::boxMesh({-1234.5f, 0.1f, 1e-7f}, {1e7f, 2000.25f, 3.75f});
    Attribute colour{"Cd", 3, {}};
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        colour.values.insert(colour.values.end(), {0.5f, 0.25f, 1.f});
    mesh.attributes = {colour};
    return mesh;
}

// Everything that is read from a file, as numbers.
std::vector<float> numbersOf(const std::string& path) {
    std::vector<float> numbers;
    const auto add = [&](const std::vector<Vec3f>& points) {
        for (const Vec3f& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    };
    if (isRasterPath(path)) {
        const Raster raster = readRaster(path);
        numbers = raster.values;
        numbers.push_back(float(raster.spacing.x));
    } else if (isPointPath(path) || holdsPoints(path)) {
        add(readPoints(path).cloud.points);
    } else {
        const Mesh mesh = readMesh(path);
        add(mesh.points);
        for (const Attribute& attribute : mesh.attributes)
            numbers.insert(numbers.end(), attribute.values.begin(), attribute.values.end());
    }
    return numbers;
}

}  // namespace

TEST_CASE("files: a host with a decimal comma writes the same bytes and reads the same numbers",
          "[io][property]") {
    const test::TemporaryFolder folder;
    std::map<std::string, std::string> files = test::wholeFiles(folder);
    files["b.obj"] =
        "v 0.5 1.25 1e-3 0.1 0.2 0.3\nv 1 0 0 0.1 0.2 0.3\nv 0 1 0 0.1 0.2 0.3\nvt 0.5 0.25\nf 1/1 2/1 3/1\n";
    files["b.pcd"] =
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n0.5 1.5 "
        "-2.25\n";
    files["b.xyz"] = "0.5 1234.5 -2.25\n";
    files["b.vti"] = test::vti("0 1 0 1 0 0", "Spacing=\"0.5 0.5 0.5\"", "type=\"Float32\" format=\"ascii\"",
                               "0.5 1.5 2.5 3.5");
    const std::pair<const char*, MeshFormat> formats[] = {
        {"w.obj", MeshFormat::Obj},    {"w.ply", MeshFormat::Ply}, {"w.stl", MeshFormat::Stl},
        {"w.off", MeshFormat::Off},    {"w.glb", MeshFormat::Glb}, {"w.gltf", MeshFormat::Gltf},
        {"w.3mf", MeshFormat::ThreeMf}};
    for (const auto& [name, format] : formats) {
        writeMesh(folder.path(name), format, oddMesh());
        files[name] = test::contentOf(folder.path(name));
    }
    std::map<std::string, std::vector<float>> expected;
    for (const auto& [name, content] : files) expected[name] = numbersOf(folder.write(name, content));

    const test::CommaLocale host;
    if (!host.changesC()) WARN("no C locale with a decimal comma could be made here: only C++'s is tested");
    for (const auto& [name, format] : formats) {
        CAPTURE(name);
        writeMesh(folder.path(name), format, oddMesh());
        CHECK(test::contentOf(folder.path(name)) == files[name]);
    }
    for (const auto& [name, numbers] : expected) {
        CAPTURE(name);
        CHECK_FALSE(numbers.empty());
        CHECK(numbersOf(folder.path(name)) == numbers);
    }
}
