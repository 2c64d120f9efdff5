// Masks: boxes, balls, a model's inside, a grid's range.
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/option_keywords.h"

namespace vdbsynth::python {

template <>
struct Words<MaskKind> {
    static constexpr const char* kType = "Literal['box', 'ball', 'inside', 'range']";
    static constexpr std::pair<const char*, MaskKind> kAll[] = {{"box", MaskKind::Box},
                                                                {"ball", MaskKind::Ball},
                                                                {"inside", MaskKind::Inside},
                                                                {"range", MaskKind::Range}};
};

namespace {

FloatGridConstPtr maskedGrid(MaskKind kind, const py::object& given) {
    if (given.is_none()) return nullptr;
    if (kind != MaskKind::Range || py::isinstance<LevelSet>(given)) return modelFrom("model", given).grid;
    const FloatGridPtr floats = asFloat(gridFrom("model", given));
    if (!floats) refuse("model", "a LevelSet or a grid of floats", given);
    return floats;
}

GridObject maskOf(const py::object& word, const py::object& model, const py::kwargs& given) {
    Call call;
    MaskOptions options;
    readKeywords("mask", given, options, call);
    options.kind = Value<MaskKind>::from("kind", word);
    const FloatGridConstPtr grid = maskedGrid(options.kind, model);
    return {call.run([&](const RunContext& ctx) { return makeMask(options, grid, ctx); })};
}

}  // namespace

void bindMask(py::module_& module) {
    module.def(
        "mask", maskOf, py::arg("kind"), py::arg("model") = py::none(),
        documented<MaskOptions, Call>(
            "mask",
            "A mask as a bool Grid named \"mask\", active and True where it holds. `kind` is 'box' (needs "
            "`box`), 'ball' (`center`\n"
            "and `radius`), 'inside' (a LevelSet `model`) or 'range' (`range`, and a LevelSet or a grid of "
            "floats, whose active\n"
            "voxels count). A mask of a model has its voxels.")
            .c_str());
}

}  // namespace vdbsynth::python
