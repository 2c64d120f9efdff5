#pragma once
#include "libvdbsynth/math/vec2.h"
#include "libvdbsynth/patch/onto/onto_surface.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A round piece of a surface laid flat: lengths and angles at its centre, and along lines from there, are
/// those on the surface.
struct SurfaceDisk {
    std::uint32_t centre = 0;
    std::vector<std::uint32_t> site;  ///< [members] ascending
    std::vector<Vec2f> at;            ///< [members] [world] from the centre; +x along the centre's tangent
    std::vector<Vec2f> turn;          ///< [members] cosine and sine: takes directions of the disk to the
                                      ///< site's frame, its tangent and normal x tangent

    std::size_t size() const { return site.size(); }
    /// The number of a site among the members; -1 if it is none. @par Cost    O(log members)
    std::ptrdiff_t find(std::uint32_t number) const;
};

/// Makes disks by the discrete exponential map [schmidt2006]: outward from the centre, nearest first, every
/// site is placed at the mean, by 1 / distance, of where its neighbours in the disk see it, by the position
/// formula of [zhang2004, appendix A] in frames that are carried along.
class SurfaceDisks {
public:
    /// @param surface  borrowed
    explicit SurfaceDisks(const OntoSurface& surface);

    /// All sites up to `radius` from the centre in the disk that a way inside it reaches.
    /// @param centre  a site   @param radius  [world] above 0
    /// @par Cost    O(members log members)   @par Repeats yes; not from several threads
    SurfaceDisk around(std::uint32_t centre, double radius);

private:
    struct Member {
        Vec2f at;
        Vec3f tangent;
    };
    Member seenFrom(std::uint32_t from, std::uint32_t to) const;
    Member mean(std::uint32_t to) const;

    const OntoSurface& mSurface;
    std::vector<std::uint32_t> mDisk;  // [sites] number of the last disk that it belongs to
    std::uint32_t mNumber = 0;
    std::vector<Member> mMember;  // [sites]
};

}  // namespace vdbsynth
