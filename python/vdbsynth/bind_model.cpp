// vdbsynth.LevelSet: models, their files and arrays.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/grid_arrays.h"
#include "python/vdbsynth/model_arrays.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"
#include "python/vdbsynth/pyopenvdb_grids.h"

#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/convert/model_wall.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/crop/crop.h"
#include "libvdbsynth/vdb/convert/attribute_grids.h"

namespace vdbsynth::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

ArrayView viewOf(const Floats& array) {
    for (py::ssize_t axis = 0; axis < 3; ++axis)
        if (array.shape(axis) == 0 || array.shape(axis) > 1 << 20)
            throw py::value_error("`array`: must have from 1 to 1048576 voxels along each axis");
    return {array.data(), {int(array.shape(0)), int(array.shape(1)), int(array.shape(2))}};
}

// Truths and labels are no distances.
void requireReals(const py::object& array) {
    const py::array given = py::array::ensure(array);
    if (given && given.dtype().kind() != 'f')
        throw py::type_error("`array`: must be floats, signed distances, not " +
                             py::cast<std::string>(py::str(given.dtype())) +
                             "; LevelSet.from_volume takes any values");
    PyErr_Clear();
}

LevelSet fromNumpy(const py::object& array, double voxelSize, const py::object& origin,
                   const py::kwargs& given) {
    Call call;
    ArrayOptions options;
    readKeywords("LevelSet.from_numpy", given, options, call);
    requireReals(array);
    const Floats distances = floatsFrom("array", array, 3);
    const ArrayView view = viewOf(distances);
    const ArrayPlace place{voxelSize, placeFrom("origin", origin)};
    if (options.domainRecorded)
        return call.run(
            [&](const RunContext& ctx) { return textureOfArray(view, place, options.halfWidth, ctx); });
    const FloatGridPtr grid = bandOfArray(distances, place, options.halfWidth);
    return call.run([&](const RunContext& ctx) {
        return withHalfWidth(modelFromGrids("the array", {asGrid(grid)}, {}, ctx), options.halfWidth, ctx);
    });
}

LevelSet fromVolume(const py::object& array, double voxelSize, const py::object& origin,
                    const py::kwargs& given) {
    Call call;
    VolumeOptions options;
    BandOptions band;
    readKeywords("LevelSet.from_volume", given, options, band, call);
    const Floats values = floatsFrom("array", array, 3);
    const ArrayView view = viewOf(values);
    const ArrayPlace place{voxelSize, placeFrom("origin", origin)};
    return call.run(
        [&](const RunContext& ctx) { return solidOfVolume(view, place, options, band.halfWidth, ctx); });
}

// Meshes and points as loadModel makes them of files.
template <typename Shape>
LevelSet fromShape(const std::string& function, const std::shared_ptr<Shape>& shape, double voxelSize,
                   const py::kwargs& given) {
    Call call;
    SolidOptions solid;
    ShapeOptions options;
    readKeywords(function, given, options, solid, call);
    if (!(voxelSize > 0))
        throw Error(ErrorCode::InvalidOption, "`voxel_size` " + realText(voxelSize) + ": must be above 0");
    requireHalfWidth(options.halfWidth);
    return call.run([&](const RunContext& ctx) {
        LevelSet model;
        if constexpr (std::is_same_v<Shape, Mesh>)
            model.grid = meshToSolid(*shape, voxelSize, options.halfWidth, "the mesh", solid, ctx);
        else
            model.grid = pointsToSolid(*shape, voxelSize, options.halfWidth, "the points", solid, ctx);
        model.domain = solidBox(*model.grid, "the level set");
        stampLevelSet(model);
        if (options.carry) model.attributes = attributesToGrids(*shape, *model.grid, ctx);
        if constexpr (std::is_same_v<Shape, Mesh>)
            if (options.keepSource) model.source = shape;
        return model;
    });
}

LevelSet fromOpenvdb(const py::object& grids, const py::kwargs& given) {
    Call call;
    VdbReadOptions options;
    readKeywords("LevelSet.from_openvdb", given, options, call);
    std::vector<GridPtr> list;
    if (py::isinstance<py::list>(grids) || py::isinstance<py::tuple>(grids))
        list = Value<std::vector<GridPtr>>::from("grids", grids);
    else
        list.push_back(gridFrom("grids", grids));
    return call.run([&](const RunContext& ctx) { return modelFromGrids("the grid", list, options, ctx); });
}

void writeLevelSet(const LevelSet& model, const py::object& paths, const py::kwargs& given) {
    Call call;
    ModelOutputOptions options;
    readKeywords("LevelSet.write", given, options, call);
    const std::vector<std::string> all = pathsFrom("paths", paths);
    requireOutputPaths(all);
    writeOutputs(call, [&](OutputSet& outputs, const RunContext& ctx) {
        writeModel(model, all, options, outputs, ctx);
    });
}

LevelSet convertFile(const py::object& path, const py::object& outputs, const py::kwargs& given) {
    Call call;
    ConvertOptions options;
    ModelOutputOptions written;
    readKeywords("convert", given, options, written, call);
    const std::string from = textFrom("path", path);
    const std::vector<std::string> all = pathsFrom("outputs", outputs);
    requireModelPath(from);
    requireOutputPaths(all);
    validate(written);
    LevelSet model;
    writeOutputs(call, [&](OutputSet& set, const RunContext& ctx) {
        for (const std::string& one : all) set.reserve(one);
        if (written.sharp) options.keepSource = options.solid.exact = true;
        model = withHalfWidth(loadModel(from, options, ctx), options.halfWidth, ctx);
        writeModel(model, all, written, set, ctx);
    });
    return model;
}

py::object wallOf(const py::object& given, const py::kwargs& keywords) {
    Call call;
    MinimalWallOptions options;
    readKeywords("minimal_wall", keywords, options, call);
    const LevelSet model = modelFrom("model", given);
    const auto wall = call.run([&](const RunContext& ctx) { return modelWall(model, options, ctx); });
    if (!wall) return py::none();
    return py::make_tuple(wall->thickness, placeTuple(wall->place));
}

std::string shownModel(const LevelSet& self) {
    return "<vdbsynth.LevelSet of " + std::to_string(activeVoxels(*self.grid)) +
           " active voxels, voxel size " + realText(voxelSizeOf(*self.grid)) + ", domain " +
           boxText(self.domain) + (self.domainRecorded ? ", recorded>" : ">");
}

using LevelSetClass = py::class_<LevelSet, std::shared_ptr<LevelSet>>;

void defineMakers(LevelSetClass& levelSet) {
    const py::tuple zero = py::make_tuple(0.0, 0.0, 0.0);
    levelSet
        .def_static(
            "from_numpy", fromNumpy, py::arg("array"), py::arg("voxel_size") = 1.0, py::arg("origin") = zero,
            documented<ArrayOptions, Call>(
                "LevelSet.from_numpy",
                "A level set of signed distances [x, y, z] in world units, negative inside. `origin` "
                "[world] is the\n"
                "middle of element (0, 0, 0). Distances beyond the half-width are clamped, so an "
                "array that covers the\n"
                "band and the inside is enough. A solid that the array cuts is closed there and taken as a "
                "piece; a message says so.")
                .c_str())
        .def_static("from_volume", fromVolume, py::arg("array"), py::arg("voxel_size") = 1.0,
                    py::arg("origin") = zero,
                    documented<VolumeOptions, BandOptions, Call>(
                        "LevelSet.from_volume",
                        "The solid of a volume of any values [x, y, z]: where the value is above "
                        "`threshold`, below `below`, one of\n"
                        "`labels`, or the larger of only two values. The array's box is the recorded domain. "
                        "NaN is outside.")
                        .c_str())
        .def_static(
            "from_mesh",
            [](const std::shared_ptr<Mesh>& mesh, double voxelSize, const py::kwargs& given) {
                return fromShape("LevelSet.from_mesh", mesh, voxelSize, given);
            },
            py::arg("mesh"), py::arg("voxel_size"),
            documented<ShapeOptions, SolidOptions, Call>(
                "LevelSet.from_mesh", "A level set of a mesh, as read_model makes of a file.")
                .c_str())
        .def_static(
            "from_points",
            [](const std::shared_ptr<PointCloud>& points, double voxelSize, const py::kwargs& given) {
                return fromShape("LevelSet.from_points", points, voxelSize, given);
            },
            py::arg("points"), py::arg("voxel_size"),
            documented<ShapeOptions, SolidOptions, Call>(
                "LevelSet.from_points", "A level set of points, as read_model makes of a file.")
                .c_str())
        .def_static("from_openvdb", fromOpenvdb, py::arg("grids"),
                    documented<VdbReadOptions, Call>(
                        "LevelSet.from_openvdb",
                        "A model of one grid, or of a list of which one is taken: Grid or grids of "
                        "pyopenvdb, which are shared.\n"
                        "Level sets keep their tree; others are converted, as read_model does.")
                        .c_str());
}

void defineProperties(LevelSetClass& levelSet) {
    levelSet
        .def_property_readonly(
            "domain", [](const LevelSet& self) { return boxTuple(self.domain); },
            "((i, j, k), (I, J, K)): the index box that sizes and statistics refer to, both corners "
            "inclusive.")
        .def_property_readonly(
            "domainRecorded", [](const LevelSet& self) { return self.domainRecorded; },
            "False: the domain is the box of the solid.")
        .def_property_readonly(
            "attributes", [](const LevelSet& self) { return gridList(self.attributes); },
            "Other grids of the model, a list of Grid: colour, density, ...")
        .def_property_readonly(
            "source", [](const LevelSet& self) { return std::const_pointer_cast<Mesh>(self.source); },
            "The Mesh it was made from, where that was kept; else None.")
        .def_property_readonly(
            "grid", [](const LevelSet& self) { return GridObject{asGrid(self.grid)}; },
            "The level set as a Grid, shared.")
        .def_property_readonly(
            "voxel_size", [](const LevelSet& self) { return voxelSizeOf(*self.grid); },
            "[world] side of a voxel.")
        .def_property_readonly(
            "half_width", [](const LevelSet& self) { return halfWidthOf(*self.grid); },
            "[voxels] of the band.")
        .def_property_readonly("active_voxels", [](const LevelSet& self) { return activeVoxels(*self.grid); })
        .def_property_readonly(
            "transform", [](const LevelSet& self) { return arrayOf(transformOf(*self.grid)); },
            "float64 [4, 4] from index space to the world: world = transform @ (i, j, k, 1).")
        .def_property_readonly(
            "box", [](const LevelSet& self) { return boxTuple(boxOf(self)); },
            "((i, j, k), (I, J, K)): the index box of the band and the domain, which to_numpy gives.")
        .def_property_readonly(
            "origin",
            [](const LevelSet& self) { return placeTuple(placeOfVoxel(*self.grid, boxOf(self).min)); },
            "(x, y, z) world: the middle of the first voxel of `box`.")
        .def_property_readonly(
            "hash", [](const LevelSet& self) { return levelSetHash(*self.grid); },
            "Of values, active states and transform.");
}

void defineMethods(LevelSetClass& levelSet) {
    levelSet
        .def(
            "to_numpy",
            [](const LevelSet& self, const py::object& box) {
                return distancesOf(*self.grid, box.is_none() ? boxOf(self) : boxFrom("box", box));
            },
            py::arg("box") = py::none(),
            "Signed distances [world] as float32 [x, y, z], negative inside, in an index box (both corners "
            "inclusive; None:\n"
            "`box`). Beyond the band they are plus or minus the half-width.")
        .def(
            "to_openvdb", [](const LevelSet& self) { return toPyopenvdb(asGrid(self.grid)); },
            "The level set as a FloatGrid of pyopenvdb, shared: deepCopy() it before you change it.")
        .def(
            "to_mesh",
            [](const LevelSet& self, const py::kwargs& given) {
                Call call;
                MeshingOptions options;
                readKeywords("LevelSet.to_mesh", given, options, call);
                if (options.sharp) options.source = self.source.get();
                const LevelSet model = self;
                return std::make_shared<Mesh>(call.run([&](const RunContext& ctx) {
                    Mesh mesh = levelSetToMesh(*model.grid, options, ctx);
                    mesh.attributes = gridsToAttributes(model.attributes, mesh.points, mesh.origin, ctx);
                    return mesh;
                }));
            },
            documented<MeshingOptions, Call>(
                "LevelSet.to_mesh",
                "The surface as a closed Mesh, with the model's attributes at its vertices.")
                .c_str())
        .def(
            "to_points",
            [](const LevelSet& self, const py::kwargs& given) {
                Call call;
                PointOptions options;
                readKeywords("LevelSet.to_points", given, options, call);
                const LevelSet model = self;
                return std::make_shared<PointCloud>(call.run([&](const RunContext& ctx) {
                    PointCloud cloud = levelSetToPoints(*model.grid, options, ctx);
                    cloud.attributes = gridsToAttributes(model.attributes, cloud.points, cloud.origin, ctx);
                    return cloud;
                }));
            },
            documented<PointOptions, Call>(
                "LevelSet.to_points",
                "Evenly spaced points on the surface, with normals and the model's attributes.")
                .c_str())
        .def(
            "with_domain",
            [](const LevelSet& self, const py::object& domain, bool recorded) {
                return withDomain(self, boxFrom("domain", domain), recorded);
            },
            py::arg("domain"), py::arg("recorded") = true,
            "The same surface with another domain [index], both corners inclusive; recorded: a texture that "
            "continues beyond it.")
        .def(
            "with_attributes",
            [](const LevelSet& self, const py::object& grids) {
                LevelSet result = self;
                result.attributes = Value<std::vector<GridPtr>>::from("grids", grids);
                return result;
            },
            py::arg("grids"), "The same surface with these attributes, a list of Grid.")
        .def(
            "with_half_width",
            [](const LevelSet& self, double halfWidth, const py::kwargs& given) {
                Call call;
                readKeywords("LevelSet.with_half_width", given, call);
                const LevelSet model = self;
                return call.run([&](const RunContext& ctx) { return withHalfWidth(model, halfWidth, ctx); });
            },
            py::arg("half_width"),
            documented<Call>("LevelSet.with_half_width",
                             "The same surface with a band of this half-width [voxels], 1.5 to 100.")
                .c_str())
        .def("write", writeLevelSet, py::arg("paths"),
             documented<ModelOutputOptions, Call>(
                 "LevelSet.write",
                 "Writes one path or several, kinds by extension: .vdb, .obj, .ply, .stl, .off, .glb, .gltf, "
                 ".3mf, and heights as\n"
                 ".png and .exr. Outputs appear whole and together, or not at all.")
                 .c_str())
        .def("__repr__", shownModel);
}

void defineFunctions(py::module_& module) {
    module.def(
        "read_model",
        [](const py::object& path, const py::kwargs& given) {
            Call call;
            ModelOptions options;
            readKeywords("read_model", given, options, call);
            const std::string text = textFrom("path", path);
            return call.run([&](const RunContext& ctx) { return loadModel(text, options, ctx); });
        },
        py::arg("path"),
        documented<ModelOptions, Call>("read_model",
                                       "A file of any supported geometry as a level set: VDB, meshes, "
                                       "points, images, volumes (docs/formats.md).")
            .c_str());
    module.def("convert", convertFile, py::arg("path"), py::arg("outputs"),
               documented<ConvertOptions, ModelOutputOptions, Call>(
                   "convert",
                   "vdb_synth convert: reads a model with its attributes (carry is True here), writes it to "
                   "one path or several,\n"
                   "returns it.")
                   .c_str());
    module.def(
        "crop",
        [](const py::object& given, const py::object& box, const py::kwargs& keywords) {
            Call call;
            readKeywords("crop", keywords, call);
            const LevelSet model = modelFrom("model", given);
            const IndexBox part = boxFrom("box", box);
            return call.run([&](const RunContext& ctx) { return cropModel(model, part, ctx); });
        },
        py::arg("model"), py::arg("box"),
        documented<Call>("crop",
                         "The part of a model inside an index box ((i, j, k), (I, J, K)), both corners "
                         "inclusive, which becomes its\n"
                         "recorded domain.")
            .c_str());
    module.def(
        "minimal_wall", wallOf, py::arg("model"),
        documented<MinimalWallOptions, Call>(
            "minimal_wall",
            "How thin a solid gets: (thickness, (x, y, z)) in world units, or None where nothing was found.")
            .c_str());
}

}  // namespace

LevelSet modelFrom(const std::string& name, py::handle value) {
    if (!py::isinstance<LevelSet>(value)) refuse(name, "a LevelSet (read_model reads files)", value);
    return py::cast<const LevelSet&>(value);
}

std::vector<LevelSet> modelsFrom(const std::string& name, py::handle value) {
    if (py::isinstance<LevelSet>(value)) return {modelFrom(name, value)};
    std::vector<LevelSet> models;
    for (const py::object& one : elementsFrom(name, value, "a LevelSet or a list of them"))
        models.push_back(modelFrom(name, one));
    return models;
}

std::vector<const LevelSet*> pointersTo(const std::vector<LevelSet>& models) {
    std::vector<const LevelSet*> pointers;
    for (const LevelSet& model : models) pointers.push_back(&model);
    return pointers;
}

std::vector<std::string> pathsFrom(const std::string& name, py::handle value) {
    const bool list = py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
    if (!list) return {textFrom(name, value)};
    const auto paths = Value<std::vector<std::string>>::from(name, value);
    if (paths.empty())
        throw Error(ErrorCode::InvalidOption, "`" + name + "`: is empty; give at least one path");
    return paths;
}

void bindModel(py::module_& module) {
    LevelSetClass levelSet(module, "LevelSet",
                           "A model: a narrow-band level set, negative inside, with a domain. Read only: "
                           "methods return new ones.");
    defineMakers(levelSet);
    defineProperties(levelSet);
    defineMethods(levelSet);
    defineFunctions(module);
}

}  // namespace vdbsynth::python
