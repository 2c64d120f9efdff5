#pragma once
#include <array>
#include <cstddef>
#include <string>

namespace vdbsynth {

/// Length of a target along one axis: a number of voxels, or a multiple of the exemplar's domain. A plain
/// number is neither.
class Extent {
public:
    static Extent voxels(int count) { return {double(count), false}; }
    static Extent multiple(double factor) { return {factor, true}; }

    bool isMultiple() const { return mMultiple; }
    double value() const { return mValue; }
    /// [voxels], not rounded, for a domain of `domain` voxels.
    double over(int domain) const { return mMultiple ? mValue * domain : mValue; }
    /// `128` or `2x`, in the form of the command line.
    std::string text() const;

private:
    Extent(double value, bool multiple) : mValue(value), mMultiple(multiple) {}
    double mValue;
    bool mMultiple;
};

/// A target's size along x, y and z, each axis in its own unit: TargetSize(Extent::multiple(2),
/// Extent::multiple(2), Extent::voxels(64)).
class TargetSize {
public:
    TargetSize(Extent x, Extent y, Extent z) : mExtents{x, y, z} {}
    static TargetSize voxels(int x, int y, int z) {
        return {Extent::voxels(x), Extent::voxels(y), Extent::voxels(z)};
    }
    static TargetSize multiples(double x, double y, double z) {
        return {Extent::multiple(x), Extent::multiple(y), Extent::multiple(z)};
    }

    Extent& operator[](int axis) { return mExtents[std::size_t(axis)]; }
    const Extent& operator[](int axis) const { return mExtents[std::size_t(axis)]; }
    /// `2x,2x,64`
    std::string text() const;

private:
    std::array<Extent, 3> mExtents;
};

}  // namespace vdbsynth
