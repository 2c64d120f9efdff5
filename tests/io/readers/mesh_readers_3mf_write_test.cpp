#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/package/zip_file.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

void append(Mesh& mesh, const Mesh& part, bool inward) {
    const std::uint32_t first = std::uint32_t(mesh.points.size());
    mesh.points.insert(mesh.points.end(), part.points.begin(), part.points.end());
    for (const Triangle& t : triangulated(part))
        mesh.triangles.push_back(inward ? Triangle{t[0] + first, t[2] + first, t[1] + first}
                                        : Triangle{t[0] + first, t[1] + first, t[2] + first});
}

std::string modelOf(const std::string& bytes) {
    const std::string path = "a.3mf";
    const ZipFile zip(path, bytes);
    REQUIRE(zip.find("[Content_Types].xml"));
    REQUIRE(zip.find("_rels/.rels"));
    return zip.read(*zip.find("3D/3dmodel.model"), {});
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

Mesh written(const Mesh& mesh) {
    const test::TemporaryFolder folder;
    writeMesh(folder.path("a.3mf"), MeshFormat::ThreeMf, mesh);
    return readMesh(folder.path("a.3mf"));
}

}  // namespace

TEST_CASE("3MF: a triangle with quads beside it is written in millimetres, row by row", "[io][fast]") {
    const std::string model = modelOf(threemfBytes(test::boxMesh({0, 0, 0}, {1, 2, 0.5f})));
    CHECK(test::contains(model, "unit=\"millimeter\""));
    CHECK(test::contains(model, "<object id=\"2\" type=\"model\"><mesh>"));
    CHECK(test::contains(model, "<vertex x=\"1\" y=\"2\" z=\"0.5\"/>"));
    CHECK(test::contains(model, "<item objectid=\"2\"/>"));
    CHECK(count(model, "<vertex ") == 8);
    CHECK(count(model, "<triangle ") == 12);
    CHECK_FALSE(test::contains(model, "colorgroup"));
}

TEST_CASE("3MF: each solid is an object, with its cavities, and a solid in a cavity is its own",
          "[io][fast]") {
    Mesh mesh;
    append(mesh, test::boxMesh({0, 0, 0}, {9, 9, 9}), false);
    append(mesh, test::boxMesh({20, 0, 0}, {21, 1, 1}), false);
    append(mesh, test::boxMesh({1, 1, 1}, {8, 8, 8}), true);
    append(mesh, test::boxMesh({2, 2, 2}, {3, 3, 3}), false);
    const std::string model = modelOf(threemfBytes(mesh));
    CHECK(count(model, "<mesh>") == 3);
    CHECK(count(model, "<component ") == 3);
    CHECK(test::contains(model, "<item objectid=\"5\"/>"));
    const std::string first = model.substr(0, model.find("id=\"3\""));
    CHECK(count(first, "<triangle ") == 24);
    const Mesh back = written(mesh);
    CHECK(summarize(back).signedVolume == Approx(summarize(mesh).signedVolume));
    CHECK(summarize(back).closedManifold());
}

TEST_CASE("3MF: floats, colours and opacity come back, places far from zero too", "[io][property]") {
    Mesh mesh = test::sphereMesh(1.7, 4);
    Attribute colour{"Cd", 3, {}}, alpha{"Alpha", 1, {}}, heat{"heat", 1, {}};
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        colour.values.insert(colour.values.end(), {float(i % 256) / 255, 0.2f, 1.f});
        alpha.values.push_back(0.4f);
        heat.values.push_back(float(i));
    }
    mesh.attributes = {colour, alpha, heat};
    const Mesh back = written(mesh);
    REQUIRE(back.points.size() == mesh.points.size());
    CHECK(back.triangles == mesh.triangles);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) CHECK(length(back.points[i] - mesh.points[i]) == 0);
    CHECK(findAttribute(back.attributes, "Cd")->values == colour.values);
    CHECK(findAttribute(back.attributes, "Alpha")->values == alpha.values);
    CHECK(back.attributes.size() == 2);
    CHECK(lostIn3mf(mesh) == "heat");
    mesh.attributes[0].values[0] = 3;
    CHECK(lostIn3mf(mesh) == "Cd, Alpha, heat");
    CHECK(written(mesh).attributes.empty());

    mesh.attributes.clear();
    mesh.origin = {4.5e6, -5e6, 100};
    const Mesh far = written(mesh);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec3d a = far.origin + cast<double>(far.points[i]),
                    b = mesh.origin + cast<double>(mesh.points[i]);
        CHECK(length(a - b) < 1e-6);
    }
}

TEST_CASE("3MF: vertices at one place are welded and keep the colours of their corners", "[io][fast]") {
    // Two sides of a box's edge with two colours: split for them, as readers do.
    Mesh mesh;
    append(mesh, test::boxMesh({0, 0, 0}, {1, 1, 1}), false);
    const std::uint32_t first = std::uint32_t(mesh.points.size());
    for (std::uint32_t i = 0; i < first; ++i) mesh.points.push_back(Vec3f(mesh.points[i]));
    for (std::uint32_t& v : mesh.triangles[0]) v += first;
    Attribute colour{"Cd", 3, {}};
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        colour.values.insert(colour.values.end(), {i < first ? 1.f : 0.f, 0.f, 0.f});
    mesh.attributes = {colour};
    const std::string model = modelOf(threemfBytes(mesh));
    CHECK(count(model, "<vertex ") == 8);
    CHECK(count(model, "<m:color ") == 2);
    CHECK(test::contains(model, "<m:color color=\"#FF0000FF\"/>"));
    const Mesh back = written(mesh);
    CHECK(back.points.size() == 11);
    CHECK(findAttribute(back.attributes, "Cd")->values[3 * back.triangles[0][0]] == 0);
    CHECK(findAttribute(back.attributes, "Cd")->values[3 * back.triangles[1][0]] == 1);
}

TEST_CASE("3MF: many rows in several pieces, the same bytes for any number of threads", "[io][determinism]") {
    // A sheet of more rows than a piece has.
    constexpr std::uint32_t kSide = 300;
    Mesh mesh;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
        mesh.points.push_back({float(i % kSide), float(i / kSide), float(i % 7)});
    for (std::uint32_t i = 0; i + kSide + 1 < kSide * kSide; ++i)
        if (i % kSide + 1 < kSide) mesh.triangles.push_back({i, i + 1, i + kSide + 1});
    const auto bytes = [&](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        return withThreads(ctx, [&] { return threemfBytes(mesh); });
    };
    const std::string one = bytes(1);
    CHECK(bytes(4) == one);
    // The corner that no triangle uses is left out; the others keep their order.
    CHECK(written(mesh).triangles.size() == mesh.triangles.size());
    CHECK(written(mesh).points.size() == kSide * kSide - 1);
}
