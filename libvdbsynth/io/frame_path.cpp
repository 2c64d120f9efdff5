#include "libvdbsynth/io/frame_path.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace vdbsynth {
namespace {

// The place for a number in a path: its characters, and its least number of digits.
struct FramePlace {
    std::size_t at = std::string::npos, length = 0;
    int digits = 0;
};

FramePlace placeIn(const std::string& path) {
    const std::size_t sign = path.find('#');
    if (sign != std::string::npos) {
        const std::size_t end = std::min(path.find_first_not_of('#', sign), path.size());
        return {sign, end - sign, int(end - sign)};
    }
    // %d, %4d and %04d.
    for (std::size_t at = path.find('%'); at != std::string::npos; at = path.find('%', at + 1)) {
        const std::size_t end = path.find_first_not_of("0123456789", at + 1);
        if (end == std::string::npos || path[end] != 'd' || end - at > 3) continue;
        if (end + 1 < path.size() && std::isalnum(static_cast<unsigned char>(path[end + 1])))
            continue;  // "100%done"
        return {at, end + 1 - at, std::max(1, std::atoi(path.c_str() + at + 1))};
    }
    return {};
}

}  // namespace

bool namesFrames(const std::string& path) {
    return placeIn(path).length > 0;
}

std::string atFrame(const std::string& path, int frame) {
    const FramePlace place = placeIn(path);
    if (place.length == 0) return path;
    std::string number = std::to_string(frame);
    if (int(number.size()) < place.digits) number.insert(0, std::size_t(place.digits) - number.size(), '0');
    return path.substr(0, place.at) + number + path.substr(place.at + place.length);
}

}  // namespace vdbsynth
