#include "libvdbsynth/patch/patch_arrangement.h"

#include <algorithm>

namespace vdbsynth {
namespace {

int wrapped(int i, int count) {
    return ((i % count) + count) % count;
}

// Of all columns i + n * count the one nearest to [0, side).
int nearestPeriod(int i, int side, int count) {
    const int inside = wrapped(i, count);
    return 2 * inside > side + count ? inside - count : inside;
}

float movedDistance(const float* node, const Vec3d& fine) {
    const float moved =
        node[0] - (node[1] * float(fine.x) + node[2] * float(fine.y) + node[3] * float(fine.z));
    return std::clamp(moved, -kFieldReach, kFieldReach);
}

}  // namespace

std::ptrdiff_t PatchArrangement::columnAt(int i, int j) const {
    if (tile) return std::ptrdiff_t(lattice.column(wrapped(i, lattice.nx), wrapped(j, lattice.ny)));
    if (i < 0 || j < 0 || i >= lattice.nx || j >= lattice.ny) return -1;
    return std::ptrdiff_t(lattice.column(i, j));
}

Vec3d shiftOf(const PatchArrangement& arrangement, std::int32_t patch) {
    const LaidPatch& laid = arrangement.patches[std::size_t(patch)];
    return Vec3d{laid.at.i - laid.from.i + laid.fine.x, laid.at.j - laid.from.j + laid.fine.y, laid.fine.z} *
           arrangement.lattice.step;
}

PatchPlace sourceColumn(const PatchArrangement& arrangement, const LaidPatch& patch, int i, int j) {
    int across = i - patch.at.i, along = j - patch.at.j;
    if (arrangement.tile) {
        across = nearestPeriod(across, patch.nx, arrangement.lattice.nx);
        along = nearestPeriod(along, patch.ny, arrangement.lattice.ny);
    }
    return {patch.from.i + across, patch.from.j + along};
}

void moveColumn(const float* from, int nz, const Vec3d& fine, float* values) {
    for (int k = 0; k < nz; ++k, from += kFieldValues, values += kFieldValues) {
        values[0] = movedDistance(from, fine);
        std::copy(from + 1, from + kFieldValues, values + 1);
    }
}

void readColumn(const PatchField& exemplar, const PatchArrangement& arrangement, int i, int j,
                float* values) {
    const int nz = arrangement.lattice.nz;
    const std::ptrdiff_t column = arrangement.columnAt(i, j);
    const std::int32_t* labels = arrangement.label.data() + column * nz;
    const float* from = nullptr;
    for (int k = 0; k < nz; ++k) {
        const LaidPatch& patch = arrangement.patches[std::size_t(labels[k])];
        if (k == 0 || labels[k] != labels[k - 1]) {
            const PatchPlace source = sourceColumn(arrangement, patch, i, j);
            from = exemplar.column(source.i, source.j);
        }
        const float* node = from + k * kFieldValues;
        values[k * kFieldValues] = movedDistance(node, patch.fine);
        std::copy(node + 1, node + kFieldValues, values + k * kFieldValues + 1);
    }
}

}  // namespace vdbsynth
