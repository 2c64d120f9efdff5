// What the writers of volumes share.
#include "libvdbsynth/io/writers/volume_writers.h"

#include <cmath>

namespace vdbsynth {

bool runsAlongWorld(const VolumeHead& head) {
    const double cell = cellOf(head);
    for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t row = 0; row < 3; ++row)
            if (std::abs(head.toWorld[4 * column + row] - (row == column ? cell : 0)) > 1e-9 * cell)
                return false;
    return true;
}

std::uint64_t sampleBytes(const VolumeHead& head) {
    return std::uint64_t(head.size.x) * std::uint64_t(head.size.y) * std::uint64_t(head.size.z) *
           (head.bytes ? 1u : 4u);
}

void appendLittle(std::string& text, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i) & 255);
}

}  // namespace vdbsynth
