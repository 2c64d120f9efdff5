#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/lattice.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vdbsynth {

/// A scalar field over a box of voxels, stored as 8^3 bricks; a brick with one value throughout costs eight
/// bytes. Algorithms work on this form of a grid; `vdb/bricks.h` converts both ways. Samples within a brick
/// are x slowest, z fastest. Reads are safe from many threads at once, writes are not.
class BrickField {
public:
    static constexpr int kSide = 8;
    static constexpr int kSamples = kSide * kSide * kSide;

    BrickField() = default;
    /// Constant `value` over `box`. @throw Error InvalidOption (empty box)
    BrickField(const IndexBox& box, float value);

    /// Builds every brick by a call fill(brickBox, samples), from many threads. `brickBox` may extend beyond
    /// the field's box; samples there count towards "one value throughout" and are never read.
    /// @par Repeats same bits for any number of threads if fill is a pure function of its box.
    static BrickField generate(const IndexBox& box, const RunContext& ctx,
                               const std::function<void(const IndexBox& brickBox, float* samples)>& fill);
    /// The same by a call valueAt(p) for every voxel of every brick; p too may lie beyond the field's box.
    template <typename Value>
    static BrickField fromVoxels(const IndexBox& box, const RunContext& ctx, const Value& valueAt) {
        return generate(box, ctx, [&](const IndexBox& brick, float* samples) {
            forEachVoxel(brick, [&](const Index3& p) { *samples++ = valueAt(p); });
        });
    }

    const IndexBox& box() const { return mBox; }
    /// Moves the box and the samples with it.
    void translate(const Index3& by) { mBox = {mBox.min + by, mBox.max + by}; }
    /// Value at p; outside the box the value of the nearest voxel inside.
    float at(const Index3& p) const;
    /// Value at a p inside the box, unchecked; the fast way for inner loops.
    float inside(const Index3& p) const {
        const int x = p.x - mBox.min.x, y = p.y - mBox.min.y, z = p.z - mBox.min.z;
        const std::size_t brick = brickIndex(x >> 3, y >> 3, z >> 3);
        const std::int32_t slot = mSlots[brick];
        if (slot < 0) return mConstants[brick];
        return mSamples[std::size_t(slot) * kSamples +
                        std::size_t((((x & 7) << 3) | (y & 7)) << 3 | (z & 7))];
    }
    /// Copies the samples of [corner, corner + size) to out, x slowest, z fastest. Samples outside
    /// the box are those of the nearest voxel inside.
    void readBox(const Index3& corner, const Index3& size, float* out) const;
    /// Writes the samples of [corner, corner + size) where `mask` is null or nonzero. Parts outside
    /// the box are ignored. Bricks are allocated only where the value changes.
    void writeBox(const Index3& corner, const Index3& size, const float* values,
                  const std::uint8_t* mask = nullptr);
    /// True, with the value, if all bricks that touch the box share one value.
    bool constantIn(const IndexBox& region, float& value) const;

    /// True if no sample is NaN or infinite; those beyond the box are included.
    bool finite() const;

    std::size_t brickCount() const { return mSlots.size(); }
    std::size_t storedBricks() const { return mSamples.size() / kSamples; }
    std::size_t memoryBytes() const;

private:
    std::size_t brickIndex(int bx, int by, int bz) const { return latticeIndex({bx, by, bz}, mBricks); }
    const float* brickRow(std::size_t brick, int lx, int ly) const {
        return mSamples.data() + std::size_t(mSlots[brick]) * kSamples + (lx * kSide + ly) * kSide;
    }
    float* touch(std::size_t brick);

    IndexBox mBox;
    Index3 mBricks;                    // bricks along each axis
    std::vector<std::int32_t> mSlots;  // per brick: index of its samples, or -1 where constant
    std::vector<float> mConstants;     // per brick: its value where constant
    std::vector<float> mSamples;       // kSamples floats per stored brick
};

/// What most functions require of a field.
/// @param what  begins the message, for example "`exemplars` 2" or "the target"
/// @throw Error InvalidOption (null, or an empty box), ShapeMismatch (its box does not begin at 0,0,0, or has
/// another size than `size`, if that is not 0,0,0), BadData (NaN or infinite samples)
void requireField(const BrickField* field, const std::string& what, const Index3& size = {0, 0, 0});

}  // namespace vdbsynth
