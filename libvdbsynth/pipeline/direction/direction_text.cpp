// Words for directions, apart from what needs grids: options are read without them.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/pipeline/direction/direction.h"

#include <cmath>

namespace vdbsynth {
namespace {

using Kind = DirectionSource::Kind;

bool parseVector(const std::string& text, Vec3d& vector) {
    std::size_t begin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = axis < 2 ? text.find(',', begin) : text.size();
        if (comma == std::string::npos || !parseReal(text.substr(begin, comma - begin), vector[axis]))
            return false;
        begin = comma + 1;
    }
    return std::isfinite(dot(vector, vector)) && dot(vector, vector) > 0;
}

}  // namespace

bool parseDirection(const std::string& text, DirectionSource& source) {
    if (text == "radial" || text == "curvature") {
        source.kind = text == "radial" ? Kind::Radial : Kind::Automatic;
        return true;
    }
    if (parseVector(text, source.axis)) {
        source.kind = Kind::Axis;
        return true;
    }
    const std::size_t colon = text.find(':');
    const std::string head = text.substr(0, colon);
    if (colon == std::string::npos || (head != "axis" && head != "around")) return false;
    std::string tail = text.substr(colon + 1);
    const bool back = !tail.empty() && tail[0] == '-';
    if (back) tail.erase(0, 1);
    if (tail != "x" && tail != "y" && tail != "z") return false;
    source.kind = head == "axis" ? Kind::Axis : Kind::Around;
    source.axis = {0, 0, 0};
    source.axis[tail[0] - 'x'] = back ? -1 : 1;
    return true;
}

}  // namespace vdbsynth
