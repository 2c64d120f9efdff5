#include "python/vdbsynth/arrays.h"

#include "python/vdbsynth/values.h"

#include <algorithm>

namespace vdbsynth::python {
namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

template <typename Number, typename Row>
py::array rowsOf(const std::vector<Row>& rows, py::ssize_t width) {
    static_assert(sizeof(Row) % sizeof(Number) == 0);
    return py::array_t<Number>({py::ssize_t(rows.size()), width},
                               reinterpret_cast<const Number*>(rows.data()));
}

[[noreturn]] void refuseShape(const std::string& name, const std::string& wanted, const py::array& array) {
    std::string shape;
    for (py::ssize_t d = 0; d < array.ndim(); ++d) shape += (d ? " x " : "") + std::to_string(array.shape(d));
    throw py::value_error("`" + name + "`: must be an array of " + wanted + ", not " +
                          (shape.empty() ? "a single number" : "of " + shape));
}

}  // namespace

py::array arrayOf(const std::vector<Vec3f>& rows) {
    return rowsOf<float>(rows, 3);
}
py::array arrayOf(const std::vector<Vec3d>& rows) {
    return rowsOf<double>(rows, 3);
}
py::array arrayOf(const std::vector<Vec2f>& rows) {
    return rowsOf<float>(rows, 2);
}

py::array arrayOf(const Affine& matrix) {
    py::array_t<double> array({4, 4});
    auto to = array.mutable_unchecked<2>();
    for (py::ssize_t column = 0; column < 4; ++column)
        for (py::ssize_t row = 0; row < 4; ++row) to(row, column) = matrix[std::size_t(column * 4 + row)];
    return std::move(array);
}

Floats floatsFrom(const std::string& name, py::handle value, py::ssize_t dimensions) {
    Floats array = Floats::ensure(value);
    if (!array) {
        PyErr_Clear();
        refuse(name, "an array of numbers", value);
    }
    if (dimensions > 0 && array.ndim() != dimensions)
        refuseShape(name, std::to_string(dimensions) + " dimensions", array);
    return array;
}

std::vector<Vec3f> rowsFrom(const std::string& name, py::handle value) {
    const Floats array = floatsFrom(name, value, 0);
    if (array.ndim() != 2 || array.shape(1) != 3) refuseShape(name, "N x 3 numbers", array);
    std::vector<Vec3f> rows(std::size_t(array.shape(0)));
    const float* values = array.data();
    for (Vec3f& row : rows) {
        row = {values[0], values[1], values[2]};
        values += 3;
    }
    return rows;
}

std::vector<std::uint32_t> indicesFrom(const std::string& name, py::handle value, std::size_t width,
                                       std::size_t count) {
    const auto array = py::array_t<std::int64_t, py::array::c_style>::ensure(value);
    if (!array) {
        PyErr_Clear();
        refuse(name, "an array of whole numbers", value);
    }
    if (array.size() == 0) return {};
    if (array.ndim() != 2 || array.shape(1) != py::ssize_t(width))
        refuseShape(name, "N x " + std::to_string(width) + " whole numbers", array);
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t(array.size()));
    for (py::ssize_t i = 0; i < array.size(); ++i) {
        const std::int64_t index = array.data()[i];
        if (index < 0 || std::size_t(index) >= count)
            throw py::value_error("`" + name + "`: holds " + std::to_string(index) + ", but there are " +
                                  std::to_string(count) + " points, numbered from 0");
        indices.push_back(std::uint32_t(index));
    }
    return indices;
}

py::dict dictOf(const Attributes& attributes) {
    py::dict dict;
    for (const Attribute& attribute : attributes) {
        const py::ssize_t width = py::ssize_t(attribute.width),
                          count = py::ssize_t(attribute.values.size()) / width;
        std::vector<py::ssize_t> shape{count};
        if (width > 1) shape.push_back(width);
        dict[py::str(attribute.name)] = py::array_t<float>(shape, attribute.values.data());
    }
    return dict;
}

Attributes attributesFrom(const std::string& name, py::handle value, std::size_t elements) {
    Attributes attributes;
    if (value.is_none()) return attributes;
    if (!py::isinstance<py::dict>(value)) refuse(name, "a dict of arrays", value);
    for (const auto& [key, given] : py::reinterpret_borrow<py::dict>(value)) {
        const std::string own = textFrom(name, key);
        const Floats array = floatsFrom(own, given, 0);
        const bool rows =
            array.ndim() == 1 || (array.ndim() == 2 && array.shape(1) >= 1 && array.shape(1) <= 3);
        if (!rows || std::size_t(array.shape(0)) != elements)
            refuseShape(own, std::to_string(elements) + " rows of 1 to 3 numbers", array);
        Attribute attribute{own, array.ndim() == 1 ? 1 : std::size_t(array.shape(1)), {}};
        attribute.values.assign(array.data(), array.data() + array.size());
        attributes.push_back(std::move(attribute));
    }
    return attributes;
}

SampleImage imageOfArray(const std::string& name, py::handle value) {
    const py::array given = py::array::ensure(value);
    if (!given) {
        PyErr_Clear();
        refuse(name, "an array of rows x columns (x channels)", value);
    }
    const Floats array = floatsFrom(name, value, 0);
    if (array.ndim() < 2 || array.ndim() > 3 || array.size() == 0)
        refuseShape(name, "rows x columns (x channels)", array);
    const char kind = given.dtype().kind();
    const py::ssize_t bytes = given.dtype().itemsize();
    const float white = kind != 'u' ? 1.f : bytes == 1 ? 255.f : bytes == 2 ? 65535.f : 1.f;
    SampleImage image;
    image.height = int(array.shape(0));
    image.width = int(array.shape(1));
    image.channels = array.ndim() == 3 ? int(array.shape(2)) : 1;
    const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
    image.values.resize(std::size_t(array.size()));
    // The library's lowest row comes first.
    for (std::size_t y = 0; y < std::size_t(image.height); ++y)
        for (std::size_t i = 0; i < row; ++i)
            image.values[(std::size_t(image.height) - 1 - y) * row + i] = array.data()[y * row + i] / white;
    return image;
}

py::array arrayOfImage(const SampleImage& image) {
    py::array_t<float> array({image.height, image.width, image.channels});
    const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
    for (std::size_t y = 0; y < std::size_t(image.height); ++y)
        std::copy_n(image.values.data() + (std::size_t(image.height) - 1 - y) * row, row,
                    array.mutable_data() + y * row);
    return std::move(array);
}

}  // namespace vdbsynth::python
