// Pictures of models, as arrays and as files.
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"
#include "python/vdbsynth/pyopenvdb_grids.h"

#include "libvdbsynth/io/frame_path.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/render/render.h"

#include <pybind11/numpy.h>

#include <memory>

namespace vdbsynth::python {
namespace {

// A level set, or the grids of a fog volume, which are told apart without the interpreter's lock.
struct Given {
    std::string name;
    LevelSet model;
    std::vector<GridPtr> grids;
};

bool isGrid(py::handle value) {
    return py::isinstance<GridObject>(value) || fromPyopenvdb(value);
}

Given givenFrom(py::handle value) {
    Given given;
    if (py::isinstance<LevelSet>(value)) {
        given.model = modelFrom("models", value);
    } else if (isGrid(value)) {
        given.grids = {gridFrom("models", value)};
    } else {
        const std::string wanted = "a LevelSet, a Grid of fog, or a list of a fog's grids";
        for (const py::object& grid : elementsFrom("models", value, wanted)) {
            if (!isGrid(grid)) refuse("models", wanted, grid);
            given.grids.push_back(gridFrom("models", grid));
        }
        if (given.grids.empty()) throw Error(ErrorCode::InvalidOption, "`models`: a list of grids is empty");
    }
    return given;
}

std::vector<Given> allGiven(const py::object& models, const std::vector<std::string>& captions) {
    std::vector<Given> all;
    if (py::isinstance<LevelSet>(models) || isGrid(models))
        all.push_back(givenFrom(models));
    else
        for (const py::object& one : elementsFrom("models", models, "a LevelSet, a Grid, or a list of them"))
            all.push_back(givenFrom(one));
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].name = captions.size() == all.size() ? captions[i]
                      : all.size() == 1             ? "the model"
                                                    : "model " + std::to_string(i + 1);
    return all;
}

ShownModel shownOf(const Given& given, const RunContext& ctx) {
    ShownModel shown;
    shown.name = given.name;
    if (given.grids.empty()) {
        shown.model = given.model;
        shown.attributes = given.model.attributes;
        return shown;
    }
    const ShownFog fog = fogOf(given.name, given.grids, "", ctx);
    if (!fog.density)
        throw Error(
            ErrorCode::InvalidOption,
            "`models`: " + given.name +
                " is no fog but distances to a surface; LevelSet.from_openvdb makes a LevelSet of it");
    shown.fog = fog.density;
    shown.attributes = fog.others;
    return shown;
}

// All pictures of a call.
struct Drawn {
    int count = 1, width = 0, height = 0, channels = 3;
    std::vector<std::uint8_t> pixels;  // [count x height x width x channels]

    void add(const Picture& picture, const RunContext& ctx) {
        if (pixels.empty()) {
            width = picture.width;
            height = picture.height;
            channels = picture.channels;
            const double bytes = double(count) * double(picture.pixels.size());
            requireMemory(ctx, bytes,
                          "an array of " + std::to_string(count) + (count == 1 ? " picture" : " pictures"),
                          "draw fewer or smaller ones");
            pixels.reserve(std::size_t(count) * picture.pixels.size());
        }
        pixels.insert(pixels.end(), picture.pixels.begin(), picture.pixels.end());
    }
};

// Without a copy: the array owns the pixels.
py::array arrayOfPictures(Drawn drawn, bool turntable) {
    std::vector<py::ssize_t> shape;
    if (turntable) shape.push_back(drawn.count);
    shape.insert(shape.end(), {drawn.height, drawn.width, drawn.channels});
    auto held = std::make_unique<std::vector<std::uint8_t>>(std::move(drawn.pixels));
    const std::uint8_t* first = held->data();
    const py::capsule owner(held.release(),
                            [](void* all) { delete static_cast<std::vector<std::uint8_t>*>(all); });
    return py::array_t<std::uint8_t>(shape, first, owner);
}

std::vector<std::string> outputsFrom(const py::object& outputs, const RenderOptions& options) {
    if (outputs.is_none()) return {};
    const std::vector<std::string> paths = pathsFrom("outputs", outputs);
    for (const std::string& path : paths) {
        if (extensionOf(path) != "png")
            throw Error(ErrorCode::InvalidOption, "`outputs` " + path + ": unknown extension; must be .png");
        if (options.turntable > 0 && !namesFrames(path))
            throw Error(ErrorCode::InvalidOption,
                        "`turntable`: " + path +
                            " names one file; write #### where a picture's number is to stand, as in "
                            "turn.####.png");
    }
    return paths;
}

py::array render(const py::object& models, const py::object& outputs, const py::kwargs& given) {
    Call call;
    RenderOptions options;
    readKeywords("render", given, options, call);
    const std::vector<Given> all = allGiven(models, options.captions);
    const std::vector<std::string> paths = outputsFrom(outputs, options);
    validate(options, all.size());
    const bool turntable = options.turntable > 0;
    const auto at = [&](const std::string& path, int number) {
        return turntable ? atFrame(path, number) : path;
    };
    Drawn drawn;
    drawn.count = turntable ? options.turntable : 1;
    writeOutputs(call, [&](OutputSet& set, const RunContext& ctx) {
        for (const std::string& path : paths) set.reserve(at(path, 1));
        renderModels(
            all.size(), [&](std::size_t i) { return shownOf(all[i], ctx); }, options,
            [&](int number, const Picture& picture) {
                drawn.add(picture, ctx);
                for (const std::string& path : paths) writePng(set.add(at(path, number)), picture);
            },
            ctx);
    });
    return arrayOfPictures(std::move(drawn), turntable);
}

}  // namespace

void bindRender(py::module_& module) {
    module.def(
        "render", render, py::arg("models"), py::arg("outputs") = py::none(),
        documented<RenderOptions, Call>(
            "render",
            "Draws models side by side: a picture as uint8 [rows, columns, channels], the top row first, "
            "red, "
            "green, blue and, on\n"
            "a transparent background, opacity (not multiplied into the colours); of a turntable [pictures, "
            "rows, columns,\n"
            "channels]. A model is a LevelSet, with its attributes, or fog: a Grid of densities, or a list "
            "of "
            "it and its other\n"
            "grids, such as Cd. `outputs`: a .png or a list of them, written as well; of a turntable with "
            "#### "
            "for a picture's number.")
            .c_str());
}

}  // namespace vdbsynth::python
