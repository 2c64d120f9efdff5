#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/texture/texture_target.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth {

/// The numbers of samples from an attribute of the target, one a site.
/// @throw Error Unusable (no such attribute, several values an element), BadData (a label without a sample)
std::vector<std::int32_t> labelsOf(const TextureShape& shape, const std::string& attribute,
                                   std::size_t samples);

/// 1 inside a model, 0 outside. @param model  its half-width limits nothing: beyond the band the sign counts
std::vector<std::int32_t> labelsInside(const TextureShape& shape, const LevelSet& model);

/// The numbers of samples from a grid, read at the sites: whole numbers are labels; a level set is 1 inside;
/// truths are 0 and 1; other real numbers are 1 above 0.5, between voxels.
/// @throw Error BadData (a grid of another kind, a label without a sample), InvalidOption (more than two
/// samples for a grid that holds no whole numbers)
std::vector<std::int32_t> labelsIn(const TextureShape& shape, const openvdb::GridBase& grid,
                                   std::size_t samples);

/// The numbers of samples by the target's shape (points/site_regions.h), the largest region first. Notes say
/// the regions' shares and what they are bound by.
/// @throw Error as siteRegions
/// @par Repeats same bits for any number of threads
std::vector<std::int32_t> labelsByShape(const TextureShape& shape, std::size_t samples,
                                        const RunContext& ctx = {});

}  // namespace vdbsynth
