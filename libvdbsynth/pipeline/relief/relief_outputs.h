#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// The kinds of file that writeRelief writes: .vdb, .ply, .png, .exr, and with a strength .obj, .stl, .off,
/// .glb and .gltf. @throw Error InvalidOption (another extension, a mesh of the surface without a strength)
void requireReliefPaths(const std::vector<std::string>& paths, const ReliefExtractOptions& options);

/// Heights over an axis plane [world], whole rows from the top; NaN where a column meets no base.
struct ReliefImage {
    int columns = 0, rows = 0;
    std::vector<float> heights;  ///< [rows x columns]
};

/// The relief of a flat model, one pixel a column of voxels of the domain, over the plane that the base
/// faces: columns and rows as in heightField (raster/height_field.h) for XY, YZ or ZX. Flat: no normal of the
/// base is farther than 60 degrees from one direction of that axis.
/// @throw Error Unusable (the base is not flat)
ReliefImage reliefImage(const ReliefExtraction& extraction, const RunContext& ctx = {});

/// Writes an extraction to every path, its kind by extension:
/// - .vdb: base, relief, relief_vector where it folds, surface where a strength was given;
/// - .ply: the base's mesh, at its vertices `relief` (height, world) and `relief_vector` (3, from the vertex
///   to the scan's surface, world); on the caps of a texture's domain both are 0;
/// - .png (16 bits; black the lowest, white the highest, a note says which) and .exr (world): reliefImage;
/// - .obj, .stl, .off, .glb, .gltf: the surface of the given strength.
/// Nothing is renamed into place; `outputs.commit()` does that.
/// @throw Error as requireReliefPaths and reliefImage; Io
/// @par Repeats byte for byte
void writeRelief(const ReliefExtraction& extraction, const std::vector<std::string>& paths,
                 const ReliefExtractOptions& options, const VdbMetadata& metadata, OutputSet& outputs,
                 const RunContext& ctx = {});

}  // namespace vdbsynth
