#include "libvdbsynth/search/block_correlation.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kLanes = Lanes::kCount;

Index3 transformSize(const Index3& exemplar) {
    const auto wholeGroups = [](int n) { return kLanes * transformLength((n + kLanes - 1) / kLanes); };
    return {transformLength(exemplar.x), wholeGroups(exemplar.y), wholeGroups(exemplar.z)};
}

double volume(const Index3& size) {
    return double(size.x) * double(size.y) * double(size.z);
}

// Transposes numbers: lane j of number i becomes lane i of number j.
void transpose(const ComplexLanes* from, std::ptrdiff_t step, ComplexLanes* to, std::ptrdiff_t toStep) {
    Lanes real[kLanes], imaginary[kLanes];
    for (int j = 0; j < kLanes; ++j)
        for (int i = 0; i < kLanes; ++i) {
            real[j].values[i] = from[i * step].real().values[j];
            imaginary[j].values[i] = from[i * step].imag().values[j];
        }
    for (int j = 0; j < kLanes; ++j) to[j * toStep] = {real[j], imaginary[j]};
}

BrickField squares(const BrickField& field, const RunContext& ctx) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] *= samples[i];
    });
}

}  // namespace

BlockCorrelation::BlockCorrelation(const BrickField& exemplar, int block, const RunContext& ctx)
    : mExemplar(exemplar.box().size()),
      mSize(transformSize(mExemplar)),
      mPositions{mExemplar.x - block + 1, mExemplar.y - block + 1, mExemplar.z - block + 1},
      mBlock(block),
      mAlongX(mSize.x),
      mAlongY(mSize.y),
      mAlongZ(mSize.z) {
    const BrickField squared = squares(exemplar, ctx);
    std::vector<float> slab(std::size_t(mExemplar.y) * std::size_t(mExemplar.z));
    for (int x = 0; x < mExemplar.x; ++x) {
        double sum = 0;
        squared.readBox({x, 0, 0}, {1, mExemplar.y, mExemplar.z}, slab.data());
        for (float square : slab) {
            sum += double(square);
            mLargest = std::max(mLargest, square);
        }
        mMeanSquare += sum / volume(mExemplar);
    }
    mLargest = std::sqrt(mLargest);
    mConjugate = conjugateSpectrum(exemplar, false, mNorm, ctx);
    mConjugateSquares = conjugateSpectrum(squared, true, mSquaresNorm, ctx);
    mEnergies.size = mPositions;
    mEnergies.samples.resize(std::size_t(volume(mPositions)));
    slidingMean(squared, block, ctx).readBox({0, 0, 0}, mPositions, mEnergies.samples.data());
}

std::vector<ComplexLanes> BlockCorrelation::conjugateSpectrum(const BrickField& exemplar, bool squared,
                                                              double& norm, const RunContext& ctx) const {
    std::vector<ComplexLanes> spectrum(lines() * std::size_t(mSize.x));
    const float less = squared ? float(mMeanSquare) : 0.f;
    std::vector<double> norms(std::size_t(mExemplar.x), 0);
    parallelFor(ctx, std::size_t(mExemplar.x), 4, [&](std::size_t begin, std::size_t end) {
        Workspace workspace;
        const Fill fill = [&](int x, int y, float* real, float*) {
            exemplar.readBox({x, y, 0}, {1, 1, mExemplar.z}, real);
            for (int z = 0; z < mExemplar.z; ++z) {
                real[z] -= less;
                norms[std::size_t(x)] += double(real[z]) * double(real[z]);
            }
        };
        workspace.planes.resize(lines() * (end - begin));  // so that four neighbours are written together
        for (std::size_t x = begin; x < end; ++x) {
            transformPlane(int(x), mExemplar.y, mExemplar.z, fill, workspace);
            std::copy(workspace.plane.begin(), workspace.plane.end(),
                      workspace.planes.begin() + std::ptrdiff_t((x - begin) * lines()));
        }
        for (std::size_t l = 0; l < lines(); ++l)
            for (std::size_t x = begin; x < end; ++x)
                spectrum[l * std::size_t(mSize.x) + x] = workspace.planes[(x - begin) * lines() + l];
    });
    parallelFor(ctx, lines(), 256, [&](std::size_t begin, std::size_t end) {
        std::vector<ComplexLanes> line(std::size_t(mSize.x));
        for (std::size_t l = begin; l < end; ++l) {
            ComplexLanes* const place = spectrum.data() + l * std::size_t(mSize.x);
            mAlongX.run(place, line.data());
            for (int x = 0; x < mSize.x; ++x)
                place[x] = {line[std::size_t(x)].real(), -line[std::size_t(x)].imag()};
        }
    });
    double sum = 0;
    for (double part : norms) sum += part;
    norm = std::sqrt(sum);
    return spectrum;
}

// Transforms the plane x along z and y, to workspace.plane: lines along y, four neighbours along z
// interleaved. Only `rows` and `samples` are nonzero.
void BlockCorrelation::transformPlane(int x, int rows, int samples, const Fill& fill,
                                      Workspace& workspace) const {
    const std::size_t ny = std::size_t(mSize.y), nz = std::size_t(mSize.z);
    workspace.plane.resize(lines());
    workspace.other.assign(lines(), ComplexLanes(0.0, 0.0));
    workspace.line.assign(nz, ComplexLanes(0.0, 0.0));
    workspace.sum.resize(nz);
    workspace.samples.assign(2 * std::size_t(samples), 0.f);
    float *const real = workspace.samples.data(), *const imaginary = real + samples;
    for (int y = 0; y < rows; y += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            if (y + lane < rows)
                fill(x, y + lane, real, imaginary);
            else
                std::fill(workspace.samples.begin(), workspace.samples.end(), 0.f);
            for (int z = 0; z < samples; ++z) {
                Lanes re = workspace.line[std::size_t(z)].real(), im = workspace.line[std::size_t(z)].imag();
                re.values[lane] = real[z];
                im.values[lane] = imaginary[z];
                workspace.line[std::size_t(z)] = {re, im};
            }
        }
        mAlongZ.run(workspace.line.data(), workspace.sum.data());
        for (std::size_t z = 0; z < nz; z += kLanes)
            transpose(workspace.sum.data() + z, 1, workspace.other.data() + z / kLanes * ny + std::size_t(y),
                      1);
    }
    for (std::size_t l = 0; l < lines(); l += ny)
        mAlongY.run(workspace.other.data() + l, workspace.plane.data() + l);
}

void BlockCorrelation::transformQuery(const std::array<Slot, 2>& slots, bool masks,
                                      std::vector<ComplexLanes>& to, Workspace& workspace) const {
    const std::size_t n = std::size_t(mBlock);
    to.resize(lines() * n);
    const auto row = [&](const Slot& slot, int x, int y, float* out) {
        if (!slot.query || (masks && !slot.masked)) return;
        const double scale = (masks ? 1 : -2) / (slot.known * volume(mSize));
        const std::size_t begin = (std::size_t(x) * n + std::size_t(y)) * n;
        for (std::size_t z = 0; z < n; ++z) {
            const bool known = !slot.query->known || slot.query->known[begin + z];
            const double value = masks ? 1.0 : double(slot.query->samples[begin + z]);
            out[z] = known ? float(value * scale) : 0.f;
        }
    };
    const Fill fill = [&](int x, int y, float* real, float* imaginary) {
        row(slots[0], x, y, real);
        row(slots[1], x, y, imaginary);
    };
    for (int x = 0; x < mBlock; ++x) {
        transformPlane(x, mBlock, mBlock, fill, workspace);
        for (std::size_t l = 0; l < lines(); ++l) to[l * n + std::size_t(x)] = workspace.plane[l];
    }
}

// Along x forward and, multiplied by the exemplar's spectrum, back; only the positions' part is kept.
void BlockCorrelation::multiply(bool masked, Workspace& workspace) const {
    constexpr std::size_t kTogether = 8;  // lines, so that writes are contiguous
    const std::size_t nx = std::size_t(mSize.x), n = std::size_t(mBlock);
    workspace.planes.resize(lines() * std::size_t(mPositions.x));
    workspace.line.assign(nx, ComplexLanes(0.0, 0.0));
    workspace.other.resize(nx);
    workspace.plane.resize(nx * kTogether);
    workspace.sum.resize(nx);
    const auto product = [&](const std::vector<ComplexLanes>& query, const std::vector<ComplexLanes>& by,
                             std::size_t l, bool add) {
        std::copy_n(query.data() + l * n, n, workspace.line.data());
        mAlongX.run(workspace.line.data(), workspace.other.data());
        const ComplexLanes* const factor = by.data() + l * nx;
        for (std::size_t x = 0; x < nx; ++x) {
            const ComplexLanes value = workspace.other[x] * factor[x];
            workspace.sum[x] = add ? workspace.sum[x] + value : value;
        }
    };
    for (std::size_t begin = 0; begin < lines(); begin += kTogether) {
        const std::size_t count = std::min(kTogether, lines() - begin);
        for (std::size_t i = 0; i < count; ++i) {
            product(workspace.query, mConjugate, begin + i, false);
            if (masked) product(workspace.mask, mConjugateSquares, begin + i, true);
            mAlongX.run(workspace.sum.data(), workspace.plane.data() + i * nx);
        }
        for (std::size_t x = 0; x < std::size_t(mPositions.x); ++x)
            for (std::size_t i = 0; i < count; ++i)
                workspace.planes[x * lines() + begin + i] = workspace.plane[i * nx + x];
    }
}

void BlockCorrelation::finishPlane(int x, const std::array<Slot, 2>& slots, float off, Workspace& workspace,
                                   const Visit& visit) const {
    const std::size_t ny = std::size_t(mSize.y), nz = std::size_t(mSize.z);
    const ComplexLanes* const from = workspace.planes.data() + std::size_t(x) * lines();
    for (std::size_t l = 0; l < lines(); l += ny) mAlongY.run(from + l, workspace.plane.data() + l);
    for (int y = 0; y < mPositions.y; y += kLanes) {
        for (std::size_t z = 0; z < nz; z += kLanes)
            transpose(workspace.plane.data() + z / kLanes * ny + std::size_t(y), 1, workspace.line.data() + z,
                      1);
        mAlongZ.run(workspace.line.data(), workspace.other.data());
        for (int slot = 0; slot < (slots[1].query ? 2 : 1); ++slot)
            for (int lane = 0; lane < std::min(kLanes, mPositions.y - y); ++lane) {
                const Slot& of = slots[std::size_t(slot)];
                const float* const energies = mEnergies.row(x, y + lane, 0);
                float* const out = workspace.costs.data();
                for (int z = 0; z < mPositions.z; ++z) {
                    const ComplexLanes& value = workspace.other[std::size_t(z)];
                    out[z] = (slot == 0 ? value.real() : value.imag()).values[lane] + of.constant;
                }
                if (!of.masked)
                    for (int z = 0; z < mPositions.z; ++z) out[z] += energies[z];
                visit(slot, x, y + lane, out, mPositions.z, off);
            }
    }
}

// The products' sums are at most the products of the norms, and so are the rounding errors of each transform:
// of the exemplar and the query by [higham2002, Theorem 24.2] in the 2-norm, of their product term by term.
// The rest is rounding of squares, means and constants.
float BlockCorrelation::mostOff(const std::array<Slot, 2>& slots) const {
    double query = 0, mask = 0;
    float largest = mLargest;
    for (const Slot& slot : slots) {
        if (!slot.query) continue;
        double squares = 0;
        for (std::size_t i = 0; i < latticeCount({mBlock, mBlock, mBlock}); ++i) {
            if (slot.query->known && !slot.query->known[i]) continue;
            squares += double(slot.query->samples[i]) * double(slot.query->samples[i]);
            largest = std::max(largest, std::abs(slot.query->samples[i]));
        }
        query += squares / (slot.known * slot.known);
        if (slot.masked) mask += 1 / slot.known;
    }
    const double rounding = 3 * transformRounding(volume(mSize)) + 1e-6;
    return float(rounding * (2 * mNorm * std::sqrt(query) + mSquaresNorm * std::sqrt(mask)) +
                 4e-6 * double(largest) * double(largest));
}

void BlockCorrelation::costs(const BlockQuery& first, const BlockQuery* second, Workspace& workspace,
                             const Visit& visit) const {
    std::array<Slot, 2> slots;
    slots[0].query = &first;
    slots[1].query = second;
    bool masked = false;
    for (Slot& slot : slots) {
        if (!slot.query) continue;
        const std::int64_t all = std::int64_t(mBlock) * mBlock * mBlock;
        const std::int64_t known = countKnown(slot.query->known, mBlock);
        slot.known = double(known);
        slot.masked = known < all;
        masked = masked || slot.masked;
        double squares = 0;
        for (std::int64_t i = 0; i < all; ++i)
            if (!slot.query->known || slot.query->known[i])
                squares += double(slot.query->samples[i]) * double(slot.query->samples[i]);
        slot.constant = float(squares / slot.known + (slot.masked ? mMeanSquare : 0));
    }
    transformQuery(slots, false, workspace.query, workspace);
    if (masked) transformQuery(slots, true, workspace.mask, workspace);
    multiply(masked, workspace);
    workspace.plane.resize(lines());
    workspace.line.resize(std::size_t(mSize.z));
    workspace.other.resize(std::size_t(mSize.z));
    workspace.costs.resize(std::size_t(mPositions.z));
    const float off = mostOff(slots);
    for (int x = 0; x < mPositions.x; ++x) finishPlane(x, slots, off, workspace, visit);
}

double BlockCorrelation::work(const Index3& exemplar) {
    const double samples = volume(transformSize(exemplar));
    return 5 * samples * logarithm2(samples) * 2 / 3;
}

std::size_t BlockCorrelation::memoryBytes() const {
    return (mConjugate.size() + mConjugateSquares.size()) * sizeof(ComplexLanes) +
           mEnergies.samples.size() * sizeof(float);
}

double BlockCorrelation::memoryNeeded(const Index3& exemplar, int block) {
    const double samples = volume(transformSize(exemplar));
    return samples * 28 + 16 * samples / exemplar.x * block;
}

}  // namespace vdbsynth
