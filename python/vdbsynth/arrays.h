#pragma once
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/vec2.h"
#include "libvdbsynth/math/vec3.h"

#include <pybind11/numpy.h>

#include <cstddef>
#include <string>
#include <vector>

// Arrays of numbers, copied. Axes are in each function's brackets, the first one slowest.
namespace vdbsynth::python {
namespace py = pybind11;

py::array arrayOf(const std::vector<Vec3f>& rows);  ///< float32 [rows x 3]
py::array arrayOf(const std::vector<Vec3d>& rows);  ///< float64 [rows x 3]
py::array arrayOf(const std::vector<Vec2f>& rows);  ///< float32 [rows x 2]
py::array arrayOf(const Affine& matrix);            ///< float64 [4 x 4], columns are the images of the axes

template <typename Number>
py::array arrayOf(const std::vector<Number>& values) {
    return py::array_t<Number>(py::ssize_t(values.size()), values.data());
}
template <typename Number, std::size_t N>
py::array arrayOf(const std::vector<std::array<Number, N>>& rows) {
    return py::array_t<Number>({py::ssize_t(rows.size()), py::ssize_t(N)},
                               reinterpret_cast<const Number*>(rows.data()));
}

/// @throw TypeError, ValueError (another shape than [rows x 3])
std::vector<Vec3f> rowsFrom(const std::string& name, py::handle value);
/// Indices of vertices [rows x width]. @throw ValueError (another shape, a negative index, one of `count` or
/// more)
std::vector<std::uint32_t> indicesFrom(const std::string& name, py::handle value, std::size_t width,
                                       std::size_t count);

/// A dict of arrays [elements] or [elements x width].
py::dict dictOf(const Attributes& attributes);
Attributes attributesFrom(const std::string& name, py::handle value, std::size_t elements);

/// A picture [rows x columns] or [rows x columns x channels], the top row first; whole numbers of 8 or 16
/// bits become 0 to 1.
SampleImage imageOfArray(const std::string& name, py::handle value);
/// float32 [rows x columns x channels], the top row first.
py::array arrayOfImage(const SampleImage& image);

/// A float32 array in memory order, whatever it was. @param dimensions  0: any
py::array_t<float, py::array::c_style | py::array::forcecast> floatsFrom(const std::string& name,
                                                                         py::handle value,
                                                                         py::ssize_t dimensions);

}  // namespace vdbsynth::python
