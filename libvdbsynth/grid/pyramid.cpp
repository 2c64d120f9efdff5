#include "libvdbsynth/grid/pyramid.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

// Sums over `cell` neighbours along the last axis of a [rows x length] array, then transposes the axes
// (x,y,z) to (z,x,y): three passes sum a cube and restore the order.
void sumAndTranspose(const std::vector<double>& in, const Index3& size, int cell, std::vector<double>& out) {
    const Index3 transposed{size.z - cell + 1, size.x, size.y};
    out.assign(latticeCount(transposed), 0.0);
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y) {
            const double* row = in.data() + latticeIndex({x, y, 0}, size);
            for (int z = 0; z < transposed.x; ++z) {
                double sum = 0;
                for (int k = 0; k < cell; ++k) sum += row[z + k];
                out[latticeIndex({z, x, y}, transposed)] = sum;
            }
        }
}

}  // namespace

BrickField slidingMean(const BrickField& field, int cell, const RunContext& ctx) {
    if (cell < 1) throw Error(ErrorCode::InvalidOption, "cell of an average must be at least 1");
    if (cell == 1) return field;
    if (cell % 2 == 0) return twiceSlidingMean(slidingMean(field, cell / 2, ctx), cell / 2, ctx);
    const double scale = 1.0 / (double(cell) * cell * cell);
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float constant = 0;
        const IndexBox reach{brick.min, brick.max + Index3{cell - 1, cell - 1, cell - 1}};
        if (field.constantIn(reach, constant)) {
            std::fill(samples, samples + BrickField::kSamples, constant);
            return;
        }
        const int n = kSide + cell - 1;
        thread_local std::vector<float> values;
        thread_local std::vector<double> a, b;
        values.resize(latticeCount({n, n, n}));
        field.readBox(brick.min, {n, n, n}, values.data());
        a.assign(values.begin(), values.end());
        sumAndTranspose(a, {n, n, n}, cell, b);
        sumAndTranspose(b, {kSide, n, n}, cell, a);
        sumAndTranspose(a, {kSide, kSide, n}, cell, b);
        for (std::size_t i = 0; i < BrickField::kSamples; ++i) samples[i] = float(b[i] * scale);
    });
}

BrickField twiceSlidingMean(const BrickField& mean, int cell, const RunContext& ctx) {
    return BrickField::generate(mean.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float constant = 0;
        if (mean.constantIn({brick.min, brick.max + Index3{cell, cell, cell}}, constant)) {
            std::fill(samples, samples + BrickField::kSamples, constant);
            return;
        }
        double sums[BrickField::kSamples] = {};
        float values[BrickField::kSamples];
        for (int corner = 0; corner < 8; ++corner) {
            const Index3 offset{corner & 4 ? cell : 0, corner & 2 ? cell : 0, corner & 1 ? cell : 0};
            mean.readBox(brick.min + offset, {kSide, kSide, kSide}, values);
            for (int i = 0; i < BrickField::kSamples; ++i) sums[i] += double(values[i]);
        }
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = float(sums[i] * 0.125);
    });
}

BrickField halved(const BrickField& field, const RunContext& ctx) {
    const Index3 fine = field.box().size();
    const IndexBox box = IndexBox::fromSize({(fine.x + 1) / 2, (fine.y + 1) / 2, (fine.z + 1) / 2});
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        thread_local std::vector<float> values;
        values.resize(8 * BrickField::kSamples);
        field.readBox(brick.min * 2, {2 * kSide, 2 * kSide, 2 * kSide}, values.data());
        forEachVoxel(IndexBox::cube({0, 0, 0}, kSide), [&](const Index3& p) {
            double sum = 0;
            for (int corner = 0; corner < 8; ++corner)
                sum += values[std::size_t(
                    ((2 * p.x + (corner >> 2)) * 2 * kSide + 2 * p.y + ((corner >> 1) & 1)) * 2 * kSide +
                    2 * p.z + (corner & 1))];
            *samples++ = float(sum * 0.125);
        });
    });
}

BrickField halvedMask(const BrickField& mask, const RunContext& ctx) {
    const BrickField coarse = halved(mask, ctx);
    return BrickField::generate(coarse.box(), ctx, [&](const IndexBox& brick, float* samples) {
        coarse.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = samples[i] == 1.f ? 1.f : 0.f;
    });
}

bool blockFitsInside(const BrickField& mask, int block, const RunContext& ctx) {
    const IndexBox box = mask.box();
    const BrickField means = slidingMean(mask, block, ctx);
    for (int x = box.min.x; x + block - 1 <= box.max.x; ++x)
        for (int y = box.min.y; y + block - 1 <= box.max.y; ++y)
            for (int z = box.min.z; z + block - 1 <= box.max.z; ++z)
                if (means.inside({x, y, z}) == 1.f) return true;
    return false;
}

BrickField doubled(const BrickField& field, const Index3& size, const RunContext& ctx) {
    return BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr int n = kSide / 2 + 2;
        const Index3 corner{brick.min.x / 2 - 1, brick.min.y / 2 - 1, brick.min.z / 2 - 1};
        float values[n * n * n];
        field.readBox(corner, {n, n, n}, values);
        forEachVoxel(IndexBox::cube({0, 0, 0}, kSide), [&](const Index3& p) {
            // Fine voxel f lies at f/2 - 1/4 in coarse voxels: weights 3/4 and 1/4.
            const int lx = (p.x + 1) / 2, ly = (p.y + 1) / 2, lz = (p.z + 1) / 2;
            float sum = 0;
            for (int c = 0; c < 8; ++c) {
                const int dx = c >> 2, dy = (c >> 1) & 1, dz = c & 1;
                const float wx = (p.x & 1) == dx ? 0.25f : 0.75f;
                const float wy = (p.y & 1) == dy ? 0.25f : 0.75f;
                const float wz = (p.z & 1) == dz ? 0.25f : 0.75f;
                sum += wx * wy * wz * values[((lx + dx) * n + ly + dy) * n + lz + dz];
            }
            *samples++ = sum;
        });
    });
}

}  // namespace vdbsynth
