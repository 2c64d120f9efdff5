#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The solid voxels of a box, one bit each, for fast counting. Rows run along z and begin at a word; bits
/// beyond a row's end are 0.
class Occupancy {
public:
    Occupancy() = default;
    /// All void. @param size  every side at least 1
    explicit Occupancy(const Index3& size);
    /// Solid where the field is negative. @param field  box beginning at 0
    static Occupancy fromField(const BrickField& field, const RunContext& ctx = {});

    const Index3& size() const { return mSize; }
    double volume() const { return double(mSize.x) * mSize.y * mSize.z; }
    bool at(int x, int y, int z) const { return row(x, y)[z >> 6] >> (z & 63) & 1; }
    void set(int x, int y, int z) { mutableRow(x, y)[z >> 6] |= std::uint64_t(1) << (z & 63); }
    const std::uint64_t* row(int x, int y) const {
        return mWords.data() + (std::size_t(x) * std::size_t(mSize.y) + std::size_t(y)) * mRowWords;
    }
    std::size_t rowWords() const { return mRowWords; }
    std::size_t memoryBytes() const { return mWords.size() * sizeof(std::uint64_t); }

    /// Number of solid voxels.
    std::uint64_t count() const;
    /// Solid and void exchanged.
    Occupancy complement() const;
    /// The part in a box within this one, with its box at 0.
    Occupancy window(const IndexBox& box) const;

private:
    std::uint64_t* mutableRow(int x, int y) {
        return mWords.data() + (std::size_t(x) * std::size_t(mSize.y) + std::size_t(y)) * mRowWords;
    }
    void clearPadding();

    Index3 mSize{0, 0, 0};
    std::size_t mRowWords = 0;
    std::vector<std::uint64_t> mWords;
};

/// Number of voxels p that are solid in `a` and whose p + shift is solid in `b`, within both boxes, which
/// have one size.
std::uint64_t countPairs(const Occupancy& a, const Occupancy& b, const Index3& shift);

}  // namespace vdbsynth
