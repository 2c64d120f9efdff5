// vdbsynth.Grid: grids of any type.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/grid_arrays.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"
#include "python/vdbsynth/pyopenvdb_grids.h"

#include "libvdbsynth/vdb/vdb_file.h"

namespace vdbsynth::python {
namespace {

std::optional<IndexBox> activeBoxOrNone(const GridObject& self) {
    const IndexBox box = activeBoxOf(*self.grid);
    return box.empty() ? std::nullopt : std::optional<IndexBox>(box);
}

IndexBox wantedBox(const GridObject& self, const py::object& box) {
    if (!box.is_none()) return boxFrom("box", box);
    const std::optional<IndexBox> active = activeBoxOrNone(self);
    if (!active) throw Error(ErrorCode::EmptyInput, "the grid has no active voxels; give a box");
    return *active;
}

GridObject fromNumpy(const py::array& array, double voxelSize, const py::object& origin, double background,
                     const std::string& name) {
    const GridPtr grid = gridOfArray("array", array, {voxelSize, placeFrom("origin", origin)}, background);
    setName(*grid, name);
    return {grid};
}

py::dict summaryDict(const GridSummary& grid) {
    py::dict dict, metadata;
    for (const auto& [name, value] : grid.metadata) metadata[py::str(name)] = value;
    dict["name"] = grid.name;
    dict["type"] = grid.type;
    dict["gridClass"] = grid.gridClass;
    dict["voxelSize"] = placeTuple(grid.voxelSize);
    dict["activeVoxels"] = grid.activeVoxels;
    dict["activeBox"] =
        grid.activeBox.empty() ? py::object(py::none()) : py::object(boxTuple(grid.activeBox));
    dict["metadata"] = metadata;
    if (!grid.isFloat) return dict;
    dict["background"] = grid.background;
    dict["minimum"] = grid.minimum;
    dict["maximum"] = grid.maximum;
    dict["finite"] = grid.finite;
    return dict;
}

py::list summaries(const py::object& path, const py::kwargs& given) {
    Call call;
    readKeywords("grids", given, call);
    const std::string text = textFrom("path", path);
    const auto found =
        call.run([&](const RunContext& ctx) { return summarizeGrids(readVdb(text, ctx).grids); });
    py::list list;
    for (const GridSummary& grid : found) list.append(summaryDict(grid));
    return list;
}

py::dict metadataOf(const py::object& path, const py::kwargs& given) {
    Call call;
    readKeywords("file_metadata", given, call);
    const std::string text = textFrom("path", path);
    const VdbMetadata found = call.run([&](const RunContext& ctx) { return readVdb(text, ctx).metadata; });
    py::dict dict;
    for (const auto& [name, value] : found) dict[py::str(name)] = value;
    return dict;
}

void defineFiles(py::module_& module) {
    module.def("grids", summaries, py::arg("path"),
               documented<Call>(
                   "grids",
                   "The grids of a VDB file, one dict each: name, type, gridClass, voxelSize [world], "
                   "activeVoxels, activeBox, metadata, and of floats background, minimum, maximum, finite. "
                   "Grids of types that pyopenvdb does not know are listed too.")
                   .c_str());
    module.def("file_metadata", metadataOf, py::arg("path"),
               documented<Call>("file_metadata", "The metadata of a VDB file: a dict of str.").c_str());
    module.def(
        "read_grids",
        [](const py::object& path, const py::kwargs& given) {
            Call call;
            readKeywords("read_grids", given, call);
            const std::string text = textFrom("path", path);
            return gridList(call.run([&](const RunContext& ctx) { return readVdbGrids(text, ctx); }));
        },
        py::arg("path"), documented<Call>("read_grids", "All grids of a VDB file, a list of Grid.").c_str());
    module.def(
        "write_grids",
        [](const py::object& path, const py::object& grids, const py::object& metadata,
           const py::kwargs& given) {
            Call call;
            readKeywords("write_grids", given, call);
            const std::string text = textFrom("path", path);
            const auto list = Value<std::vector<GridPtr>>::from("grids", grids);
            const auto words = Value<VdbMetadata>::from("metadata", metadata);
            writeOutputs(call, [&](OutputSet& outputs, const RunContext&) {
                writeVdb(outputs.add(text), list, words);
            });
        },
        py::arg("path"), py::arg("grids"), py::arg("metadata") = py::dict(),
        documented<Call>("write_grids",
                         "Writes grids to a VDB file, which appears whole or not at all. Equal grids and "
                         "metadata give equal bytes.")
            .c_str());
}

}  // namespace

py::list gridList(const std::vector<GridPtr>& grids) {
    py::list list;
    for (const GridPtr& grid : grids) list.append(GridObject{grid});
    return list;
}

void bindGrid(py::module_& module) {
    py::class_<GridObject>(module, "Grid", "An OpenVDB grid of any type. Read only: methods return new ones.")
        .def_static("from_numpy", fromNumpy, py::arg("array"), py::arg("voxel_size") = 1.0,
                    py::arg("origin") = py::make_tuple(0.0, 0.0, 0.0), py::arg("background") = 0.0,
                    py::arg("name") = "",
                    "A grid of an array [x, y, z], or of vectors [x, y, z, 3]; `origin` [world] is the "
                    "middle of element\n"
                    "(0, 0, 0). float32 gives a float grid, float64 double, int32, int64, bool, vectors "
                    "vec3s. Voxels that\n"
                    "differ from the background are active.")
        .def(
            "to_numpy",
            [](const GridObject& self, const py::object& box) {
                return valuesOf(*self.grid, wantedBox(self, box));
            },
            py::arg("box") = py::none(),
            "Values in an index box (both corners inclusive; None: that of the active voxels) as an array "
            "[x, y, z], or of\n"
            "vectors [x, y, z, 3], in the grid's own type: tiles and background included.")
        .def(
            "active",
            [](const GridObject& self, const py::object& box) {
                return activeOf(*self.grid, wantedBox(self, box));
            },
            py::arg("box") = py::none(), "Which voxels of the box are active: truths [x, y, z].")
        .def_static(
            "from_openvdb",
            [](const py::object& grid) {
                GridPtr shared = fromPyopenvdb(grid);
                if (!shared) refuse("grid", "a grid of pyopenvdb", grid);
                return GridObject{shared};
            },
            py::arg("grid"),
            "A grid of pyopenvdb, which is shared, not copied: do not change it while it is in use here.")
        .def(
            "to_openvdb", [](const GridObject& self) { return toPyopenvdb(self.grid); },
            "The same grid as an object of pyopenvdb, shared: deepCopy() it before you change it. TypeError "
            "for types that\n"
            "pyopenvdb has no class for (Debian's has FloatGrid, BoolGrid and Vec3SGrid).")
        .def_property_readonly("name", [](const GridObject& self) { return nameOf(*self.grid); })
        .def_property_readonly(
            "type", [](const GridObject& self) { return typeOf(*self.grid); },
            "Of its values, as OpenVDB names it: float, vec3s, int32, ...")
        .def_property_readonly("active_voxels",
                               [](const GridObject& self) { return activeVoxelsOf(*self.grid); })
        .def_property_readonly(
            "active_box",
            [](const GridObject& self) -> py::object {
                const auto box = activeBoxOrNone(self);
                return box ? py::object(boxTuple(*box)) : py::object(py::none());
            },
            "((i, j, k), (I, J, K)) of the active voxels, both corners inclusive; None: there are none.")
        .def_property_readonly(
            "transform", [](const GridObject& self) { return arrayOf(transformOfGrid(*self.grid)); },
            "float64 [4, 4] from index space to the world: world = transform @ (i, j, k, 1).")
        .def("__repr__", [](const GridObject& self) {
            return "<vdbsynth.Grid '" + nameOf(*self.grid) + "' of " + typeOf(*self.grid) + ", " +
                   std::to_string(activeVoxelsOf(*self.grid)) + " active voxels>";
        });
    defineFiles(module);
}

}  // namespace vdbsynth::python
