#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"

#include <nlohmann/json_fwd.hpp>

namespace vdbsynth::cli {

/// What `info` and the report say of a surface: area, signed volume, bounds, closed parts, voids and open
/// parts.
nlohmann::ordered_json surfaceJson(const Mesh& mesh, const RunContext& ctx);

}  // namespace vdbsynth::cli
