// NIfTI-1, placed by its sform and, for programs that read only that, the same as a qform.
#include "libvdbsynth/io/writers/volume_writers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace vdbsynth {
namespace {

// Fields at their places in the header.
class Header {
public:
    Header() : mBytes(kSize, '\0') {}
    void whole(std::size_t at, std::int64_t value, int bytes) {
        std::string text;
        appendLittle(text, std::uint64_t(value), bytes);
        mBytes.replace(at, text.size(), text);
    }
    void real(std::size_t at, double value) {
        const float narrow = float(value);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &narrow, sizeof bits);
        whole(at, bits, 4);
    }
    void text(std::size_t at, const std::string& value) { mBytes.replace(at, value.size(), value); }
    const std::string& bytes() const { return mBytes; }

    static constexpr std::size_t kSize = 352;  // with the four bytes that say: no extensions

private:
    std::string mBytes;
};

// The unit quaternion a, b, c, d of a rotation, a not negative: from the largest of the four, by the sums
// and differences of the matrix.
std::array<double, 4> quaternionOf(const std::array<Vec3d, 3>& axes) {
    const auto m = [&](int row, int column) { return axes[std::size_t(column)][row]; };
    const std::array<double, 4> squares{1 + m(0, 0) + m(1, 1) + m(2, 2), 1 + m(0, 0) - m(1, 1) - m(2, 2),
                                        1 - m(0, 0) + m(1, 1) - m(2, 2), 1 - m(0, 0) - m(1, 1) + m(2, 2)};
    const std::size_t largest =
        std::size_t(std::max_element(squares.begin(), squares.end()) - squares.begin());
    const double twice = std::sqrt(squares[largest]);  // twice the largest
    const double zy = m(2, 1) - m(1, 2), xz = m(0, 2) - m(2, 0), yx = m(1, 0) - m(0, 1);
    const double xy = m(0, 1) + m(1, 0), zx = m(0, 2) + m(2, 0), yz = m(1, 2) + m(2, 1);
    const std::array<std::array<double, 4>, 4> rows{{{twice * twice, zy, xz, yx},
                                                     {zy, twice * twice, xy, zx},
                                                     {xz, xy, twice * twice, yz},
                                                     {yx, zx, yz, twice * twice}}};
    std::array<double, 4> q = rows[largest];
    const double scale = (q[0] < 0 ? -0.5 : 0.5) / twice;
    for (double& part : q) part *= scale;
    return q;
}

void placeByQuaternion(const VolumeHead& head, double cell, Header& header) {
    std::array<Vec3d, 3> axes;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t row = 0; row < 3; ++row) axes[axis][int(row)] = head.toWorld[4 * axis + row] / cell;
    const bool mirrored = determinant(head.toWorld) < 0;
    // A reflection is a rotation after slices are counted backwards.
    if (mirrored) axes[2] = axes[2] * -1.0;
    header.real(76, mirrored ? -1 : 1);
    const std::array<double, 4> q = quaternionOf(axes);
    for (std::size_t i = 0; i < 3; ++i) {
        header.real(256 + 4 * i, q[i + 1]);
        header.real(268 + 4 * i, head.toWorld[12 + i]);
    }
}

}  // namespace

int niftiUnit(const std::string& unit) {
    return unit == "m" ? 1 : unit == "mm" ? 2 : unit == "um" ? 3 : 0;
}

double niftiError(const VolumeHead& head) {
    double most = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        const auto error = [&](std::size_t column) {
            const double value = head.toWorld[4 * column + row];
            return std::abs(double(float(value)) - value);
        };
        double moved = error(3);
        for (int axis = 0; axis < 3; ++axis) moved += error(std::size_t(axis)) * (head.size[axis] - 1);
        most = std::max(most, moved);
    }
    return most / cellOf(head);
}

VolumeFrame niftiFrame(const VolumeHead& head) {
    constexpr int kUint8 = 2, kFloat32 = 16, kOfTheScanner = 1;
    const double cell = cellOf(head);
    Header header;
    header.whole(0, 348, 4);
    header.whole(40, 3, 2);
    for (int i = 1; i < 8; ++i) header.whole(std::size_t(40 + 2 * i), i < 4 ? head.size[i - 1] : 1, 2);
    header.whole(70, head.bytes ? kUint8 : kFloat32, 2);
    header.whole(72, head.bytes ? 8 : 32, 2);
    for (int i = 1; i < 8; ++i) header.real(std::size_t(76 + 4 * i), i < 4 ? cell : 1);
    header.real(108, double(Header::kSize));
    header.real(112, 1);  // values are those stored
    header.whole(123, niftiUnit(head.unit), 1);
    header.real(124, head.high);
    header.real(128, head.low);
    header.text(148, ("vdb_synth: " + head.name).substr(0, 79));
    header.whole(252, kOfTheScanner, 2);
    header.whole(254, kOfTheScanner, 2);
    placeByQuaternion(head, cell, header);
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            header.real(280 + 16 * row + 4 * column, head.toWorld[4 * column + row]);
    header.text(344, std::string("n+1\0", 4));
    VolumeFrame frame;
    frame.head = header.bytes();
    return frame;
}

}  // namespace vdbsynth
