// The module vdbsynth._vdbsynth: its error, and what the other files add.
#include "python/vdbsynth/bind.h"
#include "python/vdbsynth/option_keywords.h"

#include <pybind11/stl.h>

#include <exception>

namespace vdbsynth::python {
namespace {

const char* nameOfCode(ErrorCode code) {
    switch (code) {
        case ErrorCode::InvalidOption:
            return "InvalidOption";
        case ErrorCode::ShapeMismatch:
            return "ShapeMismatch";
        case ErrorCode::EmptyInput:
            return "EmptyInput";
        case ErrorCode::Unusable:
            return "Unusable";
        case ErrorCode::Io:
            return "Io";
        case ErrorCode::BadData:
            return "BadData";
        case ErrorCode::Memory:
            return "Memory";
        case ErrorCode::Solver:
            return "Solver";
        case ErrorCode::Cancelled:
            return "Cancelled";
    }
    return "Solver";
}

// Lives as long as the process, like the types that pybind11 registers.
PyObject* errorType = nullptr;

void raise(const Error& error) {
    try {
        const py::object value = py::reinterpret_borrow<py::object>(errorType)(error.what());
        value.attr("code") = nameOfCode(error.code());
        value.attr("exit_code") = exitCode(error.code());
        PyErr_SetObject(errorType, value.ptr());
    } catch (py::error_already_set& other) {
        other.restore();
    }
}

void bindError(py::module_& module) {
    errorType = PyErr_NewExceptionWithDoc(
        "vdbsynth.Error",
        "What failed, in one line that names the file, the input or the keyword (in backquotes). `code` is "
        "the name of the\n"
        "library's ErrorCode (docs/api.md), `exit_code` the command line's exit code for it.",
        PyExc_Exception, nullptr);
    if (!errorType) throw py::error_already_set();
    module.attr("Error") = py::reinterpret_borrow<py::object>(errorType);
    py::register_exception_translator([](std::exception_ptr pointer) {
        try {
            if (pointer) std::rethrow_exception(pointer);
        } catch (const Error& error) {
            raise(error);
        }
    });
}

// (name, type, default, text) of each.
py::list keywordList(const std::string& function) {
    const auto& all = keywordsOfFunctions();
    const auto found = all.find(function);
    if (found == all.end()) throw py::key_error(function + ": no function with keywords");
    py::list list;
    for (const Keyword& keyword : found->second)
        list.append(py::make_tuple(keyword.name, keyword.type, keyword.initial, keyword.about));
    return list;
}

py::list functionsWithKeywords() {
    py::list names;
    for (const auto& [name, keywords] : keywordsOfFunctions()) names.append(name);
    return names;
}

}  // namespace

PYBIND11_MODULE(_vdbsynth, module) {
    module.doc() = "The methods of vdb_synth on level sets in memory.";
    module.attr("__version__") = VDBSYNTH_VERSION;
    // Classes and texts name the package, where people find them.
    const py::object own = module.attr("__name__");
    module.attr("__name__") = "vdbsynth";
    bindError(module);
    bindGrid(module);
    bindShapes(module);
    bindModel(module);
    bindSynth(module);
    bindAnalogy(module);
    bindTexture(module);
    bindRelief(module);
    bindPatch(module);
    bindCompare(module);
    bindMask(module);
    bindRender(module);
    module.def("keywords", keywordList, py::arg("function"),
               "Keywords of a function or method, such as \"synth\" or \"LevelSet.write\": a list of (name, "
               "type, default, text).");
    module.def("functions_with_keywords", functionsWithKeywords, "All names that keywords() takes.");
    // What wrote into the options that the texts were made of.
    for (auto& [function, keywords] : keywordsOfFunctions())
        for (Keyword& keyword : keywords) keyword.take.clear();
    module.attr("__name__") = own;
}

}  // namespace vdbsynth::python
