// Volume analogies, and filters learnt on scalar grids.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"

#include <pybind11/stl.h>

namespace vdbsynth::python {
namespace {

// One pair, or a list of pairs.
std::vector<std::array<py::object, 2>> pairsFrom(const std::string& name, py::handle value,
                                                 const std::string& what) {
    const std::string wanted = "a pair of " + what + ", or a list of pairs";
    std::vector<py::object> parts = elementsFrom(name, value, wanted);
    const bool nested =
        !parts.empty() && PySequence_Check(parts[0].ptr()) && !py::isinstance<py::str>(parts[0]);
    if (!nested) parts = {py::reinterpret_borrow<py::object>(value)};
    std::vector<std::array<py::object, 2>> pairs;
    for (const py::object& part : parts) {
        const std::vector<py::object> both = elementsFrom(name, part, wanted);
        if (both.size() != 2) refuse(name, wanted, part);
        pairs.push_back({both[0], both[1]});
    }
    return pairs;
}

AnalogyResult analogy(const py::object& given, const py::object& target, const py::kwargs& keywords) {
    Call call;
    AnalogyOptions options;
    readKeywords("analogy", keywords, options, call);
    std::vector<LevelSet> models;
    for (const auto& [plain, textured] : pairsFrom("pairs", given, "LevelSet")) {
        models.push_back(modelFrom("pairs", plain));
        models.push_back(modelFrom("pairs", textured));
    }
    const LevelSet onto = modelFrom("target", target);
    std::vector<AnalogyModelPair> pairs;
    for (std::size_t i = 0; i < models.size(); i += 2) pairs.push_back({&models[i], &models[i + 1]});
    return call.run([&](const RunContext& ctx) { return makeAnalogyModel(pairs, onto, options, ctx); });
}

FloatGridPtr floatsOf(const std::string& name, py::handle value) {
    const FloatGridPtr floats = asFloat(gridFrom(name, value));
    if (!floats) refuse(name, "a grid of floats", value);
    return floats;
}

FilterGridResult filterAnalogy(const py::object& given, const py::object& target,
                               const py::kwargs& keywords) {
    Call call;
    FilterAnalogyOptions options;
    readKeywords("filter_analogy", keywords, options, call);
    std::vector<FilterGridPair> pairs;
    for (const auto& [before, after] : pairsFrom("pairs", given, "grids"))
        pairs.push_back({floatsOf("pairs", before), floatsOf("pairs", after)});
    const FloatGridPtr onto = floatsOf("target", target);
    return call.run([&](const RunContext& ctx) { return makeFilteredGrid(pairs, onto, options, ctx); });
}

void bindResults(py::module_& module) {
    py::class_<AnalogyLevelStats>(module, "AnalogyLevelStats", "Measurements of one level.")
        .def_readonly("voxels", &AnalogyLevelStats::voxels)
        .def_readonly("waves", &AnalogyLevelStats::waves)
        .def_readonly("features", &AnalogyLevelStats::features)
        .def_readonly("components", &AnalogyLevelStats::components)
        .def_readonly("explained", &AnalogyLevelStats::explained)
        .def_readonly("coherent", &AnalogyLevelStats::coherent)
        .def_readonly("meanDistance", &AnalogyLevelStats::meanDistance)
        .def_readonly("exactDistance", &AnalogyLevelStats::exactDistance);
    py::class_<AnalogyResult>(module, "AnalogyResult")
        .def_readonly("model", &AnalogyResult::model)
        .def_readonly("map", &AnalogyResult::map)
        .def_property_readonly(
            "directions",
            [](const AnalogyResult& self) -> py::object {
                return self.directions ? py::cast(GridObject{self.directions}) : py::none();
            },
            "With keepDirections a Grid of unit vectors [world]; else None.")
        .def_readonly("levels", &AnalogyResult::levels, "A list of AnalogyLevelStats.")
        .def_property_readonly(
            "singularities", [](const AnalogyResult& self) { return arrayOf(self.singularities); },
            "float64 [n, 3] world, of the target's directions.")
        .def_readonly("cut", &AnalogyResult::cut)
        .def_readonly("reach", &AnalogyResult::reach,
                      "[voxels] largest distance of the texture from the plain surface.");
    py::class_<FilterAnalogyStats>(module, "FilterAnalogyStats")
        .def_readonly("rows", &FilterAnalogyStats::rows)
        .def_readonly("change", &FilterAnalogyStats::change)
        .def_readonly("affineError", &FilterAnalogyStats::affineError)
        .def_readonly("searchError", &FilterAnalogyStats::searchError)
        .def_readonly("searched", &FilterAnalogyStats::searched);
    py::class_<FilterGridResult>(module, "FilterGridResult")
        .def_property_readonly("grid", [](const FilterGridResult& self) { return GridObject{self.grid}; })
        .def_readonly("stats", &FilterGridResult::stats);
}

}  // namespace

void bindAnalogy(py::module_& module) {
    bindResults(module);
    module.def(
        "analogy", analogy, py::arg("pairs"), py::arg("target"),
        documented<AnalogyOptions, Call>("analogy",
                                         "plain : textured = target : result. `pairs`: (plain, textured), or "
                                         "a list of such pairs. AnalogyResult(model, map, ...).")
            .c_str());
    module.def(
        "filter_analogy", filterAnalogy, py::arg("pairs"), py::arg("target"),
        documented<FilterAnalogyOptions, Call>("filter_analogy",
                                               "Applies to a scalar grid, such as a density, the filter that "
                                               "other grids show: `pairs` (before, after), or a list of\n"
                                               "such pairs, of Grid. FilterGridResult(grid, stats).")
            .c_str());
}

}  // namespace vdbsynth::python
