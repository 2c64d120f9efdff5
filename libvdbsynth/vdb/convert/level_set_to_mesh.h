#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

struct MeshingOptions {
    double adaptivity =
        0.0;  ///< 0..1: how far flat regions may be merged; 0 keeps about two triangles a surface voxel
    bool sharp = false;            ///< keeps edges and corners (zero_level.h); not with adaptivity
    const Mesh* source = nullptr;  ///< [world] for sharp: the mesh that the level set was made from
};

/// @throw Error InvalidOption (a field out of its range, both `sharp` and `adaptivity`)
void validate(const MeshingOptions& options);

/// The zero level as a closed manifold mesh with outward faces. With sharp: see zero_level.h. Else OpenVDB's
/// dual marching cubes, then two Newton steps (with adaptivity eight) that move each vertex onto the
/// trilinear zero level (OpenVDB's own are up to a tenth of a voxel inside curved surfaces, of merged cells
/// up to some voxels away), then touching sheets are separated (geometry/mesh.h).
/// @throw Error InvalidOption (`adaptivity`, `sharp`), EmptyInput (no zero level), Cancelled
/// @par Repeats same bits for any number of threads
Mesh levelSetToMesh(const openvdb::FloatGrid& grid, const MeshingOptions& options = {},
                    const RunContext& ctx = {});

}  // namespace vdbsynth
