// vdbsynth.Mesh and vdbsynth.PointCloud, and their files.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/option_keywords.h"

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/textured_mesh.h"

#include <algorithm>

namespace vdbsynth::python {
namespace {

Mesh meshFrom(const py::object& points, const py::object& triangles, const py::object& quads,
              const py::object& attributes, const py::object& origin) {
    Mesh mesh;
    mesh.points = rowsFrom("points", points);
    mesh.origin = placeFrom("origin", origin);
    const std::size_t count = mesh.points.size();
    if (!triangles.is_none()) {
        const auto indices = indicesFrom("triangles", triangles, 3, count);
        for (std::size_t i = 0; i < indices.size(); i += 3)
            mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    if (!quads.is_none()) {
        const auto indices = indicesFrom("quads", quads, 4, count);
        for (std::size_t i = 0; i < indices.size(); i += 4)
            mesh.quads.push_back({indices[i], indices[i + 1], indices[i + 2], indices[i + 3]});
    }
    mesh.attributes = attributesFrom("attributes", attributes, count);
    return mesh;
}

PointCloud cloudFrom(const py::object& points, const py::object& normals, const py::object& attributes,
                     const py::object& origin) {
    PointCloud cloud;
    cloud.points = rowsFrom("points", points);
    if (!normals.is_none()) cloud.normals = rowsFrom("normals", normals);
    if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size())
        throw py::value_error("`normals`: must be one for each of the " +
                              std::to_string(cloud.points.size()) + " points, not " +
                              std::to_string(cloud.normals.size()));
    cloud.attributes = attributesFrom("attributes", attributes, cloud.points.size());
    cloud.origin = placeFrom("origin", origin);
    return cloud;
}

void writeOneMesh(const Mesh& mesh, const py::object& path, const py::kwargs& given) {
    Call call;
    readKeywords("Mesh.write", given, call);
    const std::string text = textFrom("path", path);
    MeshFormat format{};
    if (!writableMeshFormatOf(text, format))
        throw Error(ErrorCode::InvalidOption,
                    text + ": must end in .obj, .ply, .stl, .off, .glb, .gltf or .3mf");
    writeOutputs(call,
                 [&](OutputSet& outputs, const RunContext&) { writeMesh(outputs.add(text), format, mesh); });
}

void writeCloud(const PointCloud& cloud, const py::object& path, const py::list& comments,
                const py::kwargs& given) {
    Call call;
    readKeywords("PointCloud.write", given, call);
    const std::string text = textFrom("path", path);
    const auto lines = Value<std::vector<std::string>>::from("comments", comments);
    if (text.size() < 4 || text.substr(text.size() - 4) != ".ply")
        throw Error(ErrorCode::InvalidOption, text + ": points are written as .ply");
    writeOutputs(call,
                 [&](OutputSet& outputs, const RunContext&) { writePly(outputs.add(text), cloud, lines); });
}

void bindMesh(py::module_& module) {
    py::class_<Mesh, std::shared_ptr<Mesh>>(
        module, "Mesh", "A mesh of triangles and quads, counter-clockwise seen from outside. Read only.")
        .def(py::init(&meshFrom), py::arg("points"), py::arg("triangles") = py::none(),
             py::arg("quads") = py::none(), py::arg("attributes") = py::none(),
             py::arg("origin") = py::make_tuple(0.0, 0.0, 0.0),
             "points: [vertices, 3] world, relative to `origin`; triangles [n, 3] and quads [n, 4] are "
             "numbers of vertices;\n"
             "attributes: a dict of arrays [vertices] or [vertices, 1 to 3]; colours are 'Cd' (0 to 1), "
             "texture coordinates 'uv'.")
        .def_property_readonly(
            "points", [](const Mesh& self) { return arrayOf(self.points); },
            "float32 [vertices, 3], world, relative to `origin`.")
        .def_property_readonly(
            "triangles", [](const Mesh& self) { return arrayOf(self.triangles); }, "uint32 [triangles, 3].")
        .def_property_readonly(
            "quads", [](const Mesh& self) { return arrayOf(self.quads); }, "uint32 [quads, 4].")
        .def_property_readonly(
            "attributes", [](const Mesh& self) { return dictOf(self.attributes); },
            "A dict of float32 arrays [vertices] or [vertices, width].")
        .def_property_readonly(
            "origin", [](const Mesh& self) { return placeTuple(self.origin); },
            "(x, y, z) world: zero, but where coordinates are too large for floats.")
        .def("write", writeOneMesh, py::arg("path"),
             documented<Call>(
                 "Mesh.write",
                 "Writes .obj, .ply, .stl, .off, .glb, .gltf or .3mf, which appears whole or not at all.")
                 .c_str())
        .def("__repr__", [](const Mesh& self) {
            return "<vdbsynth.Mesh of " + std::to_string(self.points.size()) + " vertices, " +
                   std::to_string(self.faceCount()) + " faces>";
        });
    module.def(
        "read_mesh",
        [](const py::object& path, const py::kwargs& given) {
            Call call;
            readKeywords("read_mesh", given, call);
            const std::string text = textFrom("path", path);
            return std::make_shared<Mesh>(
                call.run([&](const RunContext& ctx) { return readMesh(text, ctx); }));
        },
        py::arg("path"),
        documented<Call>(
            "read_mesh",
            "A mesh file as it is: .obj, .ply, .stl, .off, .glb, .gltf, .3mf, .mesh, each also with .gz.")
            .c_str());
}

void bindPoints(py::module_& module) {
    py::class_<PointCloud, std::shared_ptr<PointCloud>>(
        module, "PointCloud", "Points with normals that face out of the solid. Read only.")
        .def(py::init(&cloudFrom), py::arg("points"), py::arg("normals") = py::none(),
             py::arg("attributes") = py::none(), py::arg("origin") = py::make_tuple(0.0, 0.0, 0.0),
             "points and normals: [points, 3] world, points relative to `origin`; attributes as of Mesh.")
        .def_property_readonly(
            "points", [](const PointCloud& self) { return arrayOf(self.points); },
            "float32 [points, 3], world, relative to `origin`.")
        .def_property_readonly(
            "normals", [](const PointCloud& self) { return arrayOf(self.normals); },
            "float32 [points, 3], or [0, 3]: unknown.")
        .def_property_readonly(
            "attributes", [](const PointCloud& self) { return dictOf(self.attributes); },
            "A dict of float32 arrays [points] or [points, width].")
        .def_property_readonly(
            "origin", [](const PointCloud& self) { return placeTuple(self.origin); }, "(x, y, z) world.")
        .def("write", writeCloud, py::arg("path"), py::arg("comments") = py::list(),
             documented<Call>(
                 "PointCloud.write",
                 "Writes .ply, which appears whole or not at all; comments are lines of its header.")
                 .c_str())
        .def("__repr__", [](const PointCloud& self) {
            return "<vdbsynth.PointCloud of " + std::to_string(self.points.size()) + " points>";
        });
    module.def(
        "read_points",
        [](const py::object& path, const py::kwargs& given) {
            Call call;
            readKeywords("read_points", given, call);
            const std::string text = textFrom("path", path);
            return std::make_shared<PointCloud>(call.run([&](const RunContext& ctx) {
                PointFile file = readPoints(text, ctx);
                if (file.invalid > 0)
                    message(ctx, MessageLevel::Note,
                            text + ": " + std::to_string(file.invalid) +
                                " points without finite coordinates left out");
                return std::move(file.cloud);
            }));
        },
        py::arg("path"),
        documented<Call>(
            "read_points",
            "A file of points as it is: .ply, .xyz, .pcd, .npy and others; docs/formats.md lists them.")
            .c_str());
}

}  // namespace

void bindShapes(py::module_& module) {
    bindMesh(module);
    bindPoints(module);
}

}  // namespace vdbsynth::python
