#include "libvdbsynth/map/source_gather.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace vdbsynth {
namespace {

// How a voxel's source is read: a sample's position, and its displacement per voxel of the map along x, y, z.
struct Reader {
    const BrickField* field = nullptr;
    Vec3f at, x, y, z;
    std::int32_t group = 0;  // the first reader that reads the same

    Vec3f place(const Vec3f& offset) const { return at + x * offset.x + y * offset.y + z * offset.z; }
    float operator()(const Vec3f& offset) const { return sampleCubic(*field, place(offset)); }
    static bool same(const Vec3f& a, const Vec3f& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
    bool readsAs(const Reader& other, const Vec3f& offset) const {
        constexpr float kSame = 1e-3f;  // [samples]
        if (field != other.field || !same(x, other.x) || !same(y, other.y) || !same(z, other.z)) return false;
        const Vec3f apart = other.place(offset) - at;
        return dot(apart, apart) < kSame * kSame;
    }
};

// The proposals at a voxel, those of sources that continue each other once.
class Proposals {
public:
    void add(std::int32_t reader, std::int32_t group, const Vec3f& offset, float weight) {
        for (int i = 0; i < mCount; ++i)
            if (mAll[i].group == group) {
                mAll[i].weight += weight;
                return;
            }
        mAll[mCount++] = {reader, group, offset, weight};
    }
    template <typename Value>
    float mean(const Value& valueOf) const {
        float sum = 0, weights = 0;
        for (int i = 0; i < mCount; ++i) {
            sum += mAll[i].weight * valueOf(mAll[i].reader, mAll[i].offset);
            weights += mAll[i].weight;
        }
        return sum / weights;
    }

private:
    struct Proposal {
        std::int32_t reader, group;
        Vec3f offset;
        float weight;
    };
    static constexpr std::size_t kMost = 64;  // voxels in reach of a position
    std::array<Proposal, kMost> mAll;
    int mCount = 0;
};

Reader readerOf(const Source& source, const ExemplarSamples& samples) {
    Reader reader;
    reader.field = samples.field.get();
    reader.at = cast<float>((source.position - samples.corner) * samples.samplesPerVoxel);
    const double step = samples.samplesPerVoxel / double(source.scale);
    const Affine back = rotationMatrix(-cast<double>(source.rotation));
    const auto moved = [&](const Vec3d& along) { return cast<float>(transformed(back, along) * step); };
    reader.x = moved({1, 0, 0});
    reader.y = moved({0, 1, 0});
    reader.z = moved({0, 0, 1});
    return reader;
}

// 1 up to a voxel away, 0 from two on: no proposal starts or ends abruptly between the map's voxels, where
// finer ones lie.
float taper(float offset) {
    return std::clamp(2 - std::abs(offset), 0.f, 1.f);
}

// The voxels of the map around one whose taper at `from` is over 0.
IndexBox reachOf(const Vec3f& from) {
    IndexBox reach;
    for (int axis = 0; axis < 3; ++axis) {
        reach.min[axis] = int(std::floor(from[axis])) - 1;
        reach.max[axis] = int(std::ceil(from[axis])) + 1;
    }
    return reach;
}

class Gather {
public:
    Gather(const ElementSources& sources, const IndexBox& mapBox, int factor,
           const std::vector<ExemplarSamples>& exemplars, float limit, const RunContext& ctx)
        : mBox(mapBox),
          mFactor(factor),
          mLimit(limit),
          mTable(VoxelTable::of(mapBox, sources.voxels())),
          mReaders(sources.size()) {
        makeReaders(sources, exemplars, ctx);
        groupReaders();
        if (factor == 1) readOwn(ctx);
    }

    // A voxel of the result, relative to its box's corner; `value` does not change where there is no source.
    void read(const Index3& local, float& value) const {
        if (mFactor == 1)
            readWhole(local + mBox.min, value);
        else
            readFiner(local, value);
    }

private:
    void makeReaders(const ElementSources& sources, const std::vector<ExemplarSamples>& exemplars,
                     const RunContext& ctx);
    void groupReaders();
    void readOwn(const RunContext& ctx);
    void readWhole(const Index3& voxel, float& value) const;
    void readFiner(const Index3& local, float& value) const;
    float meanOf(const Proposals& proposals) const {
        return proposals.mean([&](std::int32_t j, const Vec3f& offset) {
            return std::clamp(mReaders[std::size_t(j)](offset), -mLimit, mLimit);
        });
    }

    IndexBox mBox;
    int mFactor;
    float mLimit;
    Index3 mFirst = finerBox(mBox, mFactor).min;
    VoxelTable mTable;
    std::vector<Reader> mReaders;
    std::vector<float> mOwn;  // what each voxel's own source proposes there; empty for finer voxels
};

void Gather::makeReaders(const ElementSources& sources, const std::vector<ExemplarSamples>& exemplars,
                         const RunContext& ctx) {
    parallelFor(ctx, mReaders.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Source& source = *sources.strongest(i);
            mReaders[i] = readerOf(source, exemplars[std::size_t(source.exemplar)]);
        }
    });
}

// One after the other, so that a group is the same for any number of threads. All of a group are compared
// with its first, as small differences between neighbours would add up.
void Gather::groupReaders() {
    for (std::int32_t i = 0; i < std::int32_t(mReaders.size()); ++i) {
        Reader& reader = mReaders[std::size_t(i)];
        const Index3 voxel = mTable[std::size_t(i)];
        reader.group = i;
        for (int axis = 2; axis >= 0 && reader.group == i; --axis) {
            Index3 before = voxel;
            --before[axis];
            const std::int32_t j = mTable.find(before);
            if (j < 0 || j >= i) continue;
            const std::int32_t first = mReaders[std::size_t(j)].group;
            const Index3 apart = voxel - mTable[std::size_t(first)];
            if (reader.readsAs(mReaders[std::size_t(first)],
                               {float(apart.x), float(apart.y), float(apart.z)}))
                reader.group = first;
        }
    }
}

void Gather::readOwn(const RunContext& ctx) {
    mOwn.resize(mReaders.size());
    parallelFor(ctx, mReaders.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            mOwn[i] = std::clamp(mReaders[i]({0, 0, 0}), -mLimit, mLimit);
    });
}

// A voxel of the map. Distances change by no more than the way: a neighbour's source proposes here what it
// does there but for the step between them, so that where all are far, nothing but their side matters.
void Gather::readWhole(const Index3& voxel, float& value) const {
    constexpr float kDiagonal = 1.75f;
    static constexpr float kWeights[] = {1, 1 / 4.f, 1 / 9.f, 1 / 16.f};  // by the squared length of a step
    const std::int32_t own = mTable.find(voxel);
    if (own < 0) return;
    value = mOwn[std::size_t(own)];
    const float far = 0.5f * mLimit + kDiagonal, side = value < 0 ? -1.f : 1.f;
    std::array<std::int32_t, 27> around;
    bool allFar = true;
    std::size_t count = 0;
    forEachVoxel(IndexBox{voxel, voxel}.expanded(1), [&](const Index3& p) {
        const std::int32_t j = around[count++] = mTable.find(p);
        allFar = allFar && (j < 0 || mOwn[std::size_t(j)] * side >= far);
    });
    if (allFar) return;
    Proposals proposals;
    count = 0;
    forEachVoxel(IndexBox{{-1, -1, -1}, {1, 1, 1}}, [&](const Index3& step) {
        const std::int32_t j = around[count++];
        if (j < 0) return;
        const int squared = step.x * step.x + step.y * step.y + step.z * step.z;
        proposals.add(j, mReaders[std::size_t(j)].group, {float(-step.x), float(-step.y), float(-step.z)},
                      kWeights[squared]);
    });
    value = meanOf(proposals);
}

void Gather::readFiner(const Index3& local, float& value) const {
    // Voxel i of the map covers the voxels factor * i + shift .. that begin at finerBox.
    const Index3 fine = local + mFirst;
    const Index3 voxel{local.x / mFactor + mBox.min.x, local.y / mFactor + mBox.min.y,
                       local.z / mFactor + mBox.min.z};
    if (mTable.find(voxel) < 0) return;
    // Distance of the position from that voxel's middle [voxels of the map].
    Vec3f from;
    for (int axis = 0; axis < 3; ++axis)
        from[axis] = float(fine[axis] - voxel[axis] * mFactor) / float(mFactor);
    Proposals proposals;
    forEachVoxel(reachOf(from), [&](const Index3& step) {
        const std::int32_t j = mTable.find(voxel + step);
        if (j < 0) return;
        const Vec3f offset = from - Vec3f{float(step.x), float(step.y), float(step.z)};
        const float far = 1 + dot(offset, offset);
        const float weight = taper(offset.x) * taper(offset.y) * taper(offset.z) / (far * far);
        proposals.add(j, mReaders[std::size_t(j)].group, offset, weight);
    });
    value = meanOf(proposals);
}

}  // namespace

BrickField gatherThroughSources(const ElementSources& sources, const IndexBox& mapBox, int factor,
                                const std::vector<ExemplarSamples>& exemplars, const BrickField& otherwise,
                                float limit, const RunContext& ctx) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Source* source = sources.strongest(i);
        if (!source || source->exemplar < 0 || std::size_t(source->exemplar) >= exemplars.size() ||
            !mapBox.contains(sources.voxels()[i]))
            throw Error(ErrorCode::ShapeMismatch,
                        "voxel " + std::to_string(i) + " of the source map has no exemplar, or lies outside");
    }
    const Gather gather(sources, mapBox, factor, exemplars, limit, ctx);
    return BrickField::generate(otherwise.box(), ctx, [&](const IndexBox& brick, float* samples) {
        otherwise.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const Index3 p = brick.min + Index3{i >> 6, (i >> 3) & 7, i & 7};
            if (otherwise.box().contains(p)) gather.read(p, samples[i]);
        }
    });
}

}  // namespace vdbsynth
