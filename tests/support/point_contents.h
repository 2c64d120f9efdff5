#pragma once
#include "libvdbsynth/io/points/point_readers.h"

#include <string>

namespace vdbsynth::test {

/// What a reader of points made of a text, and what it said, one message a line; warnings begin with "! ".
struct PointsRead {
    PointContent cloud;
    std::string said;

    std::vector<float> attribute(const std::string& name) const {
        const Attribute* found = findAttribute(cloud.attributes, name);
        return found ? found->values : std::vector<float>{};
    }
};

using PointReader = PointContent (*)(const std::string&, const std::string&, const RunContext&);

inline PointsRead readBy(PointReader reader, const std::string& content, const std::string& path) {
    PointsRead read;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        read.said += (level == MessageLevel::Warning ? "! " : "") + text + "\n";
    };
    read.cloud = reader(path, content, ctx);
    return read;
}

inline PointsRead rowsOf(const std::string& content, const std::string& path = "a.xyz") {
    return readBy(readRows, content, path);
}

template <typename T>
bool equal(const Vec3<T>& a, const Vec3d& b) {
    return double(a.x) == b.x && double(a.y) == b.y && double(a.z) == b.z;
}

}  // namespace vdbsynth::test
