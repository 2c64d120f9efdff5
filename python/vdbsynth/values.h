#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/raster/raster_options.h"
#include "libvdbsynth/synth/synthesis_options.h"
#include "libvdbsynth/synth/target_size.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Python values as the fields of option structs, and back as text. Every function names the keyword in its
// errors, in backquotes like the library: TypeError for a value of another type, Error InvalidOption for one
// that no value of this type can be.
namespace vdbsynth::python {
namespace py = pybind11;

/// @throw TypeError "`NAME`: must be WANTED, not TYPE"
[[noreturn]] void refuse(const std::string& name, const std::string& wanted, py::handle value);

std::int64_t wholeFrom(const std::string& name, py::handle value, std::int64_t low, std::int64_t high);
double realFrom(const std::string& name, py::handle value);
bool truthFrom(const std::string& name, py::handle value);
/// A str, or a path.
std::string textFrom(const std::string& name, py::handle value);
/// The elements of a list, tuple or array; not of a str. @param wanted  begins the message
std::vector<py::object> elementsFrom(const std::string& name, py::handle value, const std::string& wanted);
IndexBox boxFrom(const std::string& name, py::handle value);
Index3 indexFrom(const std::string& name, py::handle value);
Vec3d placeFrom(const std::string& name, py::handle value);
TargetSize sizeFrom(const std::string& name, py::handle value);
GridPtr gridFrom(const std::string& name, py::handle value);
DirectionSource directionFrom(const std::string& name, py::handle value);
SampleImage imageFrom(const std::string& name, py::handle value);

/// A number as Python writes it: 4.0, 0.25, 1e-05.
std::string realText(double value);
std::string realText(float value);
std::string quoted(const std::string& text);

py::tuple boxTuple(const IndexBox& box);
py::tuple indexTuple(const Index3& index);
py::tuple placeTuple(const Vec3d& place);

/// The words of an enumeration, those of the command line.
template <typename E>
struct Words;

/// How a field of type T is taken from Python: `type` is its annotation in the stubs.
template <typename T, typename = void>
struct Value;

template <>
struct Value<bool> {
    static std::string type() { return "bool"; }
    static std::string text(bool value) { return value ? "True" : "False"; }
    static bool from(const std::string& name, py::handle value) { return truthFrom(name, value); }
};
template <>
struct Value<int> {
    static std::string type() { return "int"; }
    static std::string text(int value) { return std::to_string(value); }
    static int from(const std::string& name, py::handle value) {
        return int(wholeFrom(name, value, INT32_MIN, INT32_MAX));
    }
};
template <>
struct Value<std::uint64_t> {
    static std::string type() { return "int"; }
    static std::string text(std::uint64_t value) { return std::to_string(value); }
    static std::uint64_t from(const std::string& name, py::handle value) {
        return std::uint64_t(wholeFrom(name, value, 0, INT64_MAX));
    }
};
template <>
struct Value<double> {
    static std::string type() { return "float"; }
    static std::string text(double value) { return realText(value); }
    static double from(const std::string& name, py::handle value) { return realFrom(name, value); }
};
template <>
struct Value<float> {
    static std::string type() { return "float"; }
    static std::string text(float value) { return realText(value); }
    static float from(const std::string& name, py::handle value) { return float(realFrom(name, value)); }
};
template <>
struct Value<std::string> {
    static std::string type() { return "str"; }
    static std::string text(const std::string& value) { return quoted(value); }
    static std::string from(const std::string& name, py::handle value) { return textFrom(name, value); }
};
template <>
struct Value<Index3> {
    static std::string type() { return "Index"; }
    static std::string text(const Index3& v) {
        return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
    }
    static Index3 from(const std::string& name, py::handle value) { return indexFrom(name, value); }
};
template <>
struct Value<Vec3d> {
    static std::string type() { return "Place"; }
    static std::string text(const Vec3d& v) {
        return "(" + realText(v.x) + ", " + realText(v.y) + ", " + realText(v.z) + ")";
    }
    static Vec3d from(const std::string& name, py::handle value) { return placeFrom(name, value); }
};
template <>
struct Value<IndexBox> {
    static std::string type() { return "Box"; }
    static std::string text(const IndexBox& box) {
        return "(" + Value<Index3>::text(box.min) + ", " + Value<Index3>::text(box.max) + ")";
    }
    static IndexBox from(const std::string& name, py::handle value) { return boxFrom(name, value); }
};
template <>
struct Value<TargetSize> {
    static std::string type() { return "Size"; }
    static std::string text(const TargetSize& size) { return quoted(size.text()); }
    static TargetSize from(const std::string& name, py::handle value) { return sizeFrom(name, value); }
};
template <>
struct Value<GridConstPtr> {
    static std::string type() { return "GridLike | None"; }
    static std::string text(const GridConstPtr&) { return "None"; }
    static GridConstPtr from(const std::string& name, py::handle value) {
        if (value.is_none()) return nullptr;
        return gridFrom(name, value);
    }
};
template <>
struct Value<DirectionSource> {
    static std::string type() { return "Direction"; }
    static std::string text(const DirectionSource&) { return "'curvature'"; }
    static DirectionSource from(const std::string& name, py::handle value) {
        return directionFrom(name, value);
    }
};
template <>
struct Value<SampleImage> {
    static std::string type() { return "NDArray"; }
    static std::string text(const SampleImage&) { return "..."; }
    static SampleImage from(const std::string& name, py::handle value) { return imageFrom(name, value); }
};

/// A number, or both ends of a range of numbers.
template <>
struct Value<LabelRange> {
    static std::string type() { return "float | tuple[float, float]"; }
    static std::string text(const LabelRange& range) {
        return "(" + realText(range.first) + ", " + realText(range.second) + ")";
    }
    static LabelRange from(const std::string& name, py::handle value);
};
template <>
struct Value<VdbMetadata> {
    static std::string type() { return "Mapping[str, str]"; }
    static std::string text(const VdbMetadata&) { return "{}"; }
    static VdbMetadata from(const std::string& name, py::handle value);
};
/// One word for all axes, or three, of which each may be None.
template <>
struct Value<std::array<std::optional<Border>, 3>> {
    static std::string type() { return "Border | Sequence[Border | None] | None"; }
    static std::string text(const std::array<std::optional<Border>, 3>&) { return "None"; }
    static std::array<std::optional<Border>, 3> from(const std::string& name, py::handle value);
};
/// "xy", or a truth for each axis.
template <>
struct Value<std::array<bool, 3>> {
    static std::string type() { return "str | Sequence[bool]"; }
    static std::string text(const std::array<bool, 3>&) { return "''"; }
    static std::array<bool, 3> from(const std::string& name, py::handle value);
};

template <typename T>
struct Value<std::optional<T>> {
    static std::string type() { return Value<T>::type() + " | None"; }
    static std::string text(const std::optional<T>& value) { return value ? Value<T>::text(*value) : "None"; }
    static std::optional<T> from(const std::string& name, py::handle value) {
        if (value.is_none()) return std::nullopt;
        return Value<T>::from(name, value);
    }
};
template <typename T>
struct Value<std::vector<T>> {
    static std::string type() { return "Sequence[" + element() + "]"; }
    static std::string text(const std::vector<T>&) { return "()"; }
    static std::vector<T> from(const std::string& name, py::handle value) {
        std::vector<T> list;
        for (const py::object& one : elementsFrom(name, value, "a list"))
            list.push_back(Value<T>::from(name, one));
        return list;
    }

private:
    // A list holds no None.
    static std::string element() {
        const std::string whole = Value<T>::type(), none = " | None";
        const std::size_t at = whole.rfind(none);
        return at != std::string::npos && at + none.size() == whole.size() ? whole.substr(0, at) : whole;
    }
};
template <>
struct Value<GridPtr> {
    static std::string type() { return "GridLike"; }
    static std::string text(const GridPtr&) { return "None"; }
    static GridPtr from(const std::string& name, py::handle value) { return gridFrom(name, value); }
};

/// @param words  all of them
[[noreturn]] void refuseWord(const std::string& name, py::handle value,
                             const std::vector<std::string>& words);

template <typename E>
struct Value<E, std::enable_if_t<std::is_enum_v<E>>> {
    static std::string type() { return Words<E>::kType; }
    static std::string text(E value) {
        for (const auto& [word, meaning] : Words<E>::kAll)
            if (meaning == value) return quoted(word);
        return "?";
    }
    static E from(const std::string& name, py::handle value) {
        std::vector<std::string> words;
        const std::string given = py::isinstance<py::str>(value) ? py::cast<std::string>(value) : "";
        for (const auto& [word, meaning] : Words<E>::kAll) {
            if (given == word) return meaning;
            words.push_back(word);
        }
        refuseWord(name, value, words);
    }
};

template <>
struct Words<Border> {
    static constexpr const char* kType = "Border";
    static constexpr std::pair<const char*, Border> kAll[] = {
        {"cut", Border::Cut}, {"object", Border::Object}, {"tile", Border::Tile}};
};
template <>
struct Words<SynthesisMethod> {
    static constexpr const char* kType = "Literal['default', 'exact', 'paper']";
    static constexpr std::pair<const char*, SynthesisMethod> kAll[] = {{"default", SynthesisMethod::Default},
                                                                       {"exact", SynthesisMethod::Exact},
                                                                       {"paper", SynthesisMethod::Paper}};
};
template <>
struct Words<AttributeValues> {
    static constexpr const char* kType = "Literal['copied', 'blended']";
    static constexpr std::pair<const char*, AttributeValues> kAll[] = {{"copied", AttributeValues::Copied},
                                                                       {"blended", AttributeValues::Blended}};
};
template <>
struct Words<HeightPlane> {
    static constexpr const char* kType = "Plane";
    static constexpr std::pair<const char*, HeightPlane> kAll[] = {
        {"xy", HeightPlane::XY}, {"yz", HeightPlane::YZ}, {"zx", HeightPlane::ZX}};
};

}  // namespace vdbsynth::python
