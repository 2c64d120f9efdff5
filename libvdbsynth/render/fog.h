#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <memory>

namespace vdbsynth {

/// Fog, smoke or a cloud as one: light is absorbed and scattered along each ray through the densities, in
/// steps of a voxel (of large grids a 300th of the longest side), and is hidden from the light and the sky by
/// the fog before it. Light that is scattered several times is three terms of falling absorption
/// [wrenninge2013]. The ground shows the fog's shadow.
///
/// Densities have no common unit, so absorption follows the volume: a cube that holds all its density at the
/// mean density of the dense part (sum of squares / sum) absorbs all but exp(-10 * options.density) across a
/// side. `directions` and `wires` have no meaning here; `colours` tints.
/// @param fog  densities, those below 0 count as 0; any linear transform
/// @throw Error InvalidOption, EmptyInput (no density above 0), BadData (a transform that is not linear, NaN
/// or infinite values, colours of another type), Memory, Cancelled
/// @par Cost  a picture some microseconds a pixel and core that fog covers
/// @par Repeats same bits for any number of threads
std::unique_ptr<Drawing> drawingOfFog(const openvdb::FloatGrid& fog, const PreviewOptions& options = {},
                                      const RunContext& ctx = {});

}  // namespace vdbsynth
