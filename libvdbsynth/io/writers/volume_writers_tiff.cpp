// TIFF of a page a slice, as ImageJ writes stacks: all samples, then the pages' directories.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/writers/volume_writers.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::uint64_t kClassicEnd = 0xffffffff;

std::string description(const VolumeHead& head) {
    const double cell = cellOf(head);
    const std::string slices = std::to_string(head.size.z);
    std::string text = "ImageJ=1.53\nimages=" + slices + "\nslices=" + slices + "\n";
    if (!head.unit.empty()) text += "unit=" + head.unit + "\n";
    text += "spacing=" + exactText(cell) + "\nloop=false\nmin=" + exactText(head.low) +
            "\nmax=" + exactText(head.high) + "\n";
    // ImageJ counts where the world's zero lies from the first sample.
    for (int axis = 0; axis < 3 && runsAlongWorld(head); ++axis) {
        const double place = head.toWorld[std::size_t(12 + axis)];
        if (place != 0)
            text += std::string(1, char('x' + axis)) + "origin=" + exactText(-place / cell) + "\n";
    }
    return text + '\0';
}

// Samples in a unit of length as a fraction of 32-bit numbers, to 1e-9 of itself or better.
void appendResolution(std::string& text, double cell) {
    constexpr double kMost = 4294967295.0;
    double over = 1, under = 1;
    bool plain = false;
    // Cells that are short decimals keep them.
    for (double factor = 1; factor <= 1e6 && !plain; factor *= 10) {
        over = factor;
        under = std::round(cell * factor);
        plain = under >= 1 && under <= kMost && std::abs(under - cell * factor) <= 1e-12 * under;
    }
    if (!plain && cell >= 1) {
        over = std::max(1.0, std::floor(kMost / cell));
        under = std::min(kMost, std::round(over * cell));
    } else if (!plain) {
        under = std::max(1.0, std::floor(kMost * cell));
        over = std::min(kMost, std::round(under / cell));
    }
    appendLittle(text, std::uint64_t(over), 4);
    appendLittle(text, std::uint64_t(under), 4);
}

// One page's directory, its tags in ascending order.
class Directory {
public:
    explicit Directory(bool big) : mBig(big) {}
    void add(int tag, int type, std::uint64_t count, std::uint64_t value) {
        appendLittle(mEntries, std::uint64_t(tag), 2);
        appendLittle(mEntries, std::uint64_t(type), 2);
        appendLittle(mEntries, count, mBig ? 8 : 4);
        appendLittle(mEntries, value, mBig ? 8 : 4);
        ++mCount;
    }
    std::string bytes(std::uint64_t next) const {
        std::string text;
        appendLittle(text, mCount, mBig ? 8 : 2);
        text += mEntries;
        appendLittle(text, next, mBig ? 8 : 4);
        return text;
    }

private:
    bool mBig;
    std::uint64_t mCount = 0;
    std::string mEntries;
};

// Where the parts of a file lie, from its begin.
struct Places {
    std::uint64_t samples = 0, text = 0, textSize = 0, resolution = 0;
};

Directory pageOf(const VolumeHead& head, const Places& places, bool big, int page) {
    constexpr int kAscii = 2, kShort = 3, kLong = 4, kRational = 5, kLong8 = 16;
    const std::uint64_t slice = sampleBytes(head) / std::uint64_t(head.size.z);
    const int offset = big ? kLong8 : kLong;
    Directory directory(big);
    directory.add(254, kLong, 1, 0);
    directory.add(256, kLong, 1, std::uint64_t(head.size.x));
    directory.add(257, kLong, 1, std::uint64_t(head.size.y));
    directory.add(258, kShort, 1, head.bytes ? 8 : 32);
    directory.add(259, kShort, 1, 1);  // not compressed
    directory.add(262, kShort, 1, 1);  // black is zero
    if (page == 0) directory.add(270, kAscii, places.textSize, places.text);
    directory.add(273, offset, 1, places.samples + std::uint64_t(page) * slice);
    directory.add(277, kShort, 1, 1);
    directory.add(278, kLong, 1, std::uint64_t(head.size.y));
    directory.add(279, offset, 1, slice);
    // Of eight bytes, which BigTIFF holds in the directory itself.
    for (const int tag : {282, 283}) directory.add(tag, kRational, 1, places.resolution);
    directory.add(296, kShort, 1, 1);  // the unit is in the description
    directory.add(339, kShort, 1, head.bytes ? 1 : 3);
    return directory;
}

VolumeFrame frameOf(const VolumeHead& head, bool big) {
    const std::string text = description(head);
    std::string resolution;
    appendResolution(resolution, cellOf(head));
    Places places;
    places.samples = big ? 16 : 8;
    const std::uint64_t end = places.samples + sampleBytes(head);
    VolumeFrame frame;
    frame.tail.assign(end % 2, '\0');
    places.text = end + frame.tail.size();
    places.textSize = text.size();
    frame.tail += text;
    if (frame.tail.size() % 2 != end % 2) frame.tail += '\0';
    places.resolution = end + frame.tail.size();
    if (big) {
        places.resolution = 0;
        for (std::size_t i = 8; i-- > 0;)
            places.resolution = places.resolution << 8 | std::uint8_t(resolution[i]);
    } else {
        frame.tail += resolution;
    }
    const std::uint64_t first = end + frame.tail.size();
    for (int page = 0; page < head.size.z; ++page) {
        const Directory directory = pageOf(head, places, big, page);
        const std::uint64_t next = end + frame.tail.size() + directory.bytes(0).size();
        frame.tail += directory.bytes(page + 1 < head.size.z ? next : 0);
    }
    frame.head = std::string("II") + (big ? "\x2b" : "\x2a") + '\0';
    if (big) appendLittle(frame.head, 8, 4);  // offsets of eight bytes
    appendLittle(frame.head, first, big ? 8 : 4);
    return frame;
}

}  // namespace

VolumeFrame tiffFrame(const VolumeHead& head) {
    const VolumeFrame classic = frameOf(head, false);
    const std::uint64_t size = classic.head.size() + sampleBytes(head) + classic.tail.size();
    return size <= kClassicEnd ? classic : frameOf(head, true);
}

}  // namespace vdbsynth
