#include "libvdbsynth/analogy/filter_analogy.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/least_squares.h"
#include "libvdbsynth/math/pca.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/search/feature_index.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace vdbsynth {
namespace {

constexpr std::size_t kMostFitted = 60000;    // rows used to fit maps and axes
constexpr std::size_t kMostIndexed = 250000;  // rows that are searched
constexpr std::size_t kLeast = 1000;          // rows needed for training
constexpr std::size_t kUniform = 64;          // one of so many constant rows is kept
constexpr int kHeldBlock = 4;                 // log2 of the side of held-out blocks
constexpr double kWorth = 0.98;  // a search is used if its error is below this share of the affine map's
constexpr float kAnyDistance = 1e30f;

// Smoothing of a level: a Gaussian of half the distance of its samples, cut off at three sigma.
float sigmaOf(int level) {
    return float(1 << (level - 1));
}
int radiusOf(int level) {
    return int(std::ceil(3 * sigmaOf(level)));
}

std::vector<float> gaussian(int level) {
    const int radius = radiusOf(level);
    std::vector<float> weights;
    float sum = 0;
    for (int k = -radius; k <= radius; ++k) {
        weights.push_back(
            float(exponential(-double(k * k) / (2 * double(sigmaOf(level)) * double(sigmaOf(level))))));
        sum += weights.back();
    }
    for (float& weight : weights) weight /= sum;
    return weights;
}

// Sums along the slowest axis of [n + 2 radius, rest] samples; the axis becomes the fastest, so that three
// calls smooth all axes.
void smoothAxis(std::vector<float>& samples, int from, int to, const std::vector<float>& weights) {
    const std::size_t rest = samples.size() / std::size_t(from);
    std::vector<float> out(std::size_t(to) * rest);
    for (std::size_t r = 0; r < rest; ++r)
        for (int k = 0; k < to; ++k) {
            float sum = 0;
            for (std::size_t w = 0; w < weights.size(); ++w)
                sum += weights[w] * samples[(std::size_t(k) + w) * rest + r];
            out[r * std::size_t(to) + std::size_t(k)] = sum;
        }
    samples.swap(out);
}

BrickField smoothed(const BrickField& field, int level, const RunContext& ctx) {
    const std::vector<float> weights = gaussian(level);
    const int radius = radiusOf(level), side = BrickField::kSide + 2 * radius;
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        const Index3 corner = brick.min - Index3{radius, radius, radius};
        float value = 0;
        if (field.constantIn(IndexBox::cube(corner, side), value)) {
            std::fill(samples, samples + BrickField::kSamples, value);
            return;
        }
        std::vector<float> wide(latticeCount({side, side, side}));
        field.readBox(corner, {side, side, side}, wide.data());
        for (int axis = 0; axis < 3; ++axis) smoothAxis(wide, side, BrickField::kSide, weights);
        std::copy(wide.begin(), wide.end(), samples);
    });
}

// Neighbourhoods of one field.
class Neighbourhoods {
public:
    Neighbourhoods(const BrickField& field, const FilterAnalogyOptions& options, const RunContext& ctx)
        : mOptions(options), mField(&field) {
        for (int level = 1; level < options.levels; ++level) mSmooth.push_back(smoothed(field, level, ctx));
    }

    static std::size_t length(const FilterAnalogyOptions& options) {
        const int side = 2 * options.half + 1;
        return std::size_t(side * side * side + 27 * (options.levels - 1));
    }

    /// False, with the value, if the whole neighbourhood of a box has one value.
    bool varies(const IndexBox& box, float& value) const {
        const int reach = filterReach(mOptions);
        const Index3 by{reach, reach, reach};
        return !mField->constantIn({box.min - by, box.max + by}, value);
    }

    /// All neighbourhoods of a brick. @param out [512 x length]
    void read(const IndexBox& brick, float* out) const {
        std::size_t at = 0;
        const std::size_t size = length(mOptions);
        at = readLevel(*mField, brick, mOptions.half, 1, out, at, size);
        for (std::size_t l = 0; l < mSmooth.size(); ++l)
            at = readLevel(mSmooth[l], brick, 1, 2 << l, out, at, size);
    }

private:
    static std::size_t readLevel(const BrickField& field, const IndexBox& brick, int half, int step,
                                 float* out, std::size_t at, std::size_t size) {
        const int reach = half * step, side = BrickField::kSide + 2 * reach, count = 2 * half + 1;
        std::vector<float> wide(latticeCount({side, side, side}));
        field.readBox(brick.min - Index3{reach, reach, reach}, {side, side, side}, wide.data());
        for (int i = 0; i < BrickField::kSamples; ++i) {
            float* to = out + std::size_t(i) * size + at;
            const float* from = wide.data() + ((i >> 6) * side + ((i >> 3) & 7)) * side + (i & 7);
            forEachVoxel(IndexBox::cube({0, 0, 0}, count),
                         [&](const Index3& p) { *to++ = from[((p.x * side + p.y) * side + p.z) * step]; });
        }
        return at + std::size_t(count * count * count);
    }

    FilterAnalogyOptions mOptions;
    const BrickField* mField;
    std::vector<BrickField> mSmooth;
};

std::vector<IndexBox> bricksOf(const IndexBox& box) {
    std::vector<IndexBox> bricks;
    const auto add = [&](const Index3& p) { bricks.push_back(IndexBox::cube(p, BrickField::kSide)); };
    forEachVoxel(box, add, BrickField::kSide);
    return bricks;
}

// Rows of the pairs: neighbourhoods before, values before and after.
struct Rows {
    std::vector<float> vectors, before, after;
    std::vector<char> held;
    std::size_t seen = 0;

    Rows only(std::size_t length, char part) const {
        Rows rows;
        for (std::size_t r = 0; r < after.size(); ++r) {
            if (held[r] != part) continue;
            const auto at = vectors.begin() + std::ptrdiff_t(r * length);
            rows.vectors.insert(rows.vectors.end(), at, at + std::ptrdiff_t(length));
            rows.before.push_back(before[r]);
            rows.after.push_back(after[r]);
        }
        return rows;
    }
};

// Every n-th voxel of the bricks that vary, at most `most`.
class Gathering {
public:
    Gathering(const std::vector<FilterPair>& pairs, const FilterAnalogyOptions& options,
              const RunContext& ctx)
        : mOptions(options), mContext(ctx) {
        for (const FilterPair& pair : pairs) {
            const Neighbourhoods before(*pair.before, options, ctx);
            for (const IndexBox& brick : bricksOf(pair.before->box())) {
                float value;
                if (before.varies(brick, value)) mBricks.push_back({mFields.size(), brick});
            }
            mFields.push_back(before);
            mPairs.push_back(pair);
        }
    }

    Rows rows(std::size_t most) const {
        const std::size_t length = Neighbourhoods::length(mOptions);
        const std::size_t all = mBricks.size() * std::size_t(BrickField::kSamples);
        // An odd step, so that positions within bricks differ.
        const std::size_t step = all <= most ? 1 : (all / most + 1) | 1;
        std::vector<Rows> parts(mBricks.size());
        parallelFor(mContext, mBricks.size(), 4, [&](std::size_t first, std::size_t last) {
            std::vector<float> vectors(std::size_t(BrickField::kSamples) * length);
            for (std::size_t b = first; b < last; ++b) {
                mFields[mBricks[b].pair].read(mBricks[b].box, vectors.data());
                take(b, step, vectors, parts[b]);
            }
        });
        Rows rows;
        rows.seen = all;
        for (const Rows& part : parts) {
            rows.vectors.insert(rows.vectors.end(), part.vectors.begin(), part.vectors.end());
            rows.before.insert(rows.before.end(), part.before.begin(), part.before.end());
            rows.after.insert(rows.after.end(), part.after.begin(), part.after.end());
            rows.held.insert(rows.held.end(), part.held.begin(), part.held.end());
        }
        return rows;
    }

private:
    struct Brick {
        std::size_t pair;
        IndexBox box;
    };

    void take(std::size_t b, std::size_t step, const std::vector<float>& vectors, Rows& rows) const {
        const std::size_t length = Neighbourhoods::length(mOptions), first = b * std::size_t(512);
        for (std::size_t i = (step - first % step) % step; i < std::size_t(512); i += step) {
            const Index3 p = mBricks[b].box.min + Index3{int(i >> 6), int(i >> 3) & 7, int(i) & 7};
            const FilterPair& pair = mPairs[mBricks[b].pair];
            if (!pair.before->box().contains(p)) continue;
            const auto at = vectors.begin() + std::ptrdiff_t(i * length);
            // Empty and full neighbourhoods are many and all equal; a search among them is a linear scan.
            const bool alike =
                std::all_of(at, at + std::ptrdiff_t(length), [&](float v) { return v == *at; });
            if (alike && i / step % kUniform != 0) continue;
            rows.vectors.insert(rows.vectors.end(), at, at + std::ptrdiff_t(length));
            rows.before.push_back(pair.before->inside(p));
            rows.after.push_back(pair.after->at(p));
            const int block = (p.x >> kHeldBlock) + (p.y >> kHeldBlock) + (p.z >> kHeldBlock);
            rows.held.push_back(char((block & 3) == 0));
        }
    }

    FilterAnalogyOptions mOptions;
    const RunContext& mContext;
    std::vector<Neighbourhoods> mFields;
    std::vector<FilterPair> mPairs;
    std::vector<Brick> mBricks;
};

// The affine map's residual at each row, found by the nearest row.
class Rests {
public:
    Rests(const Rows& rows, std::size_t length, const AffineMap& map, const FilterAnalogyOptions& options,
          const RunContext& ctx) {
        std::vector<float> some;
        const std::size_t step = rows.after.size() / 6000 + 1;
        for (std::size_t r = 0; r < rows.after.size(); r += step)
            some.insert(some.end(), rows.vectors.begin() + std::ptrdiff_t(r * length),
                        rows.vectors.begin() + std::ptrdiff_t((r + 1) * length));
        mAxes = principalAxes(some, length, std::size_t(options.components), 0.9999);
        mRest.resize(rows.after.size());
        std::vector<float> features(rows.after.size() * mAxes.count);
        parallelFor(ctx, rows.after.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t r = begin; r < end; ++r) {
                const float* vector = rows.vectors.data() + r * length;
                mAxes.project(vector, features.data() + r * mAxes.count);
                mRest[r] = rows.after[r] - map(vector);
            }
        });
        mIndex.emplace(std::move(features), mAxes.count);
    }

    float at(const float* vector, std::vector<float>& feature) const {
        feature.resize(mAxes.count);
        mAxes.project(vector, feature.data());
        return mRest[std::size_t(mIndex->nearest(feature.data(), kAnyDistance).row)];
    }

private:
    PrincipalAxes mAxes;
    std::vector<float> mRest;
    std::optional<FeatureIndex> mIndex;
};

double rootMeanSquare(const std::vector<float>& values) {
    double sum = 0;
    for (float value : values) sum += double(value) * double(value);
    return std::sqrt(sum / double(std::max<std::size_t>(values.size(), 1)));
}

// The errors of both methods on held-out rows.
void holdOut(const Rows& rows, std::size_t length, const FilterAnalogyOptions& options,
             FilterAnalogyStats& stats, const RunContext& ctx) {
    const Rows seen = rows.only(length, 0), held = rows.only(length, 1);
    if (seen.after.size() < kLeast || held.after.size() < kLeast / 4) return;
    const AffineMap map = fitAffine(seen.vectors, length, seen.after);
    const Rests rests(seen, length, map, options, ctx);
    const std::size_t count = held.after.size();
    std::vector<float> change(count), affine(count), searched(count);
    parallelFor(ctx, count, 64, [&](std::size_t begin, std::size_t end) {
        std::vector<float> feature;
        for (std::size_t r = begin; r < end; ++r) {
            const float* vector = held.vectors.data() + r * length;
            change[r] = held.after[r] - held.before[r];
            affine[r] = held.after[r] - map(vector);
            searched[r] = affine[r] - rests.at(vector, feature);
        }
    });
    stats.change = rootMeanSquare(change);
    stats.affineError = rootMeanSquare(affine);
    stats.searchError = rootMeanSquare(searched);
    stats.searched = stats.searchError < kWorth * stats.affineError;
}

BrickField filtered(const BrickField& target, const Neighbourhoods& around, const AffineMap& map,
                    const std::optional<Rests>& rests, std::size_t length, const RunContext& ctx) {
    constexpr std::size_t kPart = 128;  // bricks between reports
    const std::vector<IndexBox> bricks = bricksOf(target.box());
    BrickField after(target.box(), target.at(target.box().min));
    Stage stage(ctx, "filter", bricks.size());
    std::vector<float> values(kPart * BrickField::kSamples);
    for (std::size_t first = 0; first < bricks.size(); first += kPart) {
        const std::size_t count = std::min(kPart, bricks.size() - first);
        parallelFor(ctx, count, 2, [&](std::size_t begin, std::size_t end) {
            std::vector<float> vectors(std::size_t(BrickField::kSamples) * length), feature;
            for (std::size_t b = begin; b < end; ++b) {
                float* out = values.data() + b * BrickField::kSamples;
                float value = 0;
                const bool varies = around.varies(bricks[first + b], value);
                if (varies)
                    around.read(bricks[first + b], vectors.data());
                else
                    std::fill(vectors.begin(), vectors.begin() + std::ptrdiff_t(length), value);
                for (int i = 0; i < (varies ? BrickField::kSamples : 1); ++i) {
                    const float* vector = vectors.data() + std::size_t(i) * length;
                    out[i] = map(vector) + (rests ? rests->at(vector, feature) : 0);
                }
                if (!varies) std::fill(out + 1, out + BrickField::kSamples, out[0]);
            }
        });
        for (std::size_t b = 0; b < count; ++b)
            after.writeBox(bricks[first + b].min, {8, 8, 8}, values.data() + b * BrickField::kSamples);
        stage.advance(count);
    }
    return after;
}

// Boxes may begin anywhere.
void requirePairs(const std::vector<FilterPair>& pairs, const BrickField& target) {
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (const FilterPair& pair : pairs) {
        if (!pair.before || !pair.after)
            throw Error(ErrorCode::InvalidOption, "`before`, `after`: a field of a pair is null");
        if (!(pair.before->box() == pair.after->box()))
            throw Error(ErrorCode::ShapeMismatch,
                        "`before`, `after`: the fields of a pair have different boxes");
        if (!pair.before->finite() || !pair.after->finite())
            throw Error(ErrorCode::BadData, "`before`, `after`: a pair holds NaN or infinite values");
    }
    if (!target.finite()) throw Error(ErrorCode::BadData, "the target holds NaN or infinite values");
}

}  // namespace

void validate(const FilterAnalogyOptions& options) {
    const auto whole = [](int value, int low, int high, const char* name) {
        requireOption(value >= low && value <= high, name, std::to_string(value),
                      "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    };
    whole(options.half, 1, 4, "half");
    whole(options.levels, 1, 4, "levels");
    whole(options.components, 4, 256, "components");
}

int filterReach(const FilterAnalogyOptions& options) {
    const int last = options.levels - 1;
    return std::max(options.half, last == 0 ? 0 : (1 << last) + radiusOf(last));
}

FilterAnalogyResult makeFilterAnalogy(const std::vector<FilterPair>& pairs, const BrickField& target,
                                      const FilterAnalogyOptions& options, const RunContext& ctx) {
    validate(options);
    requirePairs(pairs, target);
    const std::size_t length = Neighbourhoods::length(options);
    FilterAnalogyResult result;
    const Gathering gathering(pairs, options, ctx);
    Rows rows = gathering.rows(kMostFitted);
    if (rows.after.size() < kLeast)
        throw Error(ErrorCode::Unusable, "the pair has " + std::to_string(rows.after.size()) +
                                             " voxels that differ from their neighbours; at least " +
                                             std::to_string(kLeast) + " are needed for training");
    holdOut(rows, length, options, result.stats, ctx);
    const AffineMap map = fitAffine(rows.vectors, length, rows.after);
    std::optional<Rests> rests;
    if (result.stats.searched) {
        rows = gathering.rows(kMostIndexed);
        rests.emplace(rows, length, map, options, ctx);
    }
    result.stats.rows = rows.after.size();
    const Neighbourhoods around(target, options, ctx);
    result.after = filtered(target, around, map, rests, length, ctx);
    return result;
}

}  // namespace vdbsynth
