#include "libvdbsynth/patch/layout/patch_layout_steps.h"
#include "libvdbsynth/patch/layout/patch_seams.h"

#include <algorithm>
#include <numeric>

namespace vdbsynth {
namespace {

double total(const std::vector<double>& costs) {
    return std::accumulate(costs.begin(), costs.end(), 0.0);
}

}  // namespace

bool PatchLayer::tryRepair(const PatchPlace& at) {
    const int side = mOptions.patch, nz = mArrangement.lattice.nz;
    const auto seams = [&] {
        return total(seamCosts(mExemplar, mArrangement, at.i - 1, at.j - 1, side + 1, side + 1));
    };
    std::vector<std::int32_t> before;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const std::int32_t* labels =
                mArrangement.label.data() + mArrangement.columnAt(at.i + i, at.j + j) * nz;
            before.insert(before.end(), labels, labels + nz);
        }
    const double old = seams();
    // Of the middle, which is not compared, everything is replaced.
    lay(at, side, side, mOptions.overlap, std::max(0, (side - 1) / 2 - mOptions.overlap));
    if (seams() < old) return true;
    mArrangement.patches.pop_back();
    auto from = before.begin();
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j, from += nz)
            std::copy(from, from + nz,
                      mArrangement.label.begin() + mArrangement.columnAt(at.i + i, at.j + j) * nz);
    return false;
}

int PatchLayer::repair() {
    const int nx = mArrangement.lattice.nx, ny = mArrangement.lattice.ny, side = mOptions.patch;
    if (nx < side || ny < side) return 0;
    const std::vector<double> costs = seamCosts(mExemplar, mArrangement, 0, 0, nx, ny, mContext);
    // Cells half a patch wide; a patch is laid over the middle of the worst.
    const int cell = std::max(1, side / 2), cx = (nx + cell - 1) / cell, cy = (ny + cell - 1) / cell;
    std::vector<double> sums(std::size_t(cx) * std::size_t(cy), 0.0);
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j)
            sums[std::size_t(i / cell) * std::size_t(cy) + std::size_t(j / cell)] +=
                costs[std::size_t(i) * std::size_t(ny) + std::size_t(j)];
    std::vector<std::size_t> order(sums.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sums[a] > sums[b]; });
    order.resize((order.size() + 3) / 4);
    Stage stage(mContext, "mending seams", order.size());
    int kept = 0;
    for (const std::size_t number : order) {
        PatchPlace at{int(number / std::size_t(cy)) * cell + cell / 2 - side / 2,
                      int(number % std::size_t(cy)) * cell + cell / 2 - side / 2};
        if (!mArrangement.tile) {
            at.i = std::clamp(at.i, 0, nx - side);
            at.j = std::clamp(at.j, 0, ny - side);
        }
        if (sums[number] > 0 && tryRepair(at)) ++kept;
        stage.advance();
    }
    return kept;
}

}  // namespace vdbsynth
