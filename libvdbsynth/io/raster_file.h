#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster.h"

#include <string>

namespace vdbsynth {

/// True if the path ends, in any case and with or without .gz, in an extension of an image: .png, .jpg,
/// .jpeg, .pgm, .ppm, .pnm, .tif, .tiff, .exr; or of a volume: .npy, .vti, .nii, .sgems, .inr. A .tif of
/// several pages and an .npy of three dimensions are volumes; an .npy of two dimensions is an image.
bool isRasterPath(const std::string& path);
/// The extensions of isRasterPath in words, for messages.
extern const char* const kRasterExtensions;

struct RasterReadOptions {
    /// Which array, channel or frame of a file that holds several, by its name in Raster::arrays; empty: the
    /// one that the format's writers mean by default, said in a note.
    std::string array;
};

/// Reads an image or a volume. Sizes are checked against the file's size or `maxMemory`
/// before memory is allocated.
/// - png (1 to 16 bits, palettes), jpg, pgm and ppm (ascii or binary, to 16 bits), tif (8 to 64 bits, integer
///   or float, strips or tiles, GDAL's no-data value, GeoTIFF's pixel size: metres, or degrees converted to
///   metres at the image's middle), exr (Y, else R G B, else the first channel). A pixel of alpha zero has no
///   data; other alpha is ignored.
/// - npy (any real type, either order: the last index runs along columns; two or three dimensions, of four
///   the first or a short last one counts channels, of three a last one of 3 or 4 bytes holds colours),
///   vti (ascii, inline and appended base64, raw, zlib; one or more pieces; values of points or cells,
///   vectors by their length; origin, spacing and direction), nii (NIfTI-1 and 2; placed by sform, qform or
///   voxel sizes, in this order; frames as `volume1`, ...), sgems and gslib text (one of its variables), inr.
///   Axes are exchanged and reversed to point along those of the world; a rotation that remains is in
///   Raster::axes.
/// @throw Error Io, BadData (truncated, corrupt, an unsupported kind of file or data, no array of that name),
/// EmptyInput (no samples), Memory, InvalidOption (extension)
/// @par Cost    O(samples), four bytes per sample and channel besides the file   @par Repeats yes
Raster readRaster(const std::string& path, const RasterReadOptions& options = {}, const RunContext& ctx = {});

/// Writes a grey image of 16 bits, with alpha where `values` has NaN. @param values  [height x width] 0..1
/// @throw Error Io
void writeGreyPng(const std::string& path, int width, int height, const std::vector<float>& values);
/// Writes an image of one or three channels. @param bits  8 or 16   @param values  [height x width x
/// channels] 0..1, rows from the top   @throw Error Io, Memory
void writeImagePng(const std::string& path, int width, int height, int channels, int bits,
                   const std::vector<float>& values);
/// The same as floats: a channel Y, or R, G, B. @throw Error Io
void writeImageExr(const std::string& path, int width, int height, int channels,
                   const std::vector<float>& values);
/// Writes a float image with a channel Y, and A (0 or 1) where `values` has NaN (written as 0).
/// @throw Error Io
void writeGreyExr(const std::string& path, int width, int height, const std::vector<float>& values);

}  // namespace vdbsynth
