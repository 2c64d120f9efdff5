#include "libvdbsynth/io/readers/orientation.h"

#include <cstdint>
#include <utility>

namespace vdbsynth {
namespace {

// Numbers of an EXIF block in its byte order; 0 beyond its end.
class ExifNumbers {
public:
    explicit ExifNumbers(std::string_view block) : mBlock(block), mBigEndian(block.substr(0, 2) == "MM") {}
    bool valid() const {
        return mBlock.size() >= 8 && (mBigEndian || mBlock.substr(0, 2) == "II") && at(2, 2) == 42;
    }
    std::uint32_t at(std::uint64_t offset, std::uint64_t bytes) const {
        if (offset > mBlock.size() || bytes > mBlock.size() - offset) return 0;
        std::uint32_t value = 0;
        for (std::uint64_t i = 0; i < bytes; ++i) {
            const std::uint64_t place = mBigEndian ? offset + i : offset + bytes - 1 - i;
            value = value << 8 | std::uint32_t(static_cast<unsigned char>(mBlock[std::size_t(place)]));
        }
        return value;
    }

private:
    std::string_view mBlock;
    bool mBigEndian;
};

// Where a pixel of the upright picture is stored.
Index3 storedAt(int x, int y, const Index3& stored, int orientation) {
    const int right = stored.x - 1, low = stored.y - 1;
    switch (orientation) {
        case 2:
            return {right - x, y, 0};
        case 3:
            return {right - x, low - y, 0};
        case 4:
            return {x, low - y, 0};
        case 5:
            return {y, x, 0};
        case 6:
            return {y, low - x, 0};
        case 7:
            return {right - y, low - x, 0};
        case 8:
            return {right - y, x, 0};
        default:
            return {x, y, 0};
    }
}

}  // namespace

int exifOrientation(std::string_view block) {
    constexpr std::uint32_t kOrientation = 274, kShort = 3, kLong = 4, kEntryBytes = 12;
    const ExifNumbers numbers(block);
    if (!numbers.valid()) return 1;
    const std::uint64_t directory = numbers.at(4, 4);
    const std::uint32_t entries = numbers.at(directory, 2);
    for (std::uint32_t i = 0; i < entries; ++i) {
        const std::uint64_t entry = directory + 2 + std::uint64_t(i) * kEntryBytes;
        if (entry + kEntryBytes > block.size()) break;
        if (numbers.at(entry, 2) != kOrientation || numbers.at(entry + 4, 4) != 1) continue;
        const std::uint32_t type = numbers.at(entry + 2, 2);
        const std::uint32_t value = numbers.at(entry + 8, type == kLong ? 4 : type == kShort ? 2 : 1);
        return value > 65535 ? 65535 : int(value);
    }
    return 1;
}

void turnUpright(const std::string& path, Raster& raster, int orientation, const std::string& source,
                 const RunContext& ctx) {
    if (orientation < 0 || orientation > 8) {
        message(ctx, MessageLevel::Note,
                path + ": its " + source + " " + std::to_string(orientation) +
                    " is none (they are 1 to 8); read as it is stored");
        return;
    }
    if (orientation < 2) return;
    requireMemory(ctx, double(raster.values.size()) * 2 * sizeof(float), path, "crop or shrink it first");
    const Index3 stored = raster.size;
    const std::size_t channels = std::size_t(raster.channels);
    Raster turned = raster;
    if (orientation > 4) {
        std::swap(turned.size.x, turned.size.y);
        std::swap(turned.spacing.x, turned.spacing.y);
    }
    for (int z = 0; z < stored.z; ++z)
        for (int y = 0; y < turned.size.y; ++y)
            for (int x = 0; x < turned.size.x; ++x) {
                const Index3 from = storedAt(x, y, stored, orientation);
                for (std::size_t c = 0; c < channels; ++c)
                    turned.values[turned.index(x, y, z) * channels + c] =
                        raster.values[raster.index(from.x, from.y, z) * channels + c];
            }
    raster = std::move(turned);
    message(ctx, MessageLevel::Note,
            path + ": turned upright as its " + source + " " + std::to_string(orientation) + " says");
}

}  // namespace vdbsynth
