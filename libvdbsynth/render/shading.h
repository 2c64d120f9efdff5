#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/render/camera.h"
#include "libvdbsynth/render/traced_surface.h"

#include <array>
#include <cstdint>

namespace vdbsynth {

/// Colours here are linear light unless a name says otherwise.
/// Light as a byte of a picture, by sRGB's curve; over 0.7 it rolls off, so that highlights keep their shape.
std::uint8_t shownByte(float light);
/// The light of a value from 0 to 1 as pictures hold it (sRGB); values outside are clamped.
float lightOf(float shown);

/// What lies behind the model.
struct Background {
    enum class Kind { Studio, Plain, Transparent };
    Kind kind = Kind::Studio;
    Vec3f colour{1, 1, 1};  ///< of Plain, as pictures hold it, 0..1

    /// At a height in the picture, 0 at its lower edge, 1 at its upper one. Black where it is transparent.
    Vec3f at(float height) const;
};

/// Light of a scene: a key light from the upper left of the camera with a soft shadow, a second one from
/// behind, and a sky, warm below and cool above. All lengths in voxels, all directions in the places of a
/// TracedSurface.
///
/// The shadow follows a ray through distances to the surface: the least of distance / way, times a constant,
/// is the share of the light that passes [aaltonen2018]. The sky is asked for in 14 directions, those to the
/// faces and corners of a cube that stands upright (on the ground also to its edges); what a direction sees
/// is the least of distance / way at four places along it, a cone traced through distances [wright2015].
class Lighting {
public:
    /// @param camera  its directions in the places of `surface`
    /// @param up      unit vector, in the places of `surface`
    Lighting(const TracedSurface& surface, const Camera& camera, const Vec3f& up);

    /// What a place sees of the sky.
    struct Sky {
        Vec3f light;     ///< from all of it, as weighted by the normal
        float open = 0;  ///< the share that is seen, 0..1
    };
    Sky skyOver(const Vec3f& place, const Vec3f& normal) const { return skyAt(place, normal, kFirstEdge); }

    /// Light from a place of the surface towards the eye.
    /// @param towards  unit vector to the eye   @param albedo  0..1   @param sky  skyOver, or near it
    Vec3f shaded(const Vec3f& place, const Vec3f& normal, const Vec3f& towards, const Vec3f& albedo,
                 const Sky& sky) const;
    /// Share of light that a place of the ground gets, 0..1, next to one far from the model.
    Vec3f onGround(const Vec3f& place) const;
    /// Share of the sky that a place of the surface sees, 0..1.
    float openAt(const Vec3f& place, const Vec3f& normal) const {
        return skyAt(place, normal, kFirstEdge).open;
    }
    /// Share of the key light that reaches a place, 0..1.
    float sunAt(const Vec3f& place) const;
    /// Towards the key light, a unit vector.
    const Vec3f& sun() const { return mSun; }

private:
    static constexpr std::size_t kFirstEdge = 14;  // of the directions; faces and corners come before
    Sky skyAt(const Vec3f& place, const Vec3f& normal, std::size_t directions) const;
    Vec3f skyColour(float height) const;

    const TracedSurface* mSurface;
    Vec3f mUp, mSun, mBehind;
    std::array<Vec3f, 26> mDirections;
    std::array<Vec3f, 26> mColours;
    std::array<float, 4> mWays;
};

/// The colour of a model without colours of its own.
inline constexpr Vec3f kClay{0.47f, 0.335f, 0.245f};

}  // namespace vdbsynth
