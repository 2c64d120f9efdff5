#pragma once
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth::python {

/// vdbsynth.Grid: an OpenVDB grid of any type.
struct GridObject {
    GridPtr grid;
};

}  // namespace vdbsynth::python
