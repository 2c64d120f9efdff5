// The one file with Boost.Python.
#include "libvdbsynth/vdb/grid_kinds.h"

#include <boost/python.hpp>

#include "python/vdbsynth/pyopenvdb_grids.h"

namespace vdbsynth::python {
namespace {

// The pointer that the object holds, so that no reference to the object itself is kept: its last owner may be
// a thread without the interpreter's lock.
template <typename GridType>
GridPtr extracted(PyObject* object) {
    const boost::python::extract<typename GridType::Ptr&> held(object);
    return held.check() ? GridPtr(held()) : nullptr;
}

template <typename GridType>
PyObject* wrapped(const GridPtr& grid) {
    const auto typed = openvdb::GridBase::grid<GridType>(grid);
    if (!typed) return nullptr;
    try {
        const boost::python::object object(typed);
        return boost::python::incref(object.ptr());
    } catch (const boost::python::error_already_set&) {
        PyErr_Clear();  // a type that this pyopenvdb was built without
        return nullptr;
    }
}

}  // namespace

GridPtr fromPyopenvdb(pybind11::handle value) {
    if (GridPtr grid = extracted<openvdb::FloatGrid>(value.ptr())) return grid;
    if (GridPtr grid = extracted<openvdb::Vec3SGrid>(value.ptr())) return grid;
    return extracted<openvdb::BoolGrid>(value.ptr());
}

pybind11::object toPyopenvdb(const GridPtr& grid) {
    pybind11::module_::import("pyopenvdb");
    PyObject* object = wrapped<openvdb::FloatGrid>(grid);
    if (!object) object = wrapped<openvdb::Vec3SGrid>(grid);
    if (!object) object = wrapped<openvdb::BoolGrid>(grid);
    if (!object)
        throw pybind11::type_error("pyopenvdb has no class for grids of type " + grid->type() +
                                   "; to_numpy gives its values");
    return pybind11::reinterpret_steal<pybind11::object>(object);
}

}  // namespace vdbsynth::python
