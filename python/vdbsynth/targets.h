#pragma once
#include "python/vdbsynth/values.h"

#include "libvdbsynth/pipeline/texture/texture_sample.h"
#include "libvdbsynth/pipeline/texture/texture_target.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace vdbsynth::python {

/// Which sample goes where, as texture and relief take it from Python.
struct Regions {
    /// Numbers of samples at a target's sites. May run without the interpreter's lock.
    /// @throw Error as pipeline/texture/texture_regions.h; ShapeMismatch (another number of labels than
    /// sites), InvalidOption (a label without a sample)
    std::function<std::vector<std::int32_t>(const TextureShape& shape, std::size_t samples,
                                            const RunContext& ctx)>
        labels;
};

/// None: no labels; "auto": by the target's shape; another str: an attribute of the target; a LevelSet: 1
/// inside; a Grid: its numbers; an array: a number for each site.
Regions regionsFrom(const std::string& name, py::handle value);

}  // namespace vdbsynth::python
