// Exemplars, block synthesis, holes, source maps and matches.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"

#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/procedural/analogy_pair.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <pybind11/stl.h>

namespace vdbsynth::python {

template <>
struct Words<MapTypes> {
    static constexpr const char* kType = "Literal['integer', 'float']";
    static constexpr std::pair<const char*, MapTypes> kAll[] = {{"integer", MapTypes::Integer},
                                                                {"float", MapTypes::Float}};
};
template <>
struct Words<MapMethod> {
    static constexpr const char* kType = "str";
    static constexpr std::pair<const char*, MapMethod> kAll[] = {
        {"synthesis", MapMethod::Synthesis}, {"fill", MapMethod::Fill}, {"analogy", MapMethod::Analogy}};
};

namespace {

// Sources of voxels as arrays.
py::dict sourcesOf(const SourceMap& map, const LevelSet& result, const py::kwargs& given) {
    Call call;
    readKeywords("SourceMap.sources", given, call);
    const LevelSet model = result;
    const auto voxels = call.run([&](const RunContext& ctx) { return mappedVoxels(map, *model.grid, ctx); });
    const std::size_t count = voxels.size();
    std::vector<std::array<int, 3>> to(count);
    std::vector<std::int32_t> exemplar(count);
    std::vector<Vec3d> position(count);
    std::vector<Vec3f> rotation(count);
    std::vector<float> scale(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Source& from = voxels[i].from;
        to[i] = {voxels[i].to.x, voxels[i].to.y, voxels[i].to.z};
        exemplar[i] = from.exemplar;
        position[i] = from.position;
        rotation[i] = from.rotation;
        scale[i] = from.scale;
    }
    py::dict dict;
    dict["voxel"] = arrayOf(to);
    dict["exemplar"] = arrayOf(exemplar);
    dict["position"] = arrayOf(position);
    dict["rotation"] = arrayOf(rotation);
    dict["scale"] = arrayOf(scale);
    return dict;
}

void bindMaps(py::module_& module) {
    py::class_<SourceMap>(module, "SourceMap",
                          "Which voxel of which model every voxel of a result was copied from.")
        .def_property_readonly(
            "method",
            [](const SourceMap& self) {
                for (const auto& [word, meaning] : Words<MapMethod>::kAll)
                    if (meaning == self.method) return std::string(word);
                return std::string();
            },
            "'synthesis', 'fill' or 'analogy'.")
        .def_property_readonly(
            "inputs", [](const SourceMap& self) { return self.inputs(); },
            "Number of models that repeat takes.")
        .def(
            "to_grids",
            [](const SourceMap& self, const LevelSet& result, const py::object& types,
               const py::kwargs& given) {
                Call call;
                readKeywords("SourceMap.to_grids", given, call);
                const MapTypes kind = Value<MapTypes>::from("types", types);
                const LevelSet model = result;
                return gridList(call.run(
                    [&](const RunContext& ctx) { return sourceMapGrids(self, *model.grid, ctx, kind); }));
            },
            py::arg("model"), py::arg("types") = "integer",
            documented<Call>(
                "SourceMap.to_grids",
                "The map as a list of Grid over the result's voxels, as --source-map writes it: extraGrids "
                "of\n"
                "LevelSet.write, or write_grids. types 'float': Vec3S and float only, which pyopenvdb reads.")
                .c_str())
        .def("sources", sourcesOf, py::arg("model"),
             documented<Call>("SourceMap.sources",
                              "Arrays over the result's mapped voxels: voxel int32 [n, 3] (index of the "
                              "result), exemplar int32 [n], position\n"
                              "float64 [n, 3] (index of the exemplar, between voxels), rotation float32 [n, "
                              "3] (vector, radians), scale float32 [n].")
                 .c_str());
    module.def(
        "read_map",
        [](const py::object& path, const py::kwargs& given) {
            Call call;
            readKeywords("read_map", given, call);
            const std::string text = textFrom("path", path);
            return call.run([&](const RunContext& ctx) { return readSourceMap(text, ctx); });
        },
        py::arg("path"), documented<Call>("read_map", "The source map in a .vdb file.").c_str());
    module.def(
        "repeat",
        [](const SourceMap& map, const py::object& inputs, const py::kwargs& given) {
            Call call;
            RepeatOptions options;
            readKeywords("repeat", given, options, call);
            const std::vector<LevelSet> models = modelsFrom("inputs", inputs);
            return call.run(
                [&](const RunContext& ctx) { return repeatMap(map, pointersTo(models), options, ctx); });
        },
        py::arg("map"), py::arg("inputs"),
        documented<RepeatOptions, Call>("repeat",
                                        "Applies a source map to models, without any search: the exemplars "
                                        "of a synthesis; those of a fill, then the kept\n"
                                        "model; of an analogy the textured models, then the target.")
            .c_str());
}

void bindResults(py::module_& module) {
    py::class_<BlockSynthesisStats>(module, "SynthesisStats", "What a synthesis did.")
        .def_readonly("block", &BlockSynthesisStats::block, "[voxels] side of the blocks.")
        .def_readonly("levels", &BlockSynthesisStats::levels, "Passes.")
        .def_readonly("matches", &BlockSynthesisStats::matches)
        .def_readonly("nodes", &BlockSynthesisStats::nodes, "Bounds computed.")
        .def_readonly("exact", &BlockSynthesisStats::exact, "Costs computed.")
        .def_readonly("meanCost", &BlockSynthesisStats::meanCost, "[voxels^2] of the last pass's matches.")
        .def_readonly("indexBytes", &BlockSynthesisStats::indexBytes);
    py::class_<SynthResult>(module, "SynthResult")
        .def_readonly("model", &SynthResult::model)
        .def_readonly("map", &SynthResult::map)
        .def_readonly("stats", &SynthResult::stats);
    py::class_<FillResult>(module, "FillResult")
        .def_readonly("model", &FillResult::model)
        .def_readonly("map", &FillResult::map)
        .def_readonly("stats", &FillResult::stats);
    py::class_<BlockMatch>(module, "BlockMatch")
        .def_property_readonly(
            "position", [](const BlockMatch& self) { return indexTuple(self.position); },
            "[index] minimum corner in the exemplar.")
        .def_readonly("cost", &BlockMatch::cost, "[voxels^2] mean squared difference.");
    py::class_<MatchResult>(module, "MatchResult")
        .def_readonly("matches", &MatchResult::matches, "A list of BlockMatch, best first.")
        .def_readonly("known", &MatchResult::known, "Samples of the query that were compared.")
        .def_readonly("exactnessRatio", &MatchResult::exactnessRatio)
        .def_readonly("recall", &MatchResult::recall);
}

FillResult fill(const py::object& kept, const py::object& hole, const py::object& exemplar,
                const py::kwargs& given) {
    Call call;
    FillOptions options;
    readKeywords("fill", given, options, call);
    const LevelSet partial = modelFrom("partial", kept);
    std::optional<LevelSet> from, where;
    std::optional<IndexBox> box;
    if (!exemplar.is_none()) from = modelFrom("exemplar", exemplar);
    if (py::isinstance<LevelSet>(hole))
        where = modelFrom("hole", hole);
    else if (!py::isinstance<py::str>(hole))
        box = boxFrom("hole", hole);
    else if (py::cast<std::string>(hole) != "auto")
        refuseWord("hole", hole, {"auto"});
    return call.run([&](const RunContext& ctx) {
        const LevelSet inside = where ? *where
                                : box ? boxHole(partial, *box, ctx)
                                      : holesAtOpenEdges(partial, ctx);
        return fillHoles(partial, inside, from ? &*from : nullptr, options, ctx);
    });
}

void bindMethods(py::module_& module) {
    module.def(
        "synth",
        [](const py::object& exemplars, const py::kwargs& given) {
            Call call;
            SynthOptions options;
            readKeywords("synth", given, options, call);
            const std::vector<LevelSet> models = modelsFrom("exemplars", exemplars);
            return call.run(
                [&](const RunContext& ctx) { return synthesize(pointersTo(models), options, ctx); });
        },
        py::arg("exemplars"),
        documented<SynthOptions, Call>("synth",
                                       "More geometry that looks like the exemplar, one LevelSet or a list: "
                                       "SynthResult(model, map, stats).")
            .c_str());
    module.def("fill", fill, py::arg("partial"), py::arg("hole"), py::arg("exemplar") = py::none(),
               documented<FillOptions, Call>("fill",
                                             "vdb_synth synth --keep: a model with its holes filled from its "
                                             "surroundings or from an exemplar. `hole`: a LevelSet\n"
                                             "whose inside is filled, an index box ((i, j, k), (I, J, K)), "
                                             "or 'auto' (of a model with keepSource: around its mesh's\n"
                                             "open edges). FillResult(model, map, stats).")
                   .c_str());
    module.def(
        "match",
        [](const py::object& exemplar, const py::object& query, const py::kwargs& given) {
            Call call;
            MatchOptions options;
            readKeywords("match", given, options, call);
            const LevelSet from = modelFrom("exemplar", exemplar), of = modelFrom("query", query);
            return call.run([&](const RunContext& ctx) { return matchModel(from, of, options, ctx); });
        },
        py::arg("exemplar"), py::arg("query"),
        documented<MatchOptions, Call>("match",
                                       "The blocks of an exemplar with the smallest differences to one of "
                                       "the query's: MatchResult(matches, known, ...).")
            .c_str());
    module.def(
        "pose",
        [](const py::object& made, const py::object& rest, const py::object& posed, const py::kwargs& given) {
            Call call;
            PoseOptions options;
            readKeywords("pose", given, options, call);
            const LevelSet result = modelFrom("made", made), atRest = modelFrom("rest", rest),
                           inPose = modelFrom("posed", posed);
            return call.run(
                [&](const RunContext& ctx) { return poseModel(result, atRest, inPose, options, ctx); });
        },
        py::arg("made"), py::arg("rest"), py::arg("posed"),
        documented<PoseOptions, Call>("pose",
                                      "What was made of a surface at rest, carried to another pose of that "
                                      "surface. Meshes need keepSource, and the same faces.")
            .c_str());
}

void bindMake(py::module_& module) {
    module.def(
        "exemplar_kinds",
        [] {
            std::vector<std::string> names;
            for (const ExemplarKind& kind : exemplarKinds()) names.push_back(kind.name);
            return names;
        },
        "Kinds that make and make_points take.");
    module.def(
        "pair_kinds",
        [] {
            std::vector<std::string> names;
            for (const AnalogyPairKind& kind : analogyPairKinds()) names.push_back(kind.name);
            return names;
        },
        "Kinds that make_pair takes.");
    module.def(
        "make",
        [](const py::object& kind, const py::kwargs& given) {
            Call call;
            MakeOptions options;
            readKeywords("make", given, options, call);
            options.exemplar.kind = textFrom("kind", kind);
            return call.run([&](const RunContext& ctx) { return makeModel(options, ctx); });
        },
        py::arg("kind"),
        documented<MakeOptions, Call>(
            "make", "A procedural exemplar, one of exemplar_kinds(), as a LevelSet with a recorded domain.")
            .c_str());
    module.def(
        "make_pair",
        [](const py::object& kind, const py::kwargs& given) {
            Call call;
            MakeOptions options;
            readKeywords("make_pair", given, options, call);
            options.exemplar.kind = textFrom("kind", kind);
            const ModelPair pair = call.run([&](const RunContext& ctx) { return makePair(options, ctx); });
            return py::make_tuple(pair.plain, pair.textured);
        },
        py::arg("kind"),
        documented<MakeOptions, Call>(
            "make_pair", "A procedural pair for analogies, one of pair_kinds(): (plain, textured).")
            .c_str());
    module.def(
        "make_points",
        [](const py::object& kind, const py::kwargs& given) {
            Call call;
            MakePointsOptions options;
            readKeywords("make_points", given, options, call);
            options.model.exemplar.kind = textFrom("kind", kind);
            const TexturePoints made =
                call.run([&](const RunContext& ctx) { return makePoints(options, ctx); });
            return py::make_tuple(std::make_shared<PointCloud>(made.cloud), textureBoxComments(made.box));
        },
        py::arg("kind"),
        documented<MakePointsOptions, Call>("make_points",
                                            "A geometry texture as points, which continue beyond its domain: "
                                            "(PointCloud, comments). Written with these comments\n"
                                            "the .ply says its box, for read_patch_source.")
            .c_str());
}

}  // namespace

void bindSynth(py::module_& module) {
    bindMaps(module);
    bindResults(module);
    bindMethods(module);
    bindMake(module);
}

}  // namespace vdbsynth::python
