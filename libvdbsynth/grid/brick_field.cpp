#include "libvdbsynth/grid/brick_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace vdbsynth {
namespace {

bool isConstant(const float* samples, std::size_t count) {
    for (std::size_t i = 1; i < count; ++i)
        if (samples[i] != samples[0]) return false;
    return true;
}

// Copies 1 to 4 samples; a call of memcpy with a size known only here costs several times as much.
void copyFew(const float* from, int count, float* to) {
    if (count == 4) {
        std::memcpy(to, from, 4 * sizeof(float));
        return;
    }
    for (; count >= 2; count -= 2, from += 2, to += 2) std::memcpy(to, from, 2 * sizeof(float));
    if (count == 1) *to = *from;
}

constexpr Index3 kFour{4, 4, 4};  // what a cubic polynomial reads at a point

// Calls row(x, y, brick's z, z within the brick, samples from there, out) for the pieces of rows of 4 x 4 x 4
// samples that lie in one brick each. @param l  from the field's corner
template <typename Row>
void forRowsOfFour(const Index3& l, float* out, const Row& row) {
    const int z = l.z & 7, first = std::min(4, 8 - z);
    for (int x = l.x; x < l.x + 4; ++x)
        for (int y = l.y; y < l.y + 4; ++y, out += 4) {
            row(x, y, l.z >> 3, z, first, out);
            if (first < 4) row(x, y, (l.z >> 3) + 1, 0, 4 - first, out + first);
        }
}

}  // namespace

BrickField::BrickField(const IndexBox& box, float value) : mBox(box) {
    if (box.empty()) throw Error(ErrorCode::InvalidOption, "a field needs a box of at least one voxel");
    const Index3 size = box.size();
    mBricks = {(size.x + kSide - 1) / kSide, (size.y + kSide - 1) / kSide, (size.z + kSide - 1) / kSide};
    constexpr double kMostBricks = 1e11;  // eight bytes each; larger products could exceed 2^64
    if (double(mBricks.x) * mBricks.y * mBricks.z > kMostBricks)
        throw Error(ErrorCode::Memory, "a field of " + std::to_string(size.x) + " x " +
                                           std::to_string(size.y) + " x " + std::to_string(size.z) +
                                           " voxels is too large");
    const std::size_t count = latticeCount(mBricks);
    mSlots.assign(count, -1);
    mConstants.assign(count, value);
}

BrickField BrickField::generate(const IndexBox& box, const RunContext& ctx,
                                const std::function<void(const IndexBox&, float*)>& fill) {
    BrickField field(box, 0.f);
    constexpr std::size_t kGrain = 64;
    const std::size_t count = field.mSlots.size();
    struct Chunk {
        std::vector<std::size_t> bricks;
        std::vector<float> samples;
    };
    std::vector<Chunk> chunks((count + kGrain - 1) / kGrain);
    parallelFor(ctx, count, kGrain, [&](std::size_t begin, std::size_t end) {
        Chunk& chunk = chunks[begin / kGrain];
        float samples[kSamples];
        for (std::size_t brick = begin; brick < end; ++brick) {
            fill(IndexBox::cube(box.min + latticeVoxel(brick, field.mBricks) * kSide, kSide), samples);
            if (isConstant(samples, kSamples)) {
                field.mConstants[brick] = samples[0];
            } else {
                chunk.bricks.push_back(brick);
                chunk.samples.insert(chunk.samples.end(), samples, samples + kSamples);
            }
        }
    });
    std::size_t stored = 0;
    for (const Chunk& chunk : chunks) stored += chunk.bricks.size();
    field.mSamples.reserve(stored * kSamples);
    std::int32_t slot = 0;
    for (Chunk& chunk : chunks) {
        for (std::size_t brick : chunk.bricks) field.mSlots[brick] = slot++;
        field.mSamples.insert(field.mSamples.end(), chunk.samples.begin(), chunk.samples.end());
        chunk = Chunk();
    }
    return field;
}

float BrickField::at(const Index3& p) const {
    const int x = std::clamp(p.x, mBox.min.x, mBox.max.x) - mBox.min.x;
    const int y = std::clamp(p.y, mBox.min.y, mBox.max.y) - mBox.min.y;
    const int z = std::clamp(p.z, mBox.min.z, mBox.max.z) - mBox.min.z;
    const std::size_t brick = brickIndex(x / kSide, y / kSide, z / kSide);
    if (mSlots[brick] < 0) return mConstants[brick];
    return brickRow(brick, x % kSide, y % kSide)[z % kSide];
}

void BrickField::readBox(const Index3& corner, const Index3& size, float* out) const {
    static_assert(kSide == 8, "forRowsOfFour");
    if (size == kFour && mBox.contains(corner) && mBox.contains(corner + Index3{3, 3, 3})) {
        forRowsOfFour(corner - mBox.min, out, [&](int x, int y, int bz, int z, int count, float* to) {
            const std::size_t brick = brickIndex(x >> 3, y >> 3, bz);
            if (mSlots[brick] < 0)
                std::fill_n(to, count, mConstants[brick]);
            else
                copyFew(brickRow(brick, x & 7, y & 7) + z, count, to);
        });
        return;
    }
    for (int i = 0; i < size.x; ++i) {
        const int x = std::clamp(corner.x + i, mBox.min.x, mBox.max.x) - mBox.min.x;
        for (int j = 0; j < size.y; ++j) {
            const int y = std::clamp(corner.y + j, mBox.min.y, mBox.max.y) - mBox.min.y;
            float* row = out + latticeIndex({i, j, 0}, size);
            int k = 0;
            while (k < size.z) {
                const int z = std::clamp(corner.z + k, mBox.min.z, mBox.max.z) - mBox.min.z;
                const std::size_t brick = brickIndex(x / kSide, y / kSide, z / kSide);
                const bool inside = corner.z + k == mBox.min.z + z;
                const int last = std::min(mBox.max.z - mBox.min.z, (z / kSide) * kSide + kSide - 1);
                const int run = inside ? std::min(size.z - k, last - z + 1) : 1;
                if (mSlots[brick] < 0)
                    std::fill(row + k, row + k + run, mConstants[brick]);
                else
                    std::memcpy(row + k, brickRow(brick, x % kSide, y % kSide) + z % kSide,
                                std::size_t(run) * sizeof(float));
                k += run;
            }
        }
    }
}

float* BrickField::touch(std::size_t brick) {
    if (mSlots[brick] < 0) {
        const std::size_t slot = mSamples.size() / kSamples;
        if (slot >= std::size_t(std::numeric_limits<std::int32_t>::max()))
            throw Error(ErrorCode::Memory, "a field cannot hold more than 2^31 bricks");
        mSamples.resize(mSamples.size() + kSamples, mConstants[brick]);
        mSlots[brick] = std::int32_t(slot);
    }
    return mSamples.data() + std::size_t(mSlots[brick]) * kSamples;
}

void BrickField::writeBox(const Index3& corner, const Index3& size, const float* values,
                          const std::uint8_t* mask) {
    const IndexBox part = mBox.intersection({corner, corner + size - Index3{1, 1, 1}});
    forEachVoxel(part, [&](const Index3& p) {
        const std::size_t source = latticeIndex(p - corner, size);
        if (mask && !mask[source]) return;
        const Index3 l = p - mBox.min;
        const std::size_t brick = brickIndex(l.x / kSide, l.y / kSide, l.z / kSide);
        if (mSlots[brick] < 0 && mConstants[brick] == values[source]) return;
        touch(brick)[((l.x % kSide) * kSide + l.y % kSide) * kSide + l.z % kSide] = values[source];
    });
}

bool BrickField::constantIn(const IndexBox& region, float& value) const {
    const IndexBox part = mBox.intersection(region);
    if (part.empty()) return false;
    bool first = true;
    for (int bx = (part.min.x - mBox.min.x) / kSide; bx <= (part.max.x - mBox.min.x) / kSide; ++bx)
        for (int by = (part.min.y - mBox.min.y) / kSide; by <= (part.max.y - mBox.min.y) / kSide; ++by)
            for (int bz = (part.min.z - mBox.min.z) / kSide; bz <= (part.max.z - mBox.min.z) / kSide; ++bz) {
                const std::size_t brick = brickIndex(bx, by, bz);
                if (mSlots[brick] >= 0) return false;
                if (first)
                    value = mConstants[brick];
                else if (mConstants[brick] != value)
                    return false;
                first = false;
            }
    return true;
}

std::size_t BrickField::memoryBytes() const {
    return mSlots.size() * (sizeof(std::int32_t) + sizeof(float)) + mSamples.size() * sizeof(float);
}

bool BrickField::finite() const {
    const auto fine = [](float value) { return std::isfinite(value); };
    // Constants of stored bricks are never read.
    for (std::size_t brick = 0; brick < mSlots.size(); ++brick)
        if (mSlots[brick] < 0 && !fine(mConstants[brick])) return false;
    return std::all_of(mSamples.begin(), mSamples.end(), fine);
}

void requireField(const BrickField* field, const std::string& what, const Index3& size) {
    if (!field) throw Error(ErrorCode::InvalidOption, what + ": is null; a field is needed");
    const IndexBox& box = field->box();
    if (box.empty()) throw Error(ErrorCode::InvalidOption, what + ": has no voxels");
    const auto text = [](const Index3& p) {
        return std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z);
    };
    if (box.min != Index3{0, 0, 0})
        throw Error(ErrorCode::ShapeMismatch,
                    what + ": its box begins at " + text(box.min) + "; it must begin at 0,0,0");
    if (size != Index3{0, 0, 0} && box.size() != size)
        throw Error(ErrorCode::ShapeMismatch,
                    what + ": has " + text(box.size()) + " voxels, not " + text(size));
    if (!field->finite()) throw Error(ErrorCode::BadData, what + ": holds NaN or infinite values");
}

}  // namespace vdbsynth
