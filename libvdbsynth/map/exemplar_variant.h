#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/affine.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// An exemplar turned and scaled about the middle of its box. Synthesis with maps of rotation and scale is
/// synthesis from several exemplars, of which each place has its own.
struct ExemplarVariant {
    std::int32_t exemplar = 0;
    Vec3d rotation{0, 0, 0};  ///< [radians] axis times angle, from the exemplar to the variant
    double scale = 1;         ///< features of the variant over those of the exemplar
    Index3 size{0, 0, 0};     ///< of its box [voxels]

    bool plain() const { return rotation.x == 0 && rotation.y == 0 && rotation.z == 0 && scale == 1; }
};

/// The turn by a rotation vector. @par Repeats same bits on every processor
Affine turnBy(const Vec3d& rotation);

/// Half the angle between two turns [radians], 0..pi/2, is the arc cosine of this, 0..1.
double likeness(const Vec3d& rotation, const Vec3d& other);

/// A box that holds the turned and scaled exemplar; along axes that do not grow the exemplar's own length.
Index3 variantSize(const Index3& exemplar, const Vec3d& rotation, double scale,
                   const std::array<bool, 3>& grows);

/// Where voxel p of a variant lies in its exemplar [voxels of it, which begin at 0]. Both sizes times k are
/// the same turn at k times the resolution.
Vec3d inExemplar(const ExemplarVariant& variant, const Index3& exemplarSize, const Vec3d& p);

/// A field of distances turned and scaled, its values scaled with it. Beyond the exemplar its nearest samples
/// go on. @param limit  [voxels] where distances end; what is that far stays so
/// @par Cost    O(voxels of the variant * 8)   @par Repeats same bits for any number of threads
BrickField variantOf(const BrickField& distances, const ExemplarVariant& variant, float limit,
                     const RunContext& ctx = {});

/// Any scalar turned and scaled, its values as they are.
BrickField variantOfScalar(const BrickField& scalar, const ExemplarVariant& variant,
                           const RunContext& ctx = {});

/// 1 where the variant's voxel lies in the exemplar, and in its mask if there is one; else 0.
/// @param goesOn  for the low and high face of x, y, z: beyond it the exemplar's nearest sample will do, as
/// above
///                and below a terrain
BrickField variantMask(const Index3& exemplarSize, const ExemplarVariant& variant, const BrickField* mask,
                       const std::array<bool, 6>& goesOn = {}, const RunContext& ctx = {});

/// What is asked for at one place of the target.
struct WantedVariant {
    std::int32_t exemplar = 0;
    Vec3d rotation{0, 0, 0};
    double scale = 1;
};

/// Few variants (at most 24 an exemplar) that come near everything wanted, in the order in which what they
/// stand for was first wanted, and for every place the number of its own. Tolerances begin at 8 degrees and a
/// twelfth of scale and widen until few are enough. Sizes are left 0.
struct ChosenVariants {
    std::vector<ExemplarVariant> variants;
    std::vector<std::int32_t> number;  ///< [wanted]
    double tolerance = 0;              ///< [degrees]
};
ChosenVariants chooseVariants(const std::vector<WantedVariant>& wanted, const RunContext& ctx = {});

}  // namespace vdbsynth
