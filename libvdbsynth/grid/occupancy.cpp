#include "libvdbsynth/grid/occupancy.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Counting bits is one instruction on processors that have it, a dozen on others; the sum is equal.
__attribute__((target_clones("popcnt", "default"))) std::uint64_t countBits(const std::uint64_t* words,
                                                                            std::size_t count) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += std::uint64_t(__builtin_popcountll(words[i]));
    return sum;
}

// Bits of `row` from bit `shift` (at least 0) on: the word for word i of the result.
inline std::uint64_t shiftedWord(const std::uint64_t* row, std::size_t words, std::size_t i, int shift) {
    const std::size_t at = i + std::size_t(shift >> 6);
    const int bits = shift & 63;
    const std::uint64_t low = at < words ? row[at] >> bits : 0;
    return bits == 0 || at + 1 >= words ? low : low | row[at + 1] << (64 - bits);
}

// Pairs of voxels p in a and p + shift in b, rows [x0, x1) x [y0, y1) of a, shift.z at least 0. One function
// for all rows, since there are many short ones.
__attribute__((target_clones("popcnt", "default"))) std::uint64_t countShifted(const Occupancy& a,
                                                                               const Occupancy& b,
                                                                               const Index3& shift, int x0,
                                                                               int x1, int y0, int y1) {
    const std::size_t words = a.rowWords(), skip = std::size_t(shift.z >> 6);
    const int bits = shift.z & 63;
    std::uint64_t sum = 0;
    for (int x = x0; x < x1; ++x)
        for (int y = y0; y < y1; ++y) {
            const std::uint64_t *mine = a.row(x, y), *other = b.row(x + shift.x, y + shift.y) + skip;
            for (std::size_t i = 0; i + skip < words; ++i) {
                if (mine[i] == 0) continue;
                std::uint64_t shifted = other[i] >> bits;
                if (bits != 0 && i + skip + 1 < words) shifted |= other[i + 1] << (64 - bits);
                sum += std::uint64_t(__builtin_popcountll(mine[i] & shifted));
            }
        }
    return sum;
}

}  // namespace

Occupancy::Occupancy(const Index3& size)
    : mSize(size),
      mRowWords((std::size_t(size.z) + 63) / 64),
      mWords(std::size_t(size.x) * std::size_t(size.y) * mRowWords, 0) {}

Occupancy Occupancy::fromField(const BrickField& field, const RunContext& ctx) {
    const Index3 size = field.box().size();
    Occupancy result(size);
    constexpr int kSide = BrickField::kSide;
    const std::size_t columnsX = std::size_t(size.x + kSide - 1) / kSide;
    parallelFor(ctx, columnsX, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<float> samples;
        for (std::size_t column = begin; column < end; ++column)
            for (int y0 = 0; y0 < size.y; y0 += kSide) {
                const int x0 = int(column) * kSide;
                const Index3 part{std::min(kSide, size.x - x0), std::min(kSide, size.y - y0), size.z};
                samples.resize(latticeCount(part));
                field.readBox({x0, y0, 0}, part, samples.data());
                const float* sample = samples.data();
                for (int x = 0; x < part.x; ++x)
                    for (int y = 0; y < part.y; ++y) {
                        std::uint64_t* row = result.mutableRow(x0 + x, y0 + y);
                        for (int z = 0; z < size.z; ++z)
                            row[z >> 6] |= std::uint64_t(*sample++ < 0) << (z & 63);
                    }
            }
    });
    return result;
}

std::uint64_t Occupancy::count() const {
    return countBits(mWords.data(), mWords.size());
}

void Occupancy::clearPadding() {
    const int used = mSize.z & 63;
    if (used == 0) return;
    const std::uint64_t mask = (std::uint64_t(1) << used) - 1;
    for (std::size_t last = mRowWords - 1; last < mWords.size(); last += mRowWords) mWords[last] &= mask;
}

Occupancy Occupancy::complement() const {
    Occupancy result = *this;
    for (std::uint64_t& word : result.mWords) word = ~word;
    result.clearPadding();
    return result;
}

Occupancy Occupancy::window(const IndexBox& box) const {
    Occupancy result(box.size());
    for (int x = 0; x < result.mSize.x; ++x)
        for (int y = 0; y < result.mSize.y; ++y) {
            const std::uint64_t* from = row(x + box.min.x, y + box.min.y);
            std::uint64_t* to = result.mutableRow(x, y);
            for (std::size_t i = 0; i < result.mRowWords; ++i)
                to[i] = shiftedWord(from, mRowWords, i, box.min.z);
        }
    result.clearPadding();
    return result;
}

std::uint64_t countPairs(const Occupancy& a, const Occupancy& b, const Index3& shift) {
    // The pairs of (a, b, shift) are those of (b, a, -shift).
    if (shift.z < 0) return countPairs(b, a, {-shift.x, -shift.y, -shift.z});
    const Index3& size = a.size();
    return countShifted(a, b, shift, std::max(0, -shift.x), std::min(size.x, size.x - shift.x),
                        std::max(0, -shift.y), std::min(size.y, size.y - shift.y));
}

}  // namespace vdbsynth
