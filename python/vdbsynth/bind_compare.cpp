// Measurements of models.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"

#include "libvdbsynth/vdb/source_map_grids.h"

#include <pybind11/stl.h>

namespace vdbsynth::python {
namespace {

void bindMeasures(py::module_& module) {
    py::class_<Statistic>(module, "Statistic",
                          "A number, or a curve, of a model; docs/measures.md defines each.")
        .def_readonly("name", &Statistic::name)
        .def_readonly("power", &Statistic::power, "World value = value * voxel size ** power.")
        .def_readonly("curve", &Statistic::curve)
        .def_property_readonly(
            "values", [](const Statistic& self) { return arrayOf(self.values); },
            "float64 [1], [3] by axis, or the curve; empty: not measured.");
    py::class_<Topology>(module, "Topology", "Counts of a whole model.")
        .def_property_readonly(
            "solids", [](const Topology& self) { return self.solid.sizes.size(); },
            "Components of the solid.")
        .def_property_readonly(
            "voids", [](const Topology& self) { return self.empty.sizes.size(); }, "Components of the void.")
        .def_readonly("eulerCharacteristic", &Topology::eulerCharacteristic)
        .def_readonly("enclosed", &Topology::enclosed)
        .def_readonly("tunnels", &Topology::tunnels);
    py::class_<GradientError>(module, "GradientError")
        .def_readonly("mean", &GradientError::mean)
        .def_readonly("percentile99", &GradientError::percentile99);
    py::class_<LocalPatches>(module, "LocalPatches")
        .def_readonly("shareIoU", &LocalPatches::shareIoU)
        .def_readonly("shareScore", &LocalPatches::shareScore)
        .def_readonly("meanIoU", &LocalPatches::meanIoU);
    py::class_<SurfaceDistance>(module, "SurfaceDistance", "[voxels of the reference]")
        .def_readonly("mean", &SurfaceDistance::mean)
        .def_readonly("rootMean", &SurfaceDistance::rootMean)
        .def_readonly("hausdorff", &SurfaceDistance::hausdorff);
    py::class_<Novelty>(module, "Novelty")
        .def_readonly("voxels", &Novelty::voxels)
        .def_readonly("verbatimShare", &Novelty::verbatimShare)
        .def_readonly("meanRun", &Novelty::meanRun)
        .def_readonly("largestRun", &Novelty::largestRun)
        .def_readonly("largestShare", &Novelty::largestShare)
        .def_readonly("exemplarUsed", &Novelty::exemplarUsed)
        .def_readonly("seamRatio", &Novelty::seamRatio)
        .def_readonly("seamShare", &Novelty::seamShare);
    py::class_<Verdict>(
        module, "Verdict",
        "One statistic of a result relative to the spread of the reference's own sub-volumes.")
        .def_readonly("name", &Verdict::name)
        .def_readonly("mean", &Verdict::mean)
        .def_readonly("sigma", &Verdict::sigma)
        .def_readonly("distance", &Verdict::distance)
        .def_readonly("quartile", &Verdict::quartile)
        .def_property_readonly("passes", &Verdict::passes);
    py::class_<Yardstick>(module, "Yardstick",
                          "Distances of results from an exemplar, relative to its process.")
        .def_readonly("name", &Yardstick::name)
        .def_readonly("results", &Yardstick::results)
        .def_readonly("fresh", &Yardstick::fresh)
        .def_readonly("shifted", &Yardstick::shifted)
        .def_property_readonly("ratio", &Yardstick::ratio, "1: as far as another sample of the process.");
}

void bindComparison(py::module_& module) {
    py::class_<ModelStatistics>(module, "ModelStatistics", "The measurements of one model.")
        .def_readonly("name", &ModelStatistics::name)
        .def_property_readonly("domain", [](const ModelStatistics& self) { return boxTuple(self.domain); })
        .def_readonly("domainRecorded", &ModelStatistics::domainRecorded)
        .def_readonly("voxelSize", &ModelStatistics::voxelSize)
        .def_readonly("statistics", &ModelStatistics::statistics, "A list of Statistic.")
        .def_readonly("topology", &ModelStatistics::topology)
        .def_readonly("gradient", &ModelStatistics::gradient)
        .def_readonly("bandCompleteness", &ModelStatistics::bandCompleteness)
        .def_readonly("islands", &ModelStatistics::islands)
        .def_readonly("relief", &ModelStatistics::relief, "ReliefStatistics; None: not asked for.");
    py::class_<ModelDistances::Scale>(module, "PatchDistances",
                                      "Distances between patches of one size [voxels].")
        .def_readonly("wasserstein", &ModelDistances::Scale::wasserstein)
        .def_readonly("coherence", &ModelDistances::Scale::coherence)
        .def_readonly("completeness", &ModelDistances::Scale::completeness);
    py::class_<ModelDistances>(module, "ModelDistances",
                               "The measurements of a model relative to the reference.")
        .def_readonly("scales", &ModelDistances::scales, "A list of PatchDistances.")
        .def_readonly("localPatches", &ModelDistances::localPatches)
        .def_readonly("surface", &ModelDistances::surface,
                      "SurfaceDistance, if both overlap in the world; else None.")
        .def_readonly("verified", &ModelDistances::verified)
        .def_readonly("novelty", &ModelDistances::novelty)
        .def_readonly("verdicts", &ModelDistances::verdicts, "A list of Verdict.");
    py::class_<Comparison>(module, "Comparison",
                           "Statistics of a reference and of other models, and their distances [voxels].")
        .def_readonly("reference", &Comparison::reference)
        .def_readonly("others", &Comparison::others, "A list of ModelStatistics.")
        .def_readonly("distances", &Comparison::distances,
                      "A list of ModelDistances, one of each other model.")
        .def_readonly("stationary", &Comparison::stationary, "Truths of the three axes.")
        .def_readonly("parts", &Comparison::parts)
        .def_readonly("islandLimit", &Comparison::islandLimit)
        .def_readonly("reach", &Comparison::reach)
        .def_readonly("yardsticks", &Comparison::yardsticks, "A list of Yardstick; empty without a process.");
}

std::vector<std::string> namesFrom(const py::object& names, std::size_t count) {
    std::vector<std::string> all;
    if (!names.is_none()) all = Value<std::vector<std::string>>::from("names", names);
    if (!all.empty() && all.size() != count + 1)
        throw Error(ErrorCode::InvalidOption, "`names`: must be " + std::to_string(count + 1) +
                                                  ", the reference's first, not " +
                                                  std::to_string(all.size()));
    if (all.empty()) all.push_back("reference");
    for (std::size_t i = all.size(); i < count + 1; ++i)
        all.push_back(count == 1 ? "other" : "other " + std::to_string(i));
    return all;
}

Comparison compare(const py::object& given, const py::object& others, const py::object& names,
                   const py::object& maps, const py::kwargs& keywords) {
    Call call;
    CompareOptions options;
    readKeywords("compare", keywords, options, call);
    const std::vector<LevelSet> models = modelsFrom("others", others);
    const std::vector<std::string> called = namesFrom(names, models.size());
    CompareInput reference;
    reference.name = called.front();
    reference.model = modelFrom("reference", given);
    std::vector<const SourceMap*> mapOf(models.size(), nullptr);
    if (!maps.is_none()) {
        const auto parts = py::isinstance<SourceMap>(maps)
                               ? std::vector<py::object>{maps}
                               : elementsFrom("maps", maps, "a SourceMap or a list of them");
        if (parts.size() != models.size())
            throw Error(ErrorCode::ShapeMismatch,
                        "`maps`: must be one for each of the " + std::to_string(models.size()) +
                            " other models, or None, not " + std::to_string(parts.size()));
        for (std::size_t i = 0; i < parts.size(); ++i) {
            if (parts[i].is_none()) continue;
            if (!py::isinstance<SourceMap>(parts[i]))
                refuse("maps", "a SourceMap or a list of them", parts[i]);
            mapOf[i] = &py::cast<const SourceMap&>(parts[i]);
        }
    }
    return call.run([&](const RunContext& ctx) {
        std::vector<CompareInput> inputs(models.size());
        for (std::size_t i = 0; i < models.size(); ++i) {
            inputs[i].name = called[i + 1];
            inputs[i].model = models[i];
            if (mapOf[i])
                inputs[i].sources = mappedVoxels(*mapOf[i], *models[i].grid, ctx);
            else
                takeSourceMap(models[i].attributes, inputs[i]);
        }
        return compareModels(reference, inputs, options, ctx);
    });
}

}  // namespace

void bindCompare(py::module_& module) {
    bindMeasures(module);
    bindComparison(module);
    module.def(
        "compare", compare, py::arg("reference"), py::arg("others"), py::arg("names") = py::none(),
        py::arg("maps") = py::none(),
        documented<CompareOptions, Call>("compare",
                                         "Measures models and how far they are from a reference: a "
                                         "Comparison. others: one LevelSet or a list, of the reference's\n"
                                         "voxel size; maps: their SourceMaps, whose exemplar 0 is the "
                                         "reference, or None: those among their attributes.")
            .c_str());
}

}  // namespace vdbsynth::python
