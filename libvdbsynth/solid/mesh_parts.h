#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vdbsynth {

/// What a part of a mesh is to the solid.
enum class PartRole {
    Open,    ///< some of its edges have one face, or its faces disagree: it bounds nothing by itself
    Solid,   ///< its inside is solid
    Cavity,  ///< its inside is empty, in a solid part
    United   ///< its inside is what that of the part around it is: it adds nothing
};

/// Faces that are connected through edges of exactly two faces.
struct MeshPart {
    std::size_t faces = 0;
    double area = 0;          ///< [world^2]
    double signedVolume = 0;  ///< [world^3] about its own middle; negative where its faces look inward
    Vec3d boxMin, boxMax;     ///< [world], without the mesh's origin
    PartRole role = PartRole::Open;
    int around = -1;  ///< the smallest part that it lies in, or none
};

struct MeshParts {
    std::vector<std::uint32_t> partOf;  ///< of every face of triangulated(mesh)
    std::vector<MeshPart> parts;        ///< in the order of their first faces
};

/// The parts of a mesh and what each is to the solid, whatever its normals: an outermost closed part is
/// solid. A closed part inside another is a cavity if its normals oppose those of the part around it, else it
/// is united with it; so on inwards. A part that crosses another lies in none. A part that is open by little
/// (the vectors of its faces' areas sum to under 0.3 of its area, as of a ball with a hole) counts as closed.
/// A part lies inside another if all of up to 64 of its faces do, by the winding number.
/// @param mesh  indices in range; vertices at one place welded
/// @par Cost    O(faces log faces), and one winding number for each part whose box lies in another's
/// @par Repeats same bits for any number of threads
MeshParts meshParts(const Mesh& mesh, const RunContext& ctx = {});

struct PartCounts {
    std::size_t solids = 0, cavities = 0, united = 0, open = 0;
};
PartCounts countParts(const MeshParts& parts);

/// A mesh whose parts are oriented, and how many of them changed.
struct OrientedParts {
    std::optional<Mesh> mesh;  ///< none if the mesh is right as it is
    std::size_t flipped = 0;   ///< parts whose faces were turned
    std::size_t removed = 0;   ///< united parts with a cavity in them, which would be counted twice
};

/// Turns the faces of closed parts so that the winding number is 1 in the solid and 0 elsewhere (2 where
/// solid parts overlap): outward on solids, inward on cavities. Quads become triangles if anything changes.
/// @param parts  of this mesh
/// @par Cost    O(faces)   @par Repeats yes
OrientedParts orientParts(const Mesh& mesh, const MeshParts& parts);

}  // namespace vdbsynth
