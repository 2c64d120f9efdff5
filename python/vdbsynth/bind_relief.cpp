// Relief: taken off, and grown.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"
#include "python/vdbsynth/targets.h"

#include "libvdbsynth/pipeline/relief/relief_outputs.h"

#include <pybind11/stl.h>

#include <algorithm>

namespace vdbsynth::python {
namespace {

/// vdbsynth.Heights: a picture of heights.
struct HeightsObject {
    SampleImage heights;
    double height = 0, pixelSize = 0;
};

HeightsObject heightsFrom(const py::object& array, double height, double pixelSize, bool tileable) {
    HeightsObject made{imageOfArray("heights", array), height, pixelSize};
    made.heights.tileable = tileable;
    if (made.heights.channels != 1)
        throw Error(ErrorCode::ShapeMismatch, "`heights`: must have one channel, [rows, columns]");
    for (const float v : made.heights.values)
        if (!(v >= 0 && v <= 1))
            throw Error(ErrorCode::InvalidOption,
                        "`heights` " + realText(v) +
                            ": must be from 0 (low) to 1 (high); `height` says how high 1 is [world]");
    if (!(height >= 0) || !(pixelSize >= 0))
        throw Error(ErrorCode::InvalidOption, "`height` and `pixelSize`: must be at least 0");
    return made;
}

struct Samples {
    std::vector<LevelSet> scans;
    std::vector<ReliefSource> sources;
};

Samples samplesFrom(const py::object& given) {
    const bool one = py::isinstance<LevelSet>(given) || py::isinstance<HeightsObject>(given);
    const std::string wanted = "a LevelSet or Heights, or a list of them";
    const std::vector<py::object> parts =
        one ? std::vector<py::object>{given} : elementsFrom("samples", given, wanted);
    Samples samples;
    samples.scans.reserve(parts.size());
    for (const py::object& part : parts) {
        ReliefSource source;
        if (py::isinstance<HeightsObject>(part)) {
            const auto& picture = py::cast<const HeightsObject&>(part);
            source.heights = picture.heights;
            source.height = picture.height;
            source.pixelSize = picture.pixelSize;
        } else if (py::isinstance<LevelSet>(part)) {
            samples.scans.push_back(modelFrom("samples", part));
            source.scan = &samples.scans.back();
        } else {
            refuse("samples", wanted, part);
        }
        samples.sources.push_back(std::move(source));
    }
    return samples;
}

ReliefResult relief(const py::object& given, const py::object& onto, const py::object& labels,
                    const py::kwargs& keywords) {
    Call call;
    ReliefOptions options;
    readKeywords("relief", keywords, options, call);
    const Samples samples = samplesFrom(given);
    const LevelSet target = modelFrom("target", onto);
    const Regions regions = regionsFrom("labels", labels);
    if (samples.sources.size() > 1 && !regions.labels)
        throw Error(
            ErrorCode::InvalidOption,
            "`labels`: missing; several samples need it to say where each goes, 'auto' or a LevelSet");
    return call.run([&](const RunContext& ctx) {
        ReliefLabels numbers;
        if (regions.labels && samples.sources.size() > 1)
            numbers = [&](const TextureShape& sites) {
                return regions.labels(sites, samples.sources.size(), ctx);
            };
        return transferRelief(samples.sources, target, numbers, options, ctx);
    });
}

void bake(const ReliefResult& self, const std::shared_ptr<Mesh>& mesh, const py::object& path,
          const py::kwargs& given) {
    Call call;
    ReliefBakeOptions options;
    readKeywords("ReliefResult.bake", given, options, call);
    if (!(options.reach > 0)) options.reach = self.reach;
    const std::string text = textFrom("path", path);
    writeOutputs(call, [&](OutputSet& outputs, const RunContext& ctx) {
        bakeRelief(*mesh, self.model, "the mesh", text, options, outputs, ctx);
    });
}

/// vdbsynth.ReliefExtraction, with the options that its files need.
struct ExtractionObject {
    ReliefExtraction result;
    ReliefExtractOptions options;
};

void writeExtraction(const ExtractionObject& self, const py::object& paths, const py::object& metadata,
                     const py::kwargs& given) {
    Call call;
    readKeywords("ReliefExtraction.write", given, call);
    const std::vector<std::string> all = pathsFrom("paths", paths);
    const VdbMetadata words = Value<VdbMetadata>::from("metadata", metadata);
    requireReliefPaths(all, self.options);
    writeOutputs(call, [&](OutputSet& outputs, const RunContext& ctx) {
        writeRelief(self.result, all, self.options, words, outputs, ctx);
    });
}

py::object gridOrNone(const GridPtr& grid) {
    return grid ? py::cast(GridObject{grid}) : py::none();
}

void bindStatistics(py::module_& module) {
    py::class_<ReliefOctave>(module, "ReliefOctave", "The part of a relief between two wavelengths.")
        .def_readonly("shortest", &ReliefOctave::shortest)
        .def_readonly("longest", &ReliefOctave::longest)
        .def_readonly("deviation", &ReliefOctave::deviation);
    py::class_<ReliefStatistics>(module, "ReliefStatistics", "Roughness as ISO 25178 counts it [voxels].")
        .def_readonly("mean", &ReliefStatistics::mean)
        .def_readonly("sa", &ReliefStatistics::sa)
        .def_readonly("sq", &ReliefStatistics::sq)
        .def_readonly("ssk", &ReliefStatistics::ssk)
        .def_readonly("sku", &ReliefStatistics::sku)
        .def_readonly("lowest", &ReliefStatistics::lowest)
        .def_readonly("highest", &ReliefStatistics::highest)
        .def_readonly("area", &ReliefStatistics::area)
        .def_readonly("folded", &ReliefStatistics::folded)
        .def_readonly("lost", &ReliefStatistics::lost)
        .def_readonly("octaves", &ReliefStatistics::octaves, "A list of ReliefOctave.");
    py::class_<SurfaceCounts>(module, "SurfaceCounts", "Connected components and tunnels of a solid.")
        .def_readonly("solids", &SurfaceCounts::solids)
        .def_readonly("voids", &SurfaceCounts::voids)
        .def_readonly("tunnels", &SurfaceCounts::tunnels);
}

void bindExtraction(py::module_& module) {
    py::class_<ExtractionObject>(module, "ReliefExtraction",
                                 "A scan split into a smooth base and its relief.")
        .def_property_readonly(
            "base", [](const ExtractionObject& self) { return self.result.base; }, "LevelSet.")
        .def_property_readonly(
            "relief", [](const ExtractionObject& self) { return gridOrNone(self.result.relief); },
            "Grid of heights along the base's normal [world].")
        .def_property_readonly(
            "reliefVector", [](const ExtractionObject& self) { return gridOrNone(self.result.reliefVector); },
            "Grid of vectors to the scan's surface [world], where the relief folds; None: nowhere.")
        .def_property_readonly(
            "surface",
            [](const ExtractionObject& self) -> py::object {
                return self.result.surface.grid ? py::cast(self.result.surface) : py::none();
            },
            "base + strength * relief, a LevelSet; None: no strength was given.")
        .def_property_readonly(
            "radius", [](const ExtractionObject& self) { return self.result.radius; }, "[world] of the base.")
        .def_property_readonly("statistics",
                               [](const ExtractionObject& self) { return self.result.statistics; })
        .def_property_readonly("scanCounts",
                               [](const ExtractionObject& self) { return self.result.scanCounts; })
        .def_property_readonly("baseCounts",
                               [](const ExtractionObject& self) { return self.result.baseCounts; })
        .def("write", writeExtraction, py::arg("paths"), py::arg("metadata") = py::dict(),
             documented<Call>("ReliefExtraction.write",
                              "Writes one path or several: .vdb (base, relief, relief_vector, surface), .ply "
                              "(the base with its relief), .png and .exr\n"
                              "(of a flat scan), and with a strength meshes of the surface.")
                 .c_str());
    module.def(
        "relief_extract",
        [](const py::object& given, const py::kwargs& keywords) {
            Call call;
            ExtractionObject made;
            readKeywords("relief_extract", keywords, made.options, call);
            const LevelSet model = modelFrom("model", given);
            made.result =
                call.run([&](const RunContext& ctx) { return extractRelief(model, made.options, ctx); });
            return made;
        },
        py::arg("model"),
        documented<ReliefExtractOptions, Call>(
            "relief_extract", "Splits a scan into a smooth base and the relief on it: a ReliefExtraction.")
            .c_str());
}

void bindTransfer(py::module_& module) {
    py::class_<HeightsObject>(module, "Heights", "A picture of heights, as a sample of relief.")
        .def(py::init(&heightsFrom), py::arg("heights"), py::arg("height") = 0.0, py::arg("pixelSize") = 0.0,
             py::arg("tileable") = false,
             "heights: [rows, columns], the top row first, from 0 to 1, or whole numbers of 8 or 16 bits; "
             "height [world] of 1 over 0,\n"
             "0: 5 voxels of the target times the scale; pixelSize [world] of a pixel on the target at scale "
             "1, 0: a voxel.")
        .def_property_readonly("heights",
                               [](const HeightsObject& self) { return arrayOfImage(self.heights); })
        .def_readonly("height", &HeightsObject::height)
        .def_readonly("pixelSize", &HeightsObject::pixelSize);
    py::class_<ReliefResult>(module, "ReliefResult")
        .def_readonly("model", &ReliefResult::model)
        .def_property_readonly(
            "sources", [](const ReliefResult& self) { return gridList(self.sources); },
            "A list of Grid over the result's band: source_u, source_v, exemplar, source.")
        .def_readonly("levels", &ReliefResult::levels, "A list of CoordinateLevelStats.")
        .def_property_readonly(
            "singularities", [](const ReliefResult& self) { return arrayOf(self.singularities); },
            "float64 [n, 3] world.")
        .def_readonly("reach", &ReliefResult::reach, "[world]")
        .def_readonly("texel", &ReliefResult::texel, "[world]")
        .def_readonly("baseRadius", &ReliefResult::baseRadius, "[world]")
        .def_readonly("covered", &ReliefResult::covered)
        .def_readonly("parts", &ReliefResult::parts)
        .def_readonly("folds", &ReliefResult::folds)
        .def_readonly("unchanged", &ReliefResult::unchanged)
        .def_readonly("fitted", &ReliefResult::fitted)
        .def_readonly("mismatch", &ReliefResult::mismatch)
        .def("bake", bake, py::arg("mesh"), py::arg("path"),
             documented<ReliefBakeOptions, Call>(
                 "ReliefResult.bake",
                 "Bakes the relief onto the texture coordinates (attribute uv) of the target's Mesh: "
                 "displacement, or by the end of the\n"
                 "path's name _vector (.exr) or _normal.")
                 .c_str());
    module.def("relief", relief, py::arg("samples"), py::arg("target"), py::arg("labels") = py::none(),
               documented<ReliefOptions, Call>("relief",
                                               "Grows the relief of samples (LevelSet scans or Heights, one "
                                               "or a list) on a target: a ReliefResult. labels: of several\n"
                                               "samples which goes where, as texture takes it.")
                   .c_str());
}

}  // namespace

void bindRelief(py::module_& module) {
    bindStatistics(module);
    bindExtraction(module);
    bindTransfer(module);
}

}  // namespace vdbsynth::python
