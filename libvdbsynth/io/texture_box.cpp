#include "libvdbsynth/io/texture_box.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"

#include <string_view>
#include <utility>

namespace vdbsynth {
namespace {

const std::string kDomain = "vdbsynth:domain ", kPlane = "vdbsynth:plane ";
const std::pair<const char*, HeightPlane> kPlanes[] = {
    {"xy", HeightPlane::XY}, {"yz", HeightPlane::YZ}, {"zx", HeightPlane::ZX}};

bool beginsWith(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

[[noreturn]] void fail(const std::string& path, const std::string& comment, const std::string& wanted) {
    throw Error(ErrorCode::BadData,
                path + ": its comment \"" + printableText(comment.substr(0, 120)) + "\" is not " + wanted);
}

// True, with the numbers, if `text` is six with commas between.
bool readSix(std::string_view text, double (&numbers)[6]) {
    for (int i = 0; i < 6; ++i) {
        const std::size_t end = text.find(',');
        if ((end == std::string_view::npos) != (i == 5)) return false;
        if (!parseReal(text.substr(0, end), numbers[i])) return false;
        if (i < 5) text.remove_prefix(end + 1);
    }
    return true;
}

void readCorners(const std::string& path, const std::string& comment, TextureBox& box) {
    double numbers[6];
    if (!readSix(std::string_view(comment).substr(kDomain.size()), numbers))
        fail(path, comment, "six numbers x,y,z,X,Y,Z");
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = numbers[axis];
        box.high[axis] = numbers[3 + axis];
        if (!(box.low[axis] < box.high[axis])) fail(path, comment, "a lower and a higher corner");
    }
}

}  // namespace

std::vector<std::string> textureBoxComments(const TextureBox& box) {
    std::string domain = kDomain;
    for (const Vec3d* corner : {&box.low, &box.high})
        for (int axis = 0; axis < 3; ++axis)
            domain += (corner == &box.low && axis == 0 ? "" : ",") + exactText((*corner)[axis]);
    std::vector<std::string> comments{domain};
    for (const auto& [name, plane] : kPlanes)
        if (box.plane && *box.plane == plane) comments.push_back(kPlane + name);
    return comments;
}

std::optional<TextureBox> textureBoxOf(const std::string& path, const std::vector<std::string>& comments) {
    TextureBox box;
    bool found = false;
    for (const std::string& comment : comments) {
        if (beginsWith(comment, kDomain)) {
            readCorners(path, comment, box);
            found = true;
        }
        if (!beginsWith(comment, kPlane)) continue;
        bool known = false;
        for (const auto& [name, plane] : kPlanes)
            if (comment.substr(kPlane.size()) == name) {
                box.plane = plane;
                known = true;
            }
        if (!known) fail(path, comment, "a plane xy, yz or zx");
    }
    if (!found) return std::nullopt;
    return box;
}

}  // namespace vdbsynth
