#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

struct SliceOptions {
    int width = 800, height = 600;  ///< [pixels], 16..8192
    int axis = 2;                   ///< 0, 1, 2: normal of the slice
    double fraction = 0.5;          ///< position in `box` along the axis, 0..1
    bool scaleBar = true;           ///< a bar of a round length in world units, where the picture has room
};

/// @throw Error InvalidOption (a field out of its range, an empty box)
void validate(const SliceOptions& options, const IndexBox& box);

/// A slice through a level set over `box`: inside warm, outside cool, contour lines every voxel of
/// distance, the zero level black. The scale bar is 1, 2 or 5 times a power of ten long, at most a quarter of
/// the picture's width.
/// @throw Error InvalidOption
/// @par Repeats same bits for any number of threads
Picture renderSlice(const openvdb::FloatGrid& grid, const IndexBox& box, const SliceOptions& options = {},
                    const RunContext& ctx = {});

/// The longest of 1, 2, 5 times a power of ten that is not over `most`, above 0.
double roundLength(double most);

}  // namespace vdbsynth
