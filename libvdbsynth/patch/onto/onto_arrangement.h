#pragma once
#include "libvdbsynth/patch/onto/surface_disk.h"
#include "libvdbsynth/patch/patch_field.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A place of plane space along the plane.
struct PlanePlace {
    double x = 0, y = 0;
};

inline constexpr double kOntoRim = 4;  ///< [steps] that disks are wider than their patches

/// A patch over a surface: a round piece of the exemplar on a disk of sites.
struct OntoPatch {
    SurfaceDisk disk;   ///< some steps wider than the patch, so that its surface is smooth at the patch's rim
    double radius = 0;  ///< [world] of the patch: sites of the disk up to there may be its
    PlanePlace from;    ///< [world] plane space, where the disk's centre lies in the exemplar
    Vec2f turn{1, 0};   ///< cosine and sine: takes directions of the disk to the exemplar's
    double cost = 0;    ///< d^2 over the number of values, where it overlapped others

    /// The exemplar's place at one of the disk.
    PlanePlace inExemplar(const Vec2f& at) const;
    /// The inverse.
    Vec2f onDisk(const PlanePlace& place) const;
};

/// Which patch every node of a surface is copied from; over each site stands a column of nz nodes along its
/// normal, node k of height (k + 1/2) steps of plane space.
struct OntoArrangement {
    static constexpr std::int32_t kNone = -1;

    int nz = 0;
    double step = 0;     ///< [world]
    double overlap = 0;  ///< [world] that patches reach over earlier ones where they adjoin
    std::vector<OntoPatch> patches;
    std::vector<std::int32_t> label;  ///< [sites x nz] patch; whole columns are known, or none of one

    bool known(std::uint32_t site) const { return label[std::size_t(site) * std::size_t(nz)] != kNone; }
    const std::int32_t* column(std::uint32_t site) const {
        return label.data() + std::size_t(site) * std::size_t(nz);
    }
};

/// Directions of one disk in another's, at a site of both. @param a, b  members of each
Vec2f turnBetween(const SurfaceDisk& from, std::ptrdiff_t a, const SurfaceDisk& to, std::ptrdiff_t b);

/// The exemplar's column at a place between nodes, bilinear; beyond the lattice the nearest one's.
/// @param values  array of nz x 4
void readBetween(const PatchField& exemplar, const PlanePlace& place, float* values);
/// Its distances only. @param values  array of nz
void readDistances(const PatchField& exemplar, const PlanePlace& place, float* values);

/// That of one node.
float readDistance(const PatchField& exemplar, const PlanePlace& place, int k);

/// What a disk sees of the patches that lie at a site, at a place of the disk near it: distances, and
/// gradients in the disk's axes.
/// @param member  of the disk, a site that is known   @param values  array of nz x 4
void readOnto(const PatchField& exemplar, const OntoArrangement& arrangement, const SurfaceDisk& disk,
              std::ptrdiff_t member, const Vec2f& at, float* values);

}  // namespace vdbsynth
