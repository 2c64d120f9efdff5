// Geometry textures, patch by patch: sheets, over models, into holes.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"

#include "libvdbsynth/pipeline/patch/patch.h"
#include "libvdbsynth/pipeline/patch/patch_hole.h"
#include "libvdbsynth/pipeline/patch/patch_map.h"
#include "libvdbsynth/pipeline/patch/patch_onto_map.h"

#include <pybind11/stl.h>

namespace vdbsynth::python {
namespace {

using SourcePtr = std::shared_ptr<PatchSource>;

/// vdbsynth.PatchSheet: a sheet, and the exemplar that its points copy.
struct SheetObject {
    SourcePtr source;
    PatchOptions options;
    PatchSheet sheet;
};
/// vdbsynth.PatchedModel: an exemplar over a model.
struct OntoObject {
    SourcePtr source;
    PatchOntoOptions options;
    PatchedModel patched;
};
/// vdbsynth.RepairedSheet: a sheet whose hole was filled.
struct RepairObject {
    SourcePtr source;
    RepairedSheet repaired;
};

std::shared_ptr<PointCloud> shared(PointCloud cloud) {
    return std::make_shared<PointCloud>(std::move(cloud));
}

double sideOr(double voxelSize, double own) {
    if (voxelSize < 0 || !(voxelSize - voxelSize == 0))
        throw Error(ErrorCode::InvalidOption,
                    "`voxel_size` " + realText(voxelSize) + ": must be above 0, or 0: the exemplar's");
    return voxelSize > 0 ? voxelSize : own;
}

// The level set of points, with what they carry.
template <typename Make>
LevelSet carried(Call& call, const PointCloud& cloud, const Make& make) {
    return call.run([&](const RunContext& ctx) {
        LevelSet model = make(ctx);
        carryAttributes(cloud, model, ctx);
        return model;
    });
}

LevelSet sheetModel(const SheetObject& self, double voxelSize, const py::kwargs& given) {
    Call call;
    BandOptions band;
    readKeywords("PatchSheet.level_set", given, band, call);
    const double side = sideOr(voxelSize, self.source->voxelSize);
    return carried(call, sheetCloud(*self.source, self.sheet), [&](const RunContext& ctx) {
        return sheetLevelSet(*self.source, self.sheet, side, band.halfWidth, ctx);
    });
}

LevelSet repairModel(const RepairObject& self, double voxelSize, const py::kwargs& given) {
    Call call;
    BandOptions band;
    readKeywords("RepairedSheet.level_set", given, band, call);
    const double side = sideOr(voxelSize, self.source->voxelSize);
    return carried(call, self.repaired.cloud, [&](const RunContext& ctx) {
        return sheetLevelSet(*self.source, self.repaired.sheet, side, band.halfWidth, ctx);
    });
}

LevelSet ontoModel(const OntoObject& self, double voxelSize, const py::object& with,
                   const py::kwargs& given) {
    Call call;
    BandOptions band;
    readKeywords("PatchedModel.level_set", given, band, call);
    const double side = sideOr(voxelSize, self.source->voxelSize * self.options.onto.scale);
    std::optional<LevelSet> united;
    if (!with.is_none()) united = modelFrom("with_model", with);
    return carried(call, ontoCloud(*self.source, self.patched), [&](const RunContext& ctx) {
        return ontoLevelSet(self.patched, side, band.halfWidth, united ? &*united : nullptr, ctx);
    });
}

SheetObject patch(const SourcePtr& source, const py::kwargs& given) {
    Call call;
    SheetObject made{source, {}, {}};
    readKeywords("patch", given, made.options, call);
    for (const auto& [name, side] :
         {std::pair<const char*, double>{"width", made.options.width}, {"depth", made.options.depth}})
        if (!(side > 0))
            throw Error(ErrorCode::InvalidOption,
                        "`" + std::string(name) + "` " + realText(side) +
                            ": must be above 0 [world], for example 4 * source.size[0]");
    made.sheet = call.run([&](const RunContext& ctx) { return makePatchSheet(*source, made.options, ctx); });
    return made;
}

OntoObject patchModel(const SourcePtr& source, const py::object& given, const py::kwargs& keywords) {
    Call call;
    OntoObject made{source, {}, {}};
    readKeywords("patch_onto", keywords, made.options, call);
    const LevelSet model = modelFrom("model", given);
    made.patched =
        call.run([&](const RunContext& ctx) { return patchOnto(*source, model, made.options, ctx); });
    return made;
}

LevelSet readOntoModel(const py::object& path, const SourcePtr& source, const py::kwargs& given) {
    Call call;
    PatchOntoOptions options;
    readKeywords("read_onto_model", given, options, call);
    const std::string text = textFrom("path", path);
    return call.run([&](const RunContext& ctx) { return loadOntoModel(text, *source, options, ctx); });
}

RepairObject patchHole(const SourcePtr& sheet, const py::object& hole,
                       const std::optional<SourcePtr>& exemplar, const py::kwargs& given) {
    Call call;
    PatchOptions options;
    options.width = options.depth = 1;  // not read
    readKeywords("patch_hole", given, options, call);
    std::optional<LevelSet> inside;
    std::optional<PatchBox> box;
    if (py::isinstance<LevelSet>(hole)) {
        inside = modelFrom("hole", hole);
    } else {
        const auto corners = elementsFrom("hole", hole, "a LevelSet, or two corners [world]");
        if (corners.size() != 2) refuse("hole", "a LevelSet, or two corners [world]", hole);
        box = PatchBox{placeFrom("hole", corners[0]), placeFrom("hole", corners[1])};
    }
    RepairObject made{sheet, {}};
    made.repaired = call.run([&](const RunContext& ctx) {
        const double step = repairStep(sheet->exemplar, options);
        const auto columns =
            box ? holeColumns(*sheet, *box, step, ctx) : holeColumns(*sheet, *inside, step, ctx);
        return repairSheet(*sheet, columns, exemplar ? exemplar->get() : nullptr, options, ctx);
    });
    return made;
}

// The exemplar must be read with the map's box and plane, so that is done here.
py::object repeatPatch(const py::object& mapPath, const py::object& path, const py::kwargs& given) {
    Call call;
    PatchSourceOptions options;
    readKeywords("repeat_patch", given, options, call);
    const std::string map = textFrom("map", mapPath), from = textFrom("exemplar", path);
    std::optional<SheetObject> sheet;
    std::optional<OntoObject> onto;
    call.run([&](const RunContext& ctx) {
        const auto grids = readVdbGrids(map, ctx);
        const auto load = [&](const PatchBox& box, PatchPlane plane) {
            options.box = box;
            options.plane = plane;
            return std::make_shared<PatchSource>(loadPatchSource(from, options, ctx));
        };
        if (const auto flat = patchMapFrom(map, grids)) {
            sheet = SheetObject{load(flat->box, flat->plane), flat->options, {}};
            sheet->sheet = repeatPatchSheet(*sheet->source, *flat, ctx);
        } else if (const auto over = patchOntoMapFrom(map, grids)) {
            onto = OntoObject{load(over->box, over->plane), {}, {}};
            onto->options.onto = over->options;
            onto->patched = repeatPatchOnto(*onto->source, *over, ctx);
        } else {
            throw Error(ErrorCode::BadData, map + ": has no map of patches; PatchSheet.map_grids gives one");
        }
    });
    return sheet ? py::cast(*sheet) : py::cast(*onto);
}

void bindSheets(py::module_& module) {
    py::class_<SheetObject>(module, "PatchSheet", "A sheet of a geometry texture.")
        .def_property_readonly(
            "width", [](const SheetObject& self) { return self.sheet.width; }, "[world]")
        .def_property_readonly(
            "depth", [](const SheetObject& self) { return self.sheet.depth; }, "[world]")
        .def_property_readonly(
            "patches", [](const SheetObject& self) { return self.sheet.result.patches; },
            "Number of patches.")
        .def_property_readonly(
            "patch", [](const SheetObject& self) { return self.sheet.result.patch; },
            "[world] side of a patch.")
        .def(
            "points", [](const SheetObject& self) { return shared(sheetCloud(*self.source, self.sheet)); },
            "Its points as a PointCloud: normals, the exemplar's attributes, `patch` and `source`.")
        .def("level_set", sheetModel, py::arg("voxel_size") = 0.0,
             documented<BandOptions, Call>(
                 "PatchSheet.level_set",
                 "The solid below, or within, its points; voxel_size [world], 0: the exemplar's.")
                 .c_str())
        .def(
            "map_grids",
            [](const SheetObject& self) {
                return gridList({patchMapGrid(*self.source, self.sheet, self.options)});
            },
            "Its source map, for write_grids and repeat_patch: a list of Grid.");
    py::class_<RepairObject>(module, "RepairedSheet", "A sheet whose hole was filled.")
        .def_property_readonly(
            "kept", [](const RepairObject& self) { return self.repaired.repair.kept.size(); },
            "Points that were not touched.")
        .def_property_readonly(
            "removed", [](const RepairObject& self) { return self.repaired.repair.removed; },
            "Points that lay in the hole.")
        .def_property_readonly(
            "patches", [](const RepairObject& self) { return self.repaired.repair.patches; },
            "Patches laid into the hole.")
        .def(
            "points", [](const RepairObject& self) { return shared(self.repaired.cloud); },
            "All points: those that stay first, in their order.")
        .def("level_set", repairModel, py::arg("voxel_size") = 0.0,
             documented<BandOptions, Call>(
                 "RepairedSheet.level_set",
                 "The solid below, or within, its points; voxel_size [world], 0: the sheet's.")
                 .c_str());
    py::class_<OntoObject>(module, "PatchedModel", "A geometry texture over a model, which is no part of it.")
        .def_property_readonly(
            "patches", [](const OntoObject& self) { return self.patched.result.patches; },
            "Number of patches.")
        .def_property_readonly(
            "patch", [](const OntoObject& self) { return self.patched.result.patch; },
            "[world] diameter of a patch.")
        .def(
            "points", [](const OntoObject& self) { return shared(ontoCloud(*self.source, self.patched)); },
            "Its points as a PointCloud: normals, the exemplar's attributes, `patch` and `source`.")
        .def("level_set", ontoModel, py::arg("voxel_size") = 0.0, py::arg("with_model") = py::none(),
             documented<BandOptions, Call>("PatchedModel.level_set",
                                           "The solid that its points bound, united with with_model "
                                           "(LevelSet) if given; voxel_size [world], 0: the exemplar's.")
                 .c_str())
        .def(
            "map_grids",
            [](const OntoObject& self) {
                return gridList(patchOntoMapGrids(*self.source, self.patched, self.options));
            },
            "Its source map, for write_grids and repeat_patch: a list of Grid.");
}

void bindFunctions(py::module_& module) {
    module.def(
        "read_patch_source",
        [](const py::object& path, const py::kwargs& given) {
            Call call;
            PatchSourceOptions options;
            readKeywords("read_patch_source", given, options, call);
            const std::string text = textFrom("path", path);
            return std::make_shared<PatchSource>(
                call.run([&](const RunContext& ctx) { return loadPatchSource(text, options, ctx); }));
        },
        py::arg("path"),
        documented<PatchSourceOptions, Call>(
            "read_patch_source",
            "A file as a geometry texture: points, or any model, of which points are made. A PatchSource.")
            .c_str());
    module.def("patch", patch, py::arg("source"),
               documented<PatchOptions, Call>(
                   "patch", "A larger sheet of a geometry texture: a PatchSheet. width and depth are needed.")
                   .c_str());
    module.def("read_onto_model", readOntoModel, py::arg("path"), py::arg("source"),
               documented<PatchOntoOptions, Call>(
                   "read_onto_model",
                   "A model to lay an exemplar over, as a LevelSet of voxels half a field step wide.")
                   .c_str());
    module.def("patch_onto", patchModel, py::arg("source"), py::arg("model"),
               documented<PatchOntoOptions, Call>("patch_onto",
                                                  "Lays a geometry texture over a model: a PatchedModel.")
                   .c_str());
    module.def("patch_hole", patchHole, py::arg("sheet"), py::arg("hole"), py::arg("exemplar") = py::none(),
               documented<PatchOptions, Call>(
                   "patch_hole",
                   "Fills a hole of a sheet (read_patch_source with whole=True) with patches of the rest of "
                   "it, or of an exemplar. hole: a\n"
                   "LevelSet, or two corners ((x, y, z), (X, Y, Z)) [world]. A RepairedSheet.")
                   .c_str());
    module.def(
        "repeat_patch", repeatPatch, py::arg("map"), py::arg("exemplar"),
        documented<PatchSourceOptions, Call>("repeat_patch",
                                             "The arrangement of a map of patches (a .vdb of map_grids) with "
                                             "the exemplar in a file: a PatchSheet or PatchedModel.")
            .c_str());
}

}  // namespace

void bindPatch(py::module_& module) {
    py::class_<PatchSource, SourcePtr>(module, "PatchSource",
                                       "A geometry texture: oriented points that continue beyond a box.")
        .def_property_readonly(
            "size", [](const PatchSource& self) { return placeTuple(self.exemplar.size); },
            "[world] of the box: along the plane's two axes, and the height.")
        .def_property_readonly(
            "spacing", [](const PatchSource& self) { return self.exemplar.spacing; },
            "[world] of the points.")
        .def_property_readonly(
            "count", [](const PatchSource& self) { return self.exemplar.points.size(); }, "Number of points.")
        .def_readonly("voxelSize", &PatchSource::voxelSize, "[world] of level sets made of it.")
        .def_readonly("recorded", &PatchSource::recorded, "The file says its box.");
    bindSheets(module);
    bindFunctions(module);
}

}  // namespace vdbsynth::python
