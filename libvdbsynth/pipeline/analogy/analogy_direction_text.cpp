// Words for directions, apart from what needs grids: options are read without them.
#include "libvdbsynth/pipeline/analogy/analogy.h"

namespace vdbsynth {

bool parseDirection(const std::string& text, DirectionSource& source) {
    using Kind = DirectionSource::Kind;
    if (text == "radial" || text == "curvature") {
        source.kind = text == "radial" ? Kind::Radial : Kind::Automatic;
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
