#pragma once
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <pybind11/pybind11.h>

// Grids of OpenVDB's own Python module, which is made with Boost.Python: its registry of types is shared by
// all modules that link it, so grids are handed over without a copy.
namespace vdbsynth::python {

/// The grid in an object of pyopenvdb, shared; null for any other object.
GridPtr fromPyopenvdb(pybind11::handle value);

/// A grid as an object of pyopenvdb, shared.
/// @throw ImportError (no pyopenvdb), TypeError (a type of grid that it has no class for)
pybind11::object toPyopenvdb(const GridPtr& grid);

}  // namespace vdbsynth::python
