#include "libvdbsynth/analogy/analogy_level.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

template <typename Of>
BrickField mapped(const BrickField& field, const RunContext& ctx, const Of& of) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = of(samples[i]);
    });
}

// Frames of voxels that have none: the mean of their neighbours', repeated until all have one.
void fillFrames(AnalogyVoxels& voxels, std::vector<char>& known) {
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < known.size(); ++i)
        if (!known[i]) open.push_back(i);
    while (!open.empty()) {
        std::vector<std::uint32_t> left;
        std::vector<std::pair<std::uint32_t, Frame>> found;
        std::vector<float> sweeps;
        for (std::uint32_t i : open) {
            Vec3f t, n;
            float sweep = 0;
            int count = 0;
            for (const Index3& step : kAllNeighbours) {
                const std::int32_t j = voxels.table.find(voxels.table[i] + step);
                if (j < 0 || !known[std::size_t(j)]) continue;
                t = t + voxels.frame[std::size_t(j)].t;
                n = n + voxels.frame[std::size_t(j)].n;
                sweep += voxels.sweep[std::size_t(j)];
                ++count;
            }
            if (count == 0) {
                left.push_back(i);
                continue;
            }
            if (length(n) < 1e-3f) n = {0, 0, 1};
            found.push_back({i, frameFrom(n, t)});
            sweeps.push_back(sweep / float(count));
        }
        for (std::size_t f = 0; f < found.size(); ++f) {
            voxels.frame[found[f].first] = found[f].second;
            voxels.sweep[found[f].first] = sweeps[f];
            known[found[f].first] = 1;
        }
        if (found.empty()) return;  // a component without any: it keeps the grid's axes
        open.swap(left);
    }
}

// Curvature of the plain model's parallel surface through a point, in voxels of the level.
Curvature curvatureAt(const BrickField& distance, const Vec3f& at, const Frame& frame, int level) {
    const float step = float(1 << level);
    const auto change = [&](const Vec3f& along) {
        const auto normal = [&](const Vec3f& p) {
            const Vec3f gradient = sampleGradient(distance, p);
            return gradient * (1 / std::max(length(gradient), 1e-3f));
        };
        return (normal(at + along * step) - normal(at - along * step)) * 0.5f;
    };
    const auto most = [](float v) { return std::clamp(v, -kMostCurvature, kMostCurvature); };
    const Vec3f t = change(frame.t), b = change(frame.b);
    return {most(dot(t, frame.t)), most((dot(t, frame.b) + dot(b, frame.t)) / 2), most(dot(b, frame.b))};
}

}  // namespace

BrickField densityField(const BrickField& distance, const RunContext& ctx) {
    return mapped(distance, ctx, densityOf);
}

AnalogyPyramid analogyPyramid(const BrickField& distance, int levels, const RunContext& ctx) {
    AnalogyPyramid pyramid;
    for (int level = 0; level < levels; ++level) {
        pyramid.distance.push_back(
            level == 0 ? distance
                       : mapped(halved(pyramid.distance.back(), ctx), ctx, [](float d) { return d / 2; }));
        pyramid.density.push_back(densityField(pyramid.distance.back(), ctx));
    }
    return pyramid;
}

AnalogyVoxels analogyVoxels(VoxelTable table, const FrameField& frames, int level, bool aligned,
                            bool curvatureAdapted, const RunContext& ctx) {
    AnalogyVoxels voxels;
    voxels.table = std::move(table);
    voxels.frame.resize(voxels.table.size());
    voxels.sweep.resize(voxels.table.size());
    voxels.curvature.resize(voxels.table.size());
    std::vector<char> known(voxels.table.size(), 1);
    parallelFor(ctx, voxels.table.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index3& v = voxels.table[i];
            const Vec3f at = toFinest({float(v.x), float(v.y), float(v.z)}, level);
            if (aligned)
                known[i] = frames.at(at, voxels.frame[i], voxels.sweep[i]);
            else
                voxels.sweep[i] = at.x;
        }
    });
    if (aligned) fillFrames(voxels, known);
    if (aligned && curvatureAdapted)
        parallelFor(ctx, voxels.table.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Index3& v = voxels.table[i];
                const Vec3f at = toFinest({float(v.x), float(v.y), float(v.z)}, level);
                voxels.curvature[i] = curvatureAt(frames.distance(), at, voxels.frame[i], level);
            }
        });
    return voxels;
}

DepthClasses::DepthClasses(int radius) : mRadius(radius), mKind(2 * kDeepest + 1, Kind::Unseen) {}

std::size_t DepthClasses::index(float plain) {
    return std::size_t(std::clamp(int(std::lround(plain)), -kDeepest, kDeepest) + kDeepest);
}

void DepthClasses::add(float plain, float textured) {
    const Kind kind = textured <= -1 ? Kind::Full : textured >= 1 ? Kind::Empty : Kind::Mixed;
    Kind& of = mKind[index(plain)];
    of = of == Kind::Unseen || of == kind ? kind : Kind::Mixed;
}

std::vector<DepthRun> DepthClasses::runs() const {
    std::vector<DepthRun> runs;
    for (std::size_t i = 0; i < mKind.size(); ++i) {
        const int depth = int(i) - kDeepest;
        const bool full = mKind[i] == Kind::Full || (mKind[i] != Kind::Empty && depth < 0);
        if (runs.empty() || runs.back().full != full) runs.push_back({depth, full});
    }
    return runs;
}

void DepthClasses::finish() {
    const auto seen = [](Kind kind) { return kind != Kind::Unseen; };
    const auto first = std::find_if(mKind.begin(), mKind.end(), seen);
    const auto last = std::find_if(mKind.rbegin(), mKind.rend(), seen);
    if (first != mKind.end()) {
        std::fill(mKind.begin(), first, *first);
        std::fill(last.base(), mKind.end(), *last);
        for (auto kind = mKind.begin() + 1; kind != mKind.end(); ++kind)
            if (*kind == Kind::Unseen) *kind = *(kind - 1);
    }
    mOpen.assign(mKind.size(), 0);
    for (std::size_t i = 0; i < mKind.size(); ++i)
        for (int k = -mRadius; k <= mRadius; ++k) {
            const std::size_t j = std::size_t(
                std::clamp<std::ptrdiff_t>(std::ptrdiff_t(i) + k, 0, std::ptrdiff_t(mKind.size()) - 1));
            if (mKind[j] != mKind[i] || mKind[j] == Kind::Mixed) mOpen[i] = 1;
        }
}

}  // namespace vdbsynth
