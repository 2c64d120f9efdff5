#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <string>
#include <vector>

// Shared by the writer and the reader of source maps; for their .cpp files only.
namespace vdbsynth::mapfile {

inline constexpr const char* kFormat = "2";
inline constexpr const char* kFirstKernel = "first";
inline constexpr const char* kNeighbourKernel = "27/(1+d^2)";

inline std::string key(const std::string& name) {
    return "vdbsynth:map:" + name;
}

/// The first exemplar's entries have no number.
inline std::string numbered(const std::string& name, std::size_t e) {
    return e == 0 ? name : name + "_" + std::to_string(e);
}

/// A vector of a Vec3I or Vec3S grid, as doubles.
template <typename Value>
Vec3d vectorOf(const Value& value) {
    return {double(value.x()), double(value.y()), double(value.z())};
}

}  // namespace vdbsynth::mapfile
