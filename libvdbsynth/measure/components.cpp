// Connected components by runs along z: each run of a row is joined to the runs it touches in the rows
// before.
#include "libvdbsynth/measure/components.h"

#include "libvdbsynth/math/disjoint_sets.h"

#include <algorithm>
#include <functional>

namespace vdbsynth {
namespace {

struct Run {
    int begin, end;  // [begin, end) along z
};

// The runs of solid voxels of one row.
void appendRuns(const std::uint64_t* row, std::size_t words, int sizeZ, std::vector<Run>& runs) {
    int z = 0;
    const auto next = [&](int from, bool solid) {
        for (std::size_t word = std::size_t(from) >> 6; word < words; ++word) {
            std::uint64_t bits = solid ? row[word] : ~row[word];
            if (word == std::size_t(from) >> 6) bits &= ~std::uint64_t(0) << (from & 63);
            if (bits != 0) return std::min(sizeZ, int(word) * 64 + __builtin_ctzll(bits));
        }
        return sizeZ;
    };
    while ((z = next(z, true)) < sizeZ) {
        const int end = next(z, false);
        runs.push_back({z, end});
        if (end >= sizeZ) break;
        z = end;
    }
}

// Joins the runs [a, aEnd) with the runs [b, bEnd) of a neighbouring row that they touch.
void joinRows(const std::vector<Run>& runs, std::size_t a, std::size_t aEnd, std::size_t b, std::size_t bEnd,
              int reach, DisjointSets& forest) {
    while (a < aEnd && b < bEnd) {
        if (runs[a].begin < runs[b].end + reach && runs[b].begin < runs[a].end + reach)
            forest.join(std::uint32_t(a), std::uint32_t(b));
        if (runs[a].end < runs[b].end)
            ++a;
        else
            ++b;
    }
}

}  // namespace

Components findComponents(const Occupancy& solid, Neighbours neighbours) {
    const Index3& size = solid.size();
    const std::size_t rows = std::size_t(size.x) * std::size_t(size.y);
    std::vector<Run> runs;
    std::vector<std::size_t> first(rows + 1, 0);
    DisjointSets forest;
    const bool all = neighbours == Neighbours::All;
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y) {
            const std::size_t row = std::size_t(x) * std::size_t(size.y) + std::size_t(y);
            first[row] = runs.size();
            appendRuns(solid.row(x, y), solid.rowWords(), size.z, runs);
            first[row + 1] = runs.size();
            for (std::size_t run = first[row]; run < runs.size(); ++run) forest.add();
            for (int dx = -1; dx <= 0; ++dx)
                for (int dy = -1; dy <= (dx == 0 ? -1 : 1); ++dy) {
                    if ((!all && dx != 0 && dy != 0) || x + dx < 0 || y + dy < 0 || y + dy >= size.y)
                        continue;
                    const std::size_t other = std::size_t(x + dx) * std::size_t(size.y) + std::size_t(y + dy);
                    joinRows(runs, first[row], first[row + 1], first[other], first[other + 1], all ? 1 : 0,
                             forest);
                }
        }
    std::vector<std::uint64_t> voxels(runs.size(), 0);
    std::vector<char> touches(runs.size(), 0);
    for (std::size_t row = 0; row < rows; ++row) {
        const int x = int(row / std::size_t(size.y)), y = int(row % std::size_t(size.y));
        const bool side = x == 0 || y == 0 || x == size.x - 1 || y == size.y - 1;
        for (std::size_t run = first[row]; run < first[row + 1]; ++run) {
            const std::uint32_t root = forest.root(std::uint32_t(run));
            voxels[root] += std::uint64_t(runs[run].end - runs[run].begin);
            if (side || runs[run].begin == 0 || runs[run].end == size.z) touches[root] = 1;
        }
    }
    Components result;
    for (std::size_t run = 0; run < runs.size(); ++run)
        if (voxels[run] > 0) {
            result.sizes.push_back(voxels[run]);
            if (!touches[run]) result.interior.push_back(voxels[run]);
        }
    std::sort(result.sizes.begin(), result.sizes.end(), std::greater<>());
    std::sort(result.interior.begin(), result.interior.end(), std::greater<>());
    return result;
}

}  // namespace vdbsynth
