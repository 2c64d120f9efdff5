#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/sample_image.h"

#include <string>
#include <utility>
#include <vector>

namespace vdbsynth {

/// One map of a sample: its colour "Cd", or a further map that is synthesised together with it.
struct SampleMap {
    std::string name;
    int first = 0, channels = 3;  ///< of the image's channels
    double white = 0;             ///< of the file's values, 0 where they are real numbers
};

/// A sample of a texture as read from files.
struct TextureSample {
    std::string name;             ///< of its colour's file, without the folder
    SampleImage image;            ///< all maps, values of integer formats from 0 to 1
    std::vector<SampleMap> maps;  ///< the colour first
};

/// The files of a sample.
struct SampleFiles {
    std::string colour;
    std::vector<std::pair<std::string, std::string>> maps;  ///< name and path of each further map
};

/// Whether samples continue at their opposite borders.
enum class Tiling {
    Auto,  ///< where their borders match (borderMismatch)
    Yes,
    No
};

/// The smallest side of a sample. [texels]
inline constexpr int kSmallestSample = 4;
/// Up to this borderMismatch a sample counts as tileable.
inline constexpr double kTileableMismatch = 1.1;

/// How badly opposite borders match: the squared difference of the first and the last column, over that which
/// nine tenths of neighbouring columns do not exceed; the same for rows; the larger of both. Up to 1 where
/// the border looks like any other place, infinite where only the border differs.
double borderMismatch(const SampleImage& image);

/// Reads samples (io/raster_file.h). Colours are always three channels, a grey one three times the same;
/// further maps have one or three. All samples have the same maps.
/// @throw Error as readRaster; InvalidOption (a map named twice, or like an attribute that texturing writes),
/// ShapeMismatch (a map of another size than its colour, samples with different maps), Unusable (under
/// kSmallestSample texels a side, a volume, texels without data), BadData (values that are not finite)
std::vector<TextureSample> readTextureSamples(const std::vector<SampleFiles>& files, Tiling tiling,
                                              const RunContext& ctx = {});

/// @throw Error InvalidOption (as readTextureSamples, from the names alone)
void requireMapNames(const std::vector<SampleFiles>& files);

}  // namespace vdbsynth
