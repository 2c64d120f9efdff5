// Textures over points, meshes and level sets.
#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"
#include "python/vdbsynth/targets.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/pipeline/texture/texture_regions.h"
#include "libvdbsynth/pipeline/texture/texture_repeat.h"

#include <pybind11/stl.h>

#include <algorithm>

namespace vdbsynth::python {

template <>
struct Words<TargetKind> {
    static constexpr const char* kType = "Literal['points', 'mesh', 'levelset']";
    static constexpr std::pair<const char*, TargetKind> kAll[] = {
        {"points", TargetKind::Points}, {"mesh", TargetKind::Mesh}, {"levelset", TargetKind::LevelSet}};
};
template <>
struct Words<Tiling> {
    static constexpr const char* kType = "Literal['auto', 'yes', 'no']";
    static constexpr std::pair<const char*, Tiling> kAll[] = {
        {"auto", Tiling::Auto}, {"yes", Tiling::Yes}, {"no", Tiling::No}};
};

namespace {

/// vdbsynth.Texture: a target, its samples and what was found.
struct TextureObject {
    TextureShape shape;
    std::vector<TextureSample> samples;
    TextureResult result;
};

// Maps of one sample as read from files are channels of one image.
TextureSample sampleFrom(const py::object& colour, const py::object& maps, bool tileable,
                         const std::string& name) {
    TextureSample sample;
    sample.name = name;
    std::vector<SampleImage> images{imageOfArray("colour", colour)};
    sample.maps.push_back({"Cd", 0, 3, 0});
    if (!maps.is_none()) {
        if (!py::isinstance<py::dict>(maps)) refuse("maps", "a dict of arrays", maps);
        for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(maps)) {
            images.push_back(imageOfArray(textFrom("maps", key), value));
            sample.maps.push_back({textFrom("maps", key), 0, images.back().channels, 0});
        }
    }
    const SampleImage& first = images.front();
    for (std::size_t i = 0; i < images.size(); ++i) {
        const SampleImage& image = images[i];
        if (image.width != first.width || image.height != first.height)
            throw Error(ErrorCode::ShapeMismatch,
                        "`maps` " + sample.maps[i].name + ": must have the size of its colour");
        if (image.channels != 1 && image.channels != 3)
            throw Error(ErrorCode::ShapeMismatch, "`" + (i ? sample.maps[i].name : std::string("colour")) +
                                                      "`: must have one or three channels");
        sample.maps[i].first = sample.image.channels;
        sample.image.channels += sample.maps[i].channels;
    }
    if (first.width < kSmallestSample || first.height < kSmallestSample)
        throw Error(ErrorCode::Unusable,
                    "`colour`: must have at least " + std::to_string(kSmallestSample) + " texels a side");
    sample.image.width = first.width;
    sample.image.height = first.height;
    sample.image.tileable = tileable;
    // A grey colour is three times the same.
    for (std::size_t texel = 0; texel < first.texels(); ++texel)
        for (std::size_t i = 0; i < images.size(); ++i)
            for (int c = 0; c < sample.maps[i].channels; ++c)
                sample.image.values.push_back(
                    images[i].values[texel * std::size_t(images[i].channels) +
                                     std::size_t(std::min(c, images[i].channels - 1))]);
    if (!std::all_of(sample.image.values.begin(), sample.image.values.end(),
                     [](float v) { return v - v == 0; }))
        throw Error(ErrorCode::BadData, "the sample holds NaN or infinite values");
    return sample;
}

std::vector<SampleFiles> filesFrom(const py::object& files) {
    std::vector<SampleFiles> all;
    const bool list = py::isinstance<py::list>(files) || py::isinstance<py::tuple>(files);
    const std::vector<py::object> parts =
        list ? elementsFrom("files", files, "") : std::vector<py::object>{files};
    for (const py::object& part : parts) {
        SampleFiles one;
        if (py::isinstance<py::dict>(part)) {
            for (const auto& [key, path] : py::reinterpret_borrow<py::dict>(part)) {
                const std::string map = textFrom("files", key);
                if (map == "Cd")
                    one.colour = textFrom("files", path);
                else
                    one.maps.emplace_back(map, textFrom("files", path));
            }
            if (one.colour.empty())
                throw Error(ErrorCode::InvalidOption,
                            "`files`: a dict of maps must have the colour as \"Cd\"");
        } else {
            one.colour = textFrom("files", part);
        }
        all.push_back(std::move(one));
    }
    return all;
}

std::vector<TextureSample> samplesFrom(const py::object& samples) {
    if (py::isinstance<TextureSample>(samples)) return {py::cast<const TextureSample&>(samples)};
    std::vector<TextureSample> all;
    for (const py::object& one : elementsFrom("samples", samples, "a TextureSample or a list of them")) {
        if (!py::isinstance<TextureSample>(one)) refuse("samples", "a TextureSample or a list of them", one);
        all.push_back(py::cast<const TextureSample&>(one));
    }
    return all;
}

// A target that was read, or anything in memory that can be one.
std::function<TextureShape(const RunContext&)> targetFrom(const py::object& target) {
    if (py::isinstance<TextureShape>(target))
        return [shape = py::cast<const TextureShape&>(target)](const RunContext&) { return shape; };
    if (py::isinstance<LevelSet>(target))
        return [model = modelFrom("target", target)](const RunContext& ctx) {
            return targetOf(model, "the target", ctx);
        };
    if (py::isinstance<Mesh>(target))
        return [mesh = py::cast<std::shared_ptr<Mesh>>(target)](const RunContext& ctx) {
            return targetOf(*mesh, "the target", ctx);
        };
    if (py::isinstance<PointCloud>(target))
        return [cloud = py::cast<std::shared_ptr<PointCloud>>(target)](const RunContext& ctx) {
            return targetOf(*cloud, "the target", ctx);
        };
    refuse("target", "a TextureTarget, LevelSet, Mesh or PointCloud", target);
}

TextureObject texture(const py::object& target, const py::object& samples, const py::object& labels,
                      const py::kwargs& given) {
    Call call;
    TextureOptions options;
    readKeywords("texture", given, options, call);
    TextureObject made;
    made.samples = samplesFrom(samples);
    const auto shape = targetFrom(target);
    const Regions regions = regionsFrom("labels", labels);
    validate(options);
    call.run([&](const RunContext& ctx) {
        made.shape = shape(ctx);
        const auto numbers = regions.labels ? regions.labels(made.shape, made.samples.size(), ctx)
                                            : std::vector<std::int32_t>{};
        made.result = textureShape(made.shape, made.samples, numbers, options, ctx);
    });
    return made;
}

void writeTexture(const TextureObject& self, const py::object& paths, const py::kwargs& given) {
    Call call;
    TextureOutputOptions options;
    readKeywords("Texture.write", given, options, call);
    const std::vector<std::string> all = pathsFrom("paths", paths);
    requireOutputs(self.shape, all, options);
    writeOutputs(call, [&](OutputSet& outputs, const RunContext& ctx) {
        writeTextured(self.shape, self.result, self.samples, all, options, outputs, ctx);
    });
}

TextureObject repeatTextured(const py::object& path, const py::object& samples, const py::kwargs& given) {
    Call call;
    readKeywords("repeat_texture", given, call);
    const std::string text = textFrom("path", path);
    TextureObject made;
    made.samples = samplesFrom(samples);
    call.run([&](const RunContext& ctx) {
        TextureMap map = readTextureMap(text, ctx);
        repeatTexture(map, made.samples, ctx);
        made.shape = std::move(map.shape);
        made.result = std::move(map.result);
    });
    return made;
}

std::vector<Vec3f> placesOf(const TextureObject& self) {
    std::vector<Vec3f> places;
    for (const std::uint32_t site : self.shape.siteOf) places.push_back(self.shape.placed()[site]);
    return places;
}

void bindInputs(py::module_& module) {
    py::class_<TextureShape>(module, "TextureTarget",
                             "A target of texturing: its elements (points or vertices) and sites (places; "
                             "elements at one place are one site).")
        .def_property_readonly(
            "kind",
            [](const TextureShape& self) {
                return std::string(self.kind == TargetKind::Points ? "points"
                                   : self.kind == TargetKind::Mesh ? "mesh"
                                                                   : "levelset");
            },
            "'points', 'mesh' or 'levelset'.")
        .def_property_readonly(
            "points", [](const TextureShape& self) { return arrayOf(self.points); },
            "float32 [elements, 3], world, relative to `origin`.")
        .def_property_readonly(
            "triangles", [](const TextureShape& self) { return arrayOf(self.triangles); },
            "uint32 [triangles, 3]; of points none.")
        .def_property_readonly(
            "siteOf", [](const TextureShape& self) { return arrayOf(self.siteOf); }, "uint32 [elements].")
        .def_property_readonly(
            "site", [](const TextureShape& self) { return arrayOf(self.site); },
            "float32 [sites, 3], world, relative to `origin`.")
        .def_property_readonly(
            "normal", [](const TextureShape& self) { return arrayOf(self.normal); },
            "float32 [sites, 3] of length 1, outward.")
        .def_property_readonly("attributes", [](const TextureShape& self) { return dictOf(self.attributes); })
        .def_property_readonly("origin", [](const TextureShape& self) { return placeTuple(self.origin); });
    py::class_<TextureSample>(module, "TextureSample", "A picture to imitate, with further maps.")
        .def(py::init(&sampleFrom), py::arg("colour"), py::arg("maps") = py::none(),
             py::arg("tileable") = false, py::arg("name") = "sample",
             "colour: [rows, columns] or [rows, columns, 3], the top row first: floats 0 to 1, or whole "
             "numbers of 8 or 16 bits.\n"
             "maps: a dict of arrays of the same size with one or three channels. tileable: it continues at "
             "its opposite border.")
        .def_property_readonly(
            "image", [](const TextureSample& self) { return arrayOfImage(self.image); },
            "float32 [rows, columns, channels], the top row first: all maps.")
        .def_property_readonly(
            "maps",
            [](const TextureSample& self) {
                py::dict maps;
                for (const SampleMap& map : self.maps)
                    maps[py::str(map.name)] = py::make_tuple(map.first, map.channels);
                return maps;
            },
            "A dict: which channels of `image` a map is, (first, count); the colour is 'Cd'.")
        .def_property_readonly("tileable", [](const TextureSample& self) { return self.image.tileable; });
    module.def(
        "read_target",
        [](const py::object& path, const py::object& kind, const py::kwargs& given) {
            Call call;
            ModelOptions options;
            readKeywords("read_target", given, options, call);
            const std::string text = textFrom("path", path);
            const auto as = Value<std::optional<TargetKind>>::from("kind", kind);
            return call.run([&](const RunContext& ctx) { return loadTarget(text, as, options, ctx); });
        },
        py::arg("path"), py::arg("kind") = py::none(),
        documented<ModelOptions, Call>("read_target",
                                       "A file as a target of texturing: 'points', 'mesh' or 'levelset'; "
                                       "None: by extension, as vdb_synth texture takes it.")
            .c_str());
    module.def(
        "read_samples",
        [](const py::object& files, const py::object& tile, const py::kwargs& given) {
            Call call;
            readKeywords("read_samples", given, call);
            const auto all = filesFrom(files);
            const Tiling tiling = Value<Tiling>::from("tile", tile);
            return call.run([&](const RunContext& ctx) { return readTextureSamples(all, tiling, ctx); });
        },
        py::arg("files"), py::arg("tile") = "auto",
        documented<Call>("read_samples",
                         "Samples from pictures, a list of TextureSample: one path or several, or dicts of "
                         "maps {'Cd': path, 'roughness': path}.\n"
                         "tile: whether they continue at their opposite borders; 'auto': where these match.")
            .c_str());
}

void bindTextures(py::module_& module) {
    py::class_<CoordinateLevelStats>(module, "CoordinateLevelStats", "What one level of the hierarchy did.")
        .def_readonly("sites", &CoordinateLevelStats::sites)
        .def_readonly("step", &CoordinateLevelStats::step)
        .def_readonly("coherent", &CoordinateLevelStats::coherent)
        .def_readonly("cost", &CoordinateLevelStats::cost);
    py::class_<TextureObject>(module, "Texture",
                              "A textured target: coordinates in its samples, and the values there.")
        .def_readonly("target", &TextureObject::shape, "The TextureTarget.")
        .def_property_readonly(
            "coordinate", [](const TextureObject& self) { return arrayOf(self.result.sites.coordinate); },
            "float32 [sites, 2]: u, v in texels of the sample, from its lower left corner, right and up.")
        .def_property_readonly(
            "sample", [](const TextureObject& self) { return arrayOf(self.result.sites.sample); },
            "int32 [sites]: number of the sample; -1: none.")
        .def_property_readonly(
            "tangent", [](const TextureObject& self) { return arrayOf(self.result.sites.tangent); },
            "float32 [sites, 3]: the direction of +u, of length 1.")
        .def_property_readonly(
            "values",
            [](const TextureObject& self) {
                const py::ssize_t sites = py::ssize_t(self.shape.site.size());
                const py::ssize_t channels = sites ? py::ssize_t(self.result.sites.values.size()) / sites : 0;
                return py::array_t<float>({sites, channels}, self.result.sites.values.data());
            },
            "float32 [sites, channels] of all maps, as TextureSample.image.")
        .def_property_readonly(
            "attributes",
            [](const TextureObject& self) {
                return dictOf(textureAttributes(self.shape, self.result, self.samples));
            },
            "A dict of arrays [elements, ...]: Cd, other maps, source_u, source_v, source_exemplar, "
            "source_tangent.")
        .def_property_readonly(
            "points", [](const TextureObject& self) { return arrayOf(placesOf(self)); },
            "float32 [elements, 3], world, relative to target.origin, displaced.")
        .def_property_readonly(
            "texel", [](const TextureObject& self) { return self.result.texel; },
            "[world] side of a texel on the surface.")
        .def_property_readonly(
            "levels", [](const TextureObject& self) { return self.result.levels; },
            "A list of CoordinateLevelStats.")
        .def(
            "displace",
            [](const TextureObject& self, const std::string& map, double amplitude) {
                TextureObject moved = self;
                displace(moved.shape, moved.result, moved.samples, map, amplitude);
                return moved;
            },
            py::arg("map"), py::arg("amplitude"),
            "Moved along its normals by amplitude [world] times a map's value: a new Texture.")
        .def("write", writeTexture, py::arg("paths"),
             documented<TextureOutputOptions, Call>(
                 "Texture.write",
                 "Writes one path or several: .ply, .obj, .off, .glb, .gltf, .3mf, .vdb, and with bake=True "
                 "pictures .png and .exr.")
                 .c_str());
    module.def(
        "texture", texture, py::arg("target"), py::arg("samples"), py::arg("labels") = py::none(),
        documented<TextureOptions, Call>("texture",
                                         "Colours a target (TextureTarget, LevelSet, Mesh or PointCloud) "
                                         "like one TextureSample or several: a Texture.\n"
                                         "labels: which sample goes where: 'auto' (by shape), a LevelSet (1 "
                                         "inside), a Grid of numbers, the name of an attribute,\n"
                                         "or an array of numbers, one a site.")
            .c_str());
    module.def("repeat_texture", repeatTextured, py::arg("path"), py::arg("samples"),
               documented<Call>(
                   "repeat_texture",
                   "The coordinates of a textured .ply read in other samples of the same layout: a Texture.")
                   .c_str());
}

}  // namespace

Regions regionsFrom(const std::string& name, py::handle value) {
    using Labels = std::vector<std::int32_t>;
    if (value.is_none()) return {};
    if (py::isinstance<py::str>(value)) {
        const std::string word = py::cast<std::string>(value);
        return {[word](const TextureShape& shape, std::size_t samples, const RunContext& ctx) {
            return word == "auto" ? labelsByShape(shape, samples, ctx) : labelsOf(shape, word, samples);
        }};
    }
    if (py::isinstance<LevelSet>(value))
        return {[model = modelFrom(name, value)](const TextureShape& shape, std::size_t, const RunContext&) {
            return labelsInside(shape, model);
        }};
    if (py::isinstance<GridObject>(value))
        return {
            [grid = gridFrom(name, value)](const TextureShape& shape, std::size_t samples,
                                           const RunContext&) { return labelsIn(shape, *grid, samples); }};
    const auto array = py::array_t<std::int64_t, py::array::c_style>::ensure(value);
    if (!array || array.ndim() != 1) {
        PyErr_Clear();
        refuse(name, "'auto', the name of an attribute, a LevelSet, a Grid or an array of whole numbers",
               value);
    }
    Labels numbers;
    for (py::ssize_t i = 0; i < array.size(); ++i)
        numbers.push_back(std::int32_t(std::clamp<std::int64_t>(array.data()[i], INT32_MIN, INT32_MAX)));
    return {[name, labels = std::move(numbers)](const TextureShape& shape, std::size_t samples,
                                                const RunContext&) {
        if (labels.size() != shape.site.size())
            throw Error(ErrorCode::ShapeMismatch, "`" + name + "`: holds " + std::to_string(labels.size()) +
                                                      " numbers, but the target has " +
                                                      std::to_string(shape.site.size()) + " sites");
        for (const std::int32_t label : labels)
            if (label < 0 || std::size_t(label) >= samples)
                throw Error(ErrorCode::InvalidOption, "`" + name + "` " + std::to_string(label) +
                                                          ": must be the number of one of the " +
                                                          std::to_string(samples) + " samples, from 0");
        return labels;
    }};
}

void bindTexture(py::module_& module) {
    bindInputs(module);
    bindTextures(module);
}

}  // namespace vdbsynth::python
