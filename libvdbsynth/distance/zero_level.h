#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// Which way the faces of a mesh look.
enum class Facing { Outward, Inward };

/// The zero level of a field as a closed mesh of quads, in the field's index space: dual marching cubes
/// [nielson2004]. A cell is eight neighbouring samples; each loop of the surface through it becomes one
/// vertex, at the mean of its crossings with the cell's edges, and each edge between samples of different
/// sign becomes a quad between the four cells around it. On a face of a cell with two crossings too many the
/// inside counts as connected, except between two cells whose only such face it is and which have one loop
/// each: there both take the outside as connected [wenger2013, section 4.3], so that edges have two faces.
/// Each vertex then moves to the trilinear zero level by two Newton steps of at most half a voxel: means of
/// crossings lie inside a curved surface by up to a tenth of a voxel.
/// Edges of more than two faces may occur where sheets touch.
///
/// With volumeToMesh of OpenVDB (adaptivity 0) and the same Newton steps as the reference, vertices and faces
/// are the same bits in the same order of faces (tested).
/// @param field   negative inside, in any unit; beyond its box the nearest samples continue
/// @param region  cells are meshed whose corner lies in a cube of 8 voxels (at multiples of 8) touching it
/// @par Cost    O(cubes of the region + samples of those that the surface crosses)
/// @par Repeats same bits for any number of threads
Mesh zeroLevel(const BrickField& field, const IndexBox& region, Facing facing, const RunContext& ctx = {});

}  // namespace vdbsynth
