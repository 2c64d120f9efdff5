#include "libvdbsynth/synth/guidance.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/grid/pyramid.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// The variance of all exemplars' samples.
double varianceOf(const std::vector<const BrickField*>& guides) {
    double sum = 0, squares = 0, count = 0;
    for (const BrickField* guide : guides) {
        const IndexBox box = guide->box();
        std::vector<float> row(std::size_t(box.size().z));
        for (int x = box.min.x; x <= box.max.x; ++x)
            for (int y = box.min.y; y <= box.max.y; ++y) {
                guide->readBox({x, y, box.min.z}, {1, 1, int(row.size())}, row.data());
                for (float value : row) {
                    sum += double(value);
                    squares += double(value) * double(value);
                }
            }
        count += double(box.volume());
    }
    const double mean = sum / count;
    return squares / count - mean * mean;
}

}  // namespace

Guidance::Guidance(const BrickField& target, const std::vector<BrickField>& exemplars, float weight,
                   int block, const RunContext& ctx)
    : mWeight(weight / 8), mStep(block - block / 2) {
    mTarget = slidingMean(target, block / 2, ctx);
    for (const BrickField& exemplar : exemplars)
        mExemplars.push_back(denseField(slidingMean(exemplar, block / 2, ctx)));
}

float Guidance::cost(const Index3& origin, std::size_t exemplar, const Index3& place) const {
    float sum = 0;
    for (int octant = 0; octant < 8; ++octant) {
        const Index3 step = Index3{octant & 1 ? mStep : 0, octant & 2 ? mStep : 0, octant & 4 ? mStep : 0};
        const float difference = mTarget.inside(origin + step) - mExemplars[exemplar].at(place + step);
        sum += difference * difference;
    }
    return sum * mWeight;
}

GuideScales guideScales(const BlockSynthesisOptions& options, std::size_t passes, const RunContext& ctx) {
    GuideScales scales;
    if (!options.guide) return scales;
    const double variance = varianceOf(options.exemplarGuides);
    if (!(variance > 1e-20) || !std::isfinite(variance))
        throw Error(ErrorCode::Unusable,
                    "`exemplarGuides`: is constant over the exemplar, or holds NaN or infinite values; give "
                    "a grid that varies");
    scales.weight = float(double(options.guideWeight) / variance);
    scales.target.push_back(*options.guide);
    scales.exemplars.emplace_back();
    for (const BrickField* guide : options.exemplarGuides) scales.exemplars.back().push_back(*guide);
    while (scales.target.size() < passes) {
        scales.target.push_back(halved(scales.target.back(), ctx));
        std::vector<BrickField> coarse;
        for (const BrickField& guide : scales.exemplars.back()) coarse.push_back(halved(guide, ctx));
        scales.exemplars.push_back(std::move(coarse));
    }
    return scales;
}

}  // namespace vdbsynth
