// NumPy's .npy, version 1.
#include "libvdbsynth/io/writers/volume_writers.h"

namespace vdbsynth {

VolumeFrame npyFrame(const VolumeHead& head) {
    // Readers take three or four bytes along the last index for colours.
    const bool likeColours = head.bytes && (head.size.x == 3 || head.size.x == 4);
    std::string text = std::string("{'descr': '") +
                       (!head.bytes   ? "<f4"
                        : likeColours ? "|b1"
                                      : "|u1") +
                       "', 'fortran_order': False, 'shape': (" + std::to_string(head.size.z) + ", " +
                       std::to_string(head.size.y) + ", " + std::to_string(head.size.x) + "), }";
    constexpr std::size_t kBefore = 10, kAligned = 64;
    while ((kBefore + text.size() + 1) % kAligned != 0) text += ' ';
    text += '\n';
    VolumeFrame frame;
    frame.head = std::string("\x93NUMPY\x01\x00", 8);
    appendLittle(frame.head, text.size(), 2);
    frame.head += text;
    return frame;
}

}  // namespace vdbsynth
