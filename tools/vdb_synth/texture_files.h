#pragma once
#include "libvdbsynth/pipeline/texture/texture_outputs.h"
#include "tools/vdb_synth/command.h"

#include <vector>

namespace vdbsynth::cli {

/// The images behind the first input, each with its maps of --channel.
/// @throw Error InvalidOption (no image, maps that some images lack, names that are taken)
std::vector<SampleFiles> sampleFilesOf(const Arguments& arguments);

/// Reads them and records them as inputs. @throw Error as readTextureSamples
std::vector<TextureSample> loadSamples(Run& run, const std::vector<SampleFiles>& files, Tiling tiling);

/// --tile.
Tiling tilingOf(const Arguments& arguments);

/// --levels, --passes or --draft, --coherence, --uniformity, --histogram, --max-rotation.
/// @throw Error InvalidOption (--max-rotation with --direction, --draft with --passes)
CoordinateOptions coordinateOptionsOf(const Arguments& arguments);

/// Options of writeTextured, without the metadata. @throw Error InvalidOption
TextureOutputOptions textureOutputsOf(const Run& run);

/// `repeat TEXTURED.ply IMAGE... -o OUT`.
void repeatTextureMap(Run& run);

}  // namespace vdbsynth::cli
