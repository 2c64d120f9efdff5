#pragma once
#include "libvdbsynth/relief/base_surface.h"

#include <string>

namespace vdbsynth::cli {

/// The value of --base.
inline BaseKind baseKindOf(const std::string& word) {
    return word == "gaussian"   ? BaseKind::Gaussian
           : word == "flow"     ? BaseKind::Flow
           : word == "normals"  ? BaseKind::Normals
           : word == "quadrics" ? BaseKind::Quadrics
                                : BaseKind::Twicing;
}

}  // namespace vdbsynth::cli
