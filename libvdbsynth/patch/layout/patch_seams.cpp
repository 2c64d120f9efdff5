#include "libvdbsynth/patch/layout/patch_seams.h"

#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kClamp = 1.5, kMissing = 3;  // [steps]

class SeamReader {
public:
    SeamReader(const PatchField& exemplar, const PatchArrangement& arrangement)
        : mExemplar(exemplar), mArrangement(arrangement) {}

    double column(int i, int j) const {
        const int nz = mArrangement.lattice.nz;
        const std::int32_t* here = labels(i, j);
        if (!here || *here == PatchArrangement::kNone) return 0;
        const std::int32_t *right = labels(i + 1, j), *up = labels(i, j + 1);
        if (right && *right == PatchArrangement::kNone) right = nullptr;
        if (up && *up == PatchArrangement::kNone) up = nullptr;
        double sum = 0;
        for (int k = 0; k < nz; ++k) {
            if (right && right[k] != here[k]) sum += pair(i, j, k, i + 1, j, k, here[k], right[k]);
            if (up && up[k] != here[k]) sum += pair(i, j, k, i, j + 1, k, here[k], up[k]);
            if (k + 1 < nz && here[k + 1] != here[k]) sum += pair(i, j, k, i, j, k + 1, here[k], here[k + 1]);
        }
        return sum;
    }

private:
    const std::int32_t* labels(int i, int j) const {
        const std::ptrdiff_t column = mArrangement.columnAt(i, j);
        return column < 0 ? nullptr : mArrangement.label.data() + column * mArrangement.lattice.nz;
    }

    double pair(int ai, int aj, int ak, int bi, int bj, int bk, std::int32_t p, std::int32_t q) const {
        return apart(ai, aj, ak, p, q) + apart(bi, bj, bk, p, q);
    }

    double apart(int i, int j, int k, std::int32_t p, std::int32_t q) const {
        float a = 0, b = 0;
        if (!read(i, j, k, p, a) || !read(i, j, k, q, b)) return kMissing;
        return std::abs(std::clamp(double(a), -kClamp, kClamp) - std::clamp(double(b), -kClamp, kClamp));
    }

    bool read(int i, int j, int k, std::int32_t number, float& value) const {
        const LaidPatch& patch = mArrangement.patches[std::size_t(number)];
        const PatchPlace source = sourceColumn(mArrangement, patch, i, j);
        const PatchLattice& l = mExemplar.lattice;
        if (source.i < 0 || source.j < 0 || source.i >= l.nx || source.j >= l.ny) return false;
        float node[kFieldValues];
        moveColumn(mExemplar.column(source.i, source.j) + k * kFieldValues, 1, patch.fine, node);
        value = node[0];
        return true;
    }

    const PatchField& mExemplar;
    const PatchArrangement& mArrangement;
};

}  // namespace

std::vector<double> seamCosts(const PatchField& exemplar, const PatchArrangement& arrangement, int i, int j,
                              int nx, int ny, const RunContext& ctx) {
    const SeamReader reader(exemplar, arrangement);
    std::vector<double> costs(std::size_t(nx) * std::size_t(ny));
    parallelFor(ctx, std::size_t(nx), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t across = begin; across < end; ++across)
            for (int along = 0; along < ny; ++along)
                costs[across * std::size_t(ny) + std::size_t(along)] =
                    reader.column(i + int(across), j + along);
    });
    return costs;
}

}  // namespace vdbsynth
