#pragma once
#include "python/vdbsynth/call.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/vdb/level_set.h"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace vdbsynth::python {

// What each file adds to the module. Classes first, then what takes and returns them.
void bindGrid(py::module_& module);
void bindShapes(py::module_& module);
void bindModel(py::module_& module);
void bindSynth(py::module_& module);
void bindAnalogy(py::module_& module);
void bindTexture(py::module_& module);
void bindRelief(py::module_& module);
void bindPatch(py::module_& module);
void bindCompare(py::module_& module);
void bindMask(py::module_& module);
void bindRender(py::module_& module);

/// A copy, which shares the grids: another thread of Python may drop its own meanwhile.
LevelSet modelFrom(const std::string& name, py::handle value);
/// Of one, or of a list of them.
std::vector<LevelSet> modelsFrom(const std::string& name, py::handle value);
std::vector<const LevelSet*> pointersTo(const std::vector<LevelSet>& models);
/// Of one path, or of a list of them. @throw Error InvalidOption (none)
std::vector<std::string> pathsFrom(const std::string& name, py::handle value);
/// Grids as a list of vdbsynth.Grid.
py::list gridList(const std::vector<GridPtr>& grids);

/// Writes outputs that appear whole or not at all. @param write  as void(OutputSet&, const RunContext&)
template <typename Write>
void writeOutputs(Call& call, const Write& write) {
    call.run([&](const RunContext& ctx) {
        OutputSet outputs;
        try {
            write(outputs, ctx);
            outputs.commit();
        } catch (const Error& error) {
            throw Error(error.code(), outputs.withoutTemporaries(error.what()));
        }
    });
}

}  // namespace vdbsynth::python
