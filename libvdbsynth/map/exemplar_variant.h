#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/affine.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// An exemplar rotated and scaled about the middle of its box. Synthesis with maps of rotation and scale is
/// synthesis from several such exemplars, of which each position uses its own.
struct ExemplarVariant {
    std::int32_t exemplar = 0;
    Vec3d rotation{0, 0, 0};  ///< [radians] axis times angle, from the exemplar to the variant
    double scale = 1;         ///< features of the variant over those of the exemplar
    Index3 size{0, 0, 0};     ///< of its box [voxels]

    bool plain() const { return rotation.x == 0 && rotation.y == 0 && rotation.z == 0 && scale == 1; }
};

/// Rotation matrix of a rotation vector. @par Repeats same bits on every processor
Affine rotationMatrix(const Vec3d& rotation);

/// Half the angle between two rotations [radians], 0..pi/2, is the arc cosine of this, 0..1.
double similarity(const Vec3d& rotation, const Vec3d& other);

/// A box that holds the rotated and scaled exemplar; the exemplar's own length along axes that do not grow.
Index3 variantSize(const Index3& exemplar, const Vec3d& rotation, double scale,
                   const std::array<bool, 3>& grows);

/// Position of voxel p of a variant in its exemplar [the exemplar's voxels, from 0]. With both sizes times k
/// the rotation is the same at k times the resolution.
Vec3d inExemplar(const ExemplarVariant& variant, const Index3& exemplarSize, const Vec3d& p);

/// A field of distances, rotated and scaled, its values scaled with it. Beyond the exemplar its nearest
/// samples continue. @param limit  [voxels] distances end there; values at the limit stay
/// @par Cost    O(voxels of the variant * 8)   @par Repeats same bits for any number of threads
BrickField variantOf(const BrickField& distances, const ExemplarVariant& variant, float limit,
                     const RunContext& ctx = {});

using ExemplarFields = std::vector<std::shared_ptr<const BrickField>>;

/// What a map's blocks count as exemplars: the exemplars, or where there are any their variants. A variant
/// that is neither rotated nor scaled shares its exemplar's field.
ExemplarFields variantsOf(const ExemplarFields& exemplars, const std::vector<ExemplarVariant>& variants,
                          float limit, const RunContext& ctx = {});

/// Any scalar, rotated and scaled; its values do not change.
BrickField variantOfScalar(const BrickField& scalar, const ExemplarVariant& variant,
                           const RunContext& ctx = {});

/// 1 where the variant's voxel lies in the exemplar, and in its mask if there is one; else 0.
/// @param continues  for the low and high face of x, y, z: true if the exemplar's nearest sample continues
/// beyond it, as above and below a terrain
BrickField variantMask(const Index3& exemplarSize, const ExemplarVariant& variant, const BrickField* mask,
                       const std::array<bool, 6>& continues = {}, const RunContext& ctx = {});

/// For the low and high face of x, y, z of a field, across axes that do not grow: true where the surface does
/// not cross the face, so that what lies beyond is known.
std::array<bool, 6> facesOfOneSide(const BrickField& field, const std::array<bool, 3>& grows);

/// Along which axis that does not grow a variant is not where the target is, because it is scaled or tilted
/// and its surface crosses a face there; -1: none. Sources must then be free to move along it.
/// @param faces  facesOfOneSide of the variant's exemplar
int axisOfDrift(const ExemplarVariant& variant, const std::array<bool, 6>& faces,
                const std::array<bool, 3>& grows);

/// [voxels] from one position of the target at which control values are read to the next.
inline constexpr int kVariantCell = 4;
/// Number of such positions along each axis of a box.
Index3 variantCells(const IndexBox& box);

/// The number of every position, x slowest, at each voxel of a box of this size, in a field that begins at 0.
BrickField fieldOfNumbers(const std::vector<std::int32_t>& numbers, const IndexBox& box,
                          const RunContext& ctx = {});

/// The control values at one position of the target.
struct WantedVariant {
    std::int32_t exemplar = 0;
    Vec3d rotation{0, 0, 0};
    double scale = 1;
};

/// Few variants (at most 24 per exemplar) that approximate all wanted ones, in the order in which they were
/// first wanted, and for every position the number of its variant. Tolerances begin at 8 degrees and a
/// twelfth of scale and widen until few variants are enough. Sizes are left 0.
struct ChosenVariants {
    std::vector<ExemplarVariant> variants;
    std::vector<std::int32_t> number;  ///< [wanted]
    double tolerance = 0;              ///< [degrees]
};
ChosenVariants chooseVariants(const std::vector<WantedVariant>& wanted, const RunContext& ctx = {});

}  // namespace vdbsynth
