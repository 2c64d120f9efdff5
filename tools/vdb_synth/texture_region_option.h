#pragma once
#include "libvdbsynth/pipeline/texture/texture_sample.h"
#include "libvdbsynth/pipeline/texture/texture_target.h"
#include "tools/vdb_synth/command.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// What needs no file: whether --region, --region-attribute and --region-blend suit the number of images.
/// @throw Error InvalidOption
void checkRegions(const Arguments& arguments, const std::vector<SampleFiles>& files);

/// Notes what --region-blend does not reach: pictures in files, vectors of normal maps.
void noteUnblended(const Run& run, const std::vector<SampleFiles>& files,
                   const std::vector<std::string>& paths);

/// The number of the image for each site, by --region or --region-attribute; empty without. Images that no
/// site takes are a warning. @throw Error as texture_regions.h, Run::load and Run::loadGrid
std::vector<std::int32_t> regionLabels(Run& run, const TextureShape& shape, std::size_t samples);

}  // namespace vdbsynth::cli
