#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/lattice.h"

#include <functional>
#include <string>

namespace vdbsynth {

/// Formats of volumes as outputs; io/raster_file.h reads all of them.
enum class VolumeFormat { Npy, Tiff, Vti, Nifti, NiftiGz };

/// @return false unless the path ends, in any case, in .npy, .tif, .tiff, .vti, .nii or .nii.gz
bool volumeFormatOf(const std::string& path, VolumeFormat& format);
/// These extensions in words, for messages.
extern const char* const kVolumeOutputs;

/// What a file says of its samples, which lie on a lattice of cubes.
struct VolumeHead {
    std::string name;            ///< of the values, without markup: "inside", "distance"
    Index3 size{0, 0, 0};        ///< columns, rows, slices
    bool bytes = false;          ///< uint8; false: float32
    double low = 0, high = 1;    ///< range of the values, for programs that show them
    Affine toWorld = kIdentity;  ///< from column, row and slice to the place of a sample
    std::string unit;            ///< of the world, as readers write it: "um", "mm", "m"; empty: unknown
};

/// [world] the side of a cell.
double cellOf(const VolumeHead& head);

/// Writes slices [first, first + count) to `out`, columns fastest, in the machine's byte order.
using SliceSource = std::function<void(int first, int count, char* out)>;

/// What readers of this format do not find in it, as a clause for a note, "no place for its unit (um)"; empty
/// if everything is kept. NIfTI's affine is of floats: places that they move by over a hundredth of a cell
/// are named too.
std::string lostInVolume(VolumeFormat format, const VolumeHead& head);

/// Writes a volume in slabs, none of which takes over 64 MB unless a single slice does.
/// - npy: an array [slices][rows][columns] in C order; three or four columns of uint8 are written as bool,
///   which no reader takes for colours
/// - tif: a page a slice, uncompressed, with ImageJ's description (slices, spacing, unit, origin in cells);
///   BigTIFF from 4 GB on
/// - vti: one array of points, raw, with Origin, Spacing and, for turned axes, Direction
/// - nii: NIfTI-1 with sform and qform; nii.gz the same packed
/// @param path   the file to write, of any name
/// @param shown  its name in messages
/// @throw Error InvalidOption (no samples, a side over 2^24, 32767 in NIfTI), Unusable (over 256 GB), Memory
/// (two slices are over `maxMemory`), Io, Cancelled
/// @par Cost     O(samples)   @par Repeats yes, for one version of zlib
void writeVolume(const std::string& path, const std::string& shown, VolumeFormat format,
                 const VolumeHead& head, const SliceSource& slices, const RunContext& ctx = {});

}  // namespace vdbsynth
