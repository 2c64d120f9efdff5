#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>
#include <vector>

namespace vdbsynth {

struct ReliefBakeOptions {
    int size = 1024;   ///< [pixels] side of a picture, 16..16384
    int bits = 16;     ///< of .png: 8 or 16
    double reach = 0;  ///< [world] above 0: how far along the normal relief is looked for
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const ReliefBakeOptions& options);

/// What a picture of this name holds.
enum class BakedRelief {
    Displacement,  ///< [world] along the target's normal; in .png half is 0 and white `reach`
    Vector,        ///< [world] to the relief's surface, along u, v and normal; three channels, .exr only
    Normal         ///< of the relief's surface along u, v and normal, 0..1 each
};

/// By the end of the name, before the extension and <UDIM>: `_vector`, `_normal`, else displacement.
BakedRelief bakedReliefOf(const std::string& path);

/// Bakes the relief of a result onto the target's own texture coordinates (attribute `uv`), as look-dev
/// artists and renderers displace with: from a place of the target's mesh along its smooth normal (the mean
/// of the faces' at vertices, between corners) to where the result's zero level is met, the nearest within
/// `reach` on either side; 0 where none is. The tangent u is the direction in which the coordinate u grows.
/// @param target  with the attribute `uv` @param result  the target with relief
/// @throw Error InvalidOption (a vector as .png), Unusable (no `uv`, and as bakeOntoUv), Memory, Io,
/// Cancelled
/// @par Repeats same bits for any number of threads
void bakeRelief(const Mesh& target, const LevelSet& result, const std::string& name, const std::string& path,
                const ReliefBakeOptions& options, OutputSet& outputs, const RunContext& ctx = {});

}  // namespace vdbsynth
