#include "libvdbsynth/patch/barred_columns.h"

#include "libvdbsynth/base/error.h"

namespace vdbsynth {

BarredColumns::BarredColumns(const PatchLattice& lattice, const std::vector<std::uint8_t>& barred)
    : mNx(lattice.nx), mNy(lattice.ny), mSums((std::size_t(mNx) + 1) * (std::size_t(mNy) + 1), 0) {
    if (barred.size() != lattice.columns())
        throw Error(ErrorCode::ShapeMismatch, "barred columns and the lattice differ in number");
    for (int i = 0; i < mNx; ++i)
        for (int j = 0; j < mNy; ++j)
            mSums[at(i + 1, j + 1)] = mSums[at(i, j + 1)] + mSums[at(i + 1, j)] - mSums[at(i, j)] +
                                      (barred[lattice.column(i, j)] ? 1 : 0);
}

bool BarredColumns::any(int i, int j, int nx, int ny) const {
    return mSums[at(i + nx, j + ny)] + mSums[at(i, j)] != mSums[at(i, j + ny)] + mSums[at(i + nx, j)];
}

std::size_t BarredColumns::places(int nx, int ny) const {
    std::size_t count = 0;
    for (int i = 0; i + nx <= mNx; ++i)
        for (int j = 0; j + ny <= mNy; ++j)
            if (!any(i, j, nx, ny)) ++count;
    return count;
}

}  // namespace vdbsynth
