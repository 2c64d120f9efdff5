#include "python/vdbsynth/values.h"

#include "python/vdbsynth/arrays.h"
#include "python/vdbsynth/objects.h"
#include "python/vdbsynth/pyopenvdb_grids.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/control_grids.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace vdbsynth::python {
namespace {

std::string typeName(py::handle value) {
    return value.is_none() ? "None" : std::string(Py_TYPE(value.ptr())->tp_name);
}

std::string shown(py::handle value) {
    return py::cast<std::string>(py::repr(value));
}

template <typename T>
std::string shortest(T value) {
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    std::string text(buffer, end);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

Extent extentFrom(const std::string& name, py::handle value) {
    if (!py::isinstance<py::str>(value)) return Extent::voxels(Value<int>::from(name, value));
    const std::string text = py::cast<std::string>(value);
    const bool multiple = !text.empty() && text.back() == 'x';
    const std::string digits = multiple ? text.substr(0, text.size() - 1) : text;
    // Not strtod, which reads by the host's locale.
    double number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool whole = number == std::floor(number) && std::abs(number) < 1e9;
    if (error != std::errc() || end != digits.data() + digits.size() || (!multiple && !whole))
        throw Error(ErrorCode::InvalidOption,
                    "`" + name + "` " + text +
                        ": must be a whole number of voxels or a multiple such as '2x', for each axis");
    return multiple ? Extent::multiple(number) : Extent::voxels(int(number));
}

}  // namespace

void refuse(const std::string& name, const std::string& wanted, py::handle value) {
    throw py::type_error("`" + name + "`: must be " + wanted + ", not " + typeName(value));
}

void refuseWord(const std::string& name, py::handle value, const std::vector<std::string>& words) {
    if (!py::isinstance<py::str>(value)) refuse(name, "str", value);
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
    throw Error(ErrorCode::InvalidOption,
                "`" + name + "` " + py::cast<std::string>(value) + ": must be one of " + all);
}

std::int64_t wholeFrom(const std::string& name, py::handle value, std::int64_t low, std::int64_t high) {
    if (PyBool_Check(value.ptr()) || !PyIndex_Check(value.ptr())) refuse(name, "int", value);
    const py::object number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (!number) throw py::error_already_set();
    int overflow = 0;
    const long long whole = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
    if (overflow != 0 || whole < low || whole > high)
        throw Error(ErrorCode::InvalidOption, "`" + name + "` " + shown(number) +
                                                  ": must be a whole number from " + std::to_string(low) +
                                                  " to " + std::to_string(high));
    return whole;
}

double realFrom(const std::string& name, py::handle value) {
    const bool number = PyFloat_Check(value.ptr()) || PyIndex_Check(value.ptr()) ||
                        (py::hasattr(value, "__float__") && !py::isinstance<py::str>(value));
    if (PyBool_Check(value.ptr()) || !number) refuse(name, "float", value);
    const double real = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred()) throw py::error_already_set();
    return real;
}

bool truthFrom(const std::string& name, py::handle value) {
    const std::string type = typeName(value);
    if (!PyBool_Check(value.ptr()) && type != "numpy.bool_" && type != "numpy.bool")
        refuse(name, "bool", value);
    return py::cast<bool>(py::bool_(py::reinterpret_borrow<py::object>(value)));
}

std::string textFrom(const std::string& name, py::handle value) {
    if (py::isinstance<py::str>(value)) return py::cast<std::string>(value);
    if (!py::hasattr(value, "__fspath__")) refuse(name, "str or a path", value);
    const py::object path = value.attr("__fspath__")();
    if (!py::isinstance<py::str>(path)) refuse(name, "str or a path", value);
    return py::cast<std::string>(path);
}

std::vector<py::object> elementsFrom(const std::string& name, py::handle value, const std::string& wanted) {
    const bool list = !py::isinstance<py::str>(value) && !py::isinstance<py::bytes>(value) &&
                      !py::isinstance<py::dict>(value) && PySequence_Check(value.ptr());
    if (!list) refuse(name, wanted, value);
    std::vector<py::object> elements;
    for (const py::handle one : py::reinterpret_borrow<py::sequence>(value))
        elements.push_back(py::reinterpret_borrow<py::object>(one));
    return elements;
}

Index3 indexFrom(const std::string& name, py::handle value) {
    const std::vector<py::object> parts = elementsFrom(name, value, "three whole numbers");
    if (parts.size() != 3) refuse(name, "three whole numbers", value);
    return {Value<int>::from(name, parts[0]), Value<int>::from(name, parts[1]),
            Value<int>::from(name, parts[2])};
}

Vec3d placeFrom(const std::string& name, py::handle value) {
    const std::vector<py::object> parts = elementsFrom(name, value, "three numbers");
    if (parts.size() != 3) refuse(name, "three numbers", value);
    return {realFrom(name, parts[0]), realFrom(name, parts[1]), realFrom(name, parts[2])};
}

IndexBox boxFrom(const std::string& name, py::handle value) {
    const std::string wanted = "a box ((i, j, k), (I, J, K)), both corners inclusive";
    std::vector<py::object> parts = elementsFrom(name, value, wanted);
    if (parts.size() == 2) return {indexFrom(name, parts[0]), indexFrom(name, parts[1])};
    if (parts.size() != 6) refuse(name, wanted, value);
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = Value<int>::from(name, parts[std::size_t(axis)]);
        box.max[axis] = Value<int>::from(name, parts[std::size_t(axis + 3)]);
    }
    return box;
}

TargetSize sizeFrom(const std::string& name, py::handle value) {
    const std::string wanted = "three sizes, each whole voxels or a multiple such as '2x'";
    std::vector<py::object> parts;
    if (py::isinstance<py::str>(value)) {
        const py::list split = value.attr("split")(",");
        for (const py::handle part : split) parts.push_back(py::reinterpret_borrow<py::object>(part));
        if (parts.size() != 3)
            throw Error(ErrorCode::InvalidOption, "`" + name + "` " + py::cast<std::string>(value) +
                                                      ": must be " + wanted + ", as in '2x,2x,64'");
    } else {
        parts = elementsFrom(name, value, wanted);
        if (parts.size() != 3) refuse(name, wanted, value);
    }
    return {extentFrom(name, parts[0]), extentFrom(name, parts[1]), extentFrom(name, parts[2])};
}

GridPtr gridFrom(const std::string& name, py::handle value) {
    if (py::isinstance<GridObject>(value)) return py::cast<const GridObject&>(value).grid;
    // A model stands for its grid: a mask is then its inside, where the option says so.
    if (py::isinstance<LevelSet>(value))
        return std::const_pointer_cast<openvdb::GridBase>(asControl(py::cast<const LevelSet&>(value).grid));
    if (GridPtr shared = fromPyopenvdb(value)) return shared;
    refuse(name, "a Grid, a LevelSet or a grid of pyopenvdb", value);
}

DirectionSource directionFrom(const std::string& name, py::handle value) {
    DirectionSource source;
    if (py::isinstance<py::str>(value)) {
        const std::string text = py::cast<std::string>(value);
        if (!parseDirection(text, source))
            throw Error(ErrorCode::InvalidOption,
                        "`" + name + "` " + text +
                            ": must be axis:x, axis:-z, a vector x,y,z, around:y, radial or curvature");
        return source;
    }
    const bool grid = py::isinstance<GridObject>(value) || fromPyopenvdb(value);
    if (grid) {
        source.kind = DirectionSource::Kind::Grid;
        source.grid = gridFrom(name, value);
        return source;
    }
    const std::string wanted = "a word, a Grid, a vector (x, y, z) or strokes [(position, direction), ...]";
    const std::vector<py::object> parts = elementsFrom(name, value, wanted);
    if (parts.size() == 3 && !PySequence_Check(parts[0].ptr())) {
        source.kind = DirectionSource::Kind::Axis;
        source.axis = placeFrom(name, value);
        return source;
    }
    source.kind = DirectionSource::Kind::Strokes;
    for (const py::object& stroke : parts) {
        const std::vector<py::object> both = elementsFrom(name, stroke, wanted);
        if (both.size() != 2) refuse(name, wanted, stroke);
        source.strokes.push_back({placeFrom(name, both[0]), placeFrom(name, both[1])});
    }
    return source;
}

SampleImage imageFrom(const std::string& name, py::handle value) {
    return imageOfArray(name, value);
}

LabelRange Value<LabelRange>::from(const std::string& name, py::handle value) {
    if (!PySequence_Check(value.ptr())) {
        const double one = realFrom(name, value);
        return {one, one};
    }
    const std::vector<py::object> ends = elementsFrom(name, value, "numbers or ranges (low, high)");
    if (ends.size() != 2) refuse(name, "numbers or ranges (low, high)", value);
    return {realFrom(name, ends[0]), realFrom(name, ends[1])};
}

VdbMetadata Value<VdbMetadata>::from(const std::string& name, py::handle value) {
    if (!py::isinstance<py::dict>(value)) refuse(name, "a dict of str", value);
    VdbMetadata metadata;
    for (const auto& [key, text] : py::reinterpret_borrow<py::dict>(value))
        metadata.emplace_back(textFrom(name, key), textFrom(name, text));
    return metadata;
}

std::array<std::optional<Border>, 3> Value<std::array<std::optional<Border>, 3>>::from(
    const std::string& name, py::handle value) {
    if (value.is_none()) return {};
    if (py::isinstance<py::str>(value)) {
        const Border all = Value<Border>::from(name, value);
        return {all, all, all};
    }
    const std::vector<py::object> parts = elementsFrom(name, value, "a word, or one for each axis");
    if (parts.size() != 3) refuse(name, "a word, or one for each axis", value);
    std::array<std::optional<Border>, 3> borders;
    for (std::size_t axis = 0; axis < 3; ++axis)
        borders[axis] = Value<std::optional<Border>>::from(name, parts[axis]);
    return borders;
}

std::array<bool, 3> Value<std::array<bool, 3>>::from(const std::string& name, py::handle value) {
    std::array<bool, 3> axes{};
    if (py::isinstance<py::str>(value)) {
        const std::string text = py::cast<std::string>(value);
        for (const char letter : text) {
            if (letter < 'x' || letter > 'z')
                throw Error(ErrorCode::InvalidOption,
                            "`" + name + "` " + text + ": must be axes, such as xy");
            axes[std::size_t(letter - 'x')] = true;
        }
        return axes;
    }
    const std::vector<py::object> parts = elementsFrom(name, value, "axes, such as 'xy', or three truths");
    if (parts.size() != 3) refuse(name, "axes, such as 'xy', or three truths", value);
    for (std::size_t axis = 0; axis < 3; ++axis) axes[axis] = truthFrom(name, parts[axis]);
    return axes;
}

std::string realText(double value) {
    return shortest(value);
}
std::string realText(float value) {
    return shortest(value);
}

std::string quoted(const std::string& text) {
    return "'" + text + "'";
}

py::tuple indexTuple(const Index3& index) {
    return py::make_tuple(index.x, index.y, index.z);
}
py::tuple boxTuple(const IndexBox& box) {
    return py::make_tuple(indexTuple(box.min), indexTuple(box.max));
}
py::tuple placeTuple(const Vec3d& place) {
    return py::make_tuple(place.x, place.y, place.z);
}

}  // namespace vdbsynth::python
