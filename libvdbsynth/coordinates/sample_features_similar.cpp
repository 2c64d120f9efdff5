#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/sample_features.h"
#include "libvdbsynth/search/feature_index.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr std::size_t kSearched = 16384;  // nodes whose similar nodes are searched
constexpr double kApart = 0.05;           // share of the sample's side between similar nodes
constexpr float kInexact = 1;             // epsilon of the search

// Distance between two nodes along the longer axis, around the border where the sample is tileable. [nodes]
int apart(const SampleLevel& level, std::int32_t a, std::int32_t b) {
    int dx = std::abs(a % level.width - b % level.width), dy = std::abs(a / level.width - b / level.width);
    if (level.tileable) {
        dx = std::min(dx, level.width - dx);
        dy = std::min(dy, level.height - dy);
    }
    return std::max(dx, dy);
}

// Finds the similar nodes of every `sparse`-th node along both axes; the others take theirs from the nearest
// of these, moved along.
class SimilarNodes {
public:
    SimilarNodes(SampleLevel& level, std::size_t count) : mLevel(level), mCount(count) {
        std::size_t nodes = std::size_t(level.width) * std::size_t(level.height);
        while (nodes / std::size_t(mSparse * mSparse) > kSearched) ++mSparse;
        const int longer = std::max(level.width, level.height);
        mApart = std::max(int(kApart * double(longer)), 1 + int(level.step / double(level.stride)));
    }

    void find(const RunContext& ctx) {
        level().similar.assign(std::size_t(mLevel.width) * std::size_t(mLevel.height) * mCount, -1);
        std::vector<std::int32_t> nodes = sources();
        if (nodes.size() < 2) return;
        std::vector<float> rows;
        for (std::int32_t node : nodes)
            rows.insert(rows.end(), mLevel.feature.data() + std::size_t(node) * kFeature,
                        mLevel.feature.data() + std::size_t(node + 1) * kFeature);
        const FeatureIndex index(std::move(rows), kFeature);
        Stage stage(ctx, "similar texels", nodes.size());
        parallelFor(ctx, nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) findOne(index, nodes, std::int32_t(i));
        });
        spreadToAll(ctx);
    }

private:
    SampleLevel& level() { return mLevel; }
    std::int32_t* slot(std::int32_t node) { return mLevel.similar.data() + std::size_t(node) * mCount; }

    std::vector<std::int32_t> sources() const {
        std::vector<std::int32_t> nodes;
        for (int y = mLevel.margin; y < mLevel.height - mLevel.margin; y += mSparse)
            for (int x = mLevel.margin; x < mLevel.width - mLevel.margin; x += mSparse) {
                const std::int32_t node = std::int32_t(y) * mLevel.width + x;
                if (mLevel.usable.empty() || mLevel.usable[std::size_t(node)]) nodes.push_back(node);
            }
        return nodes;
    }

    void findOne(const FeatureIndex& index, const std::vector<std::int32_t>& nodes, std::int32_t i) {
        const std::int32_t own = nodes[std::size_t(i)];
        const auto far = [&](std::int32_t row) {
            return apart(mLevel, own, nodes[std::size_t(row)]) >= mApart;
        };
        // Several times too many, of which those far from each other are kept.
        const std::vector<FeatureMatch> matches = index.nearestSome(index.row(i), 4 * mCount, far, kInexact);
        std::size_t found = 0;
        for (const FeatureMatch& match : matches) {
            const std::int32_t node = nodes[std::size_t(match.row)];
            bool fresh = true;
            for (std::size_t k = 0; k < found; ++k) fresh &= apart(mLevel, slot(own)[k], node) >= mApart;
            if (fresh) slot(own)[found++] = node;
            if (found == mCount) break;
        }
    }

    void spreadToAll(const RunContext& ctx) {
        if (mSparse == 1) return;
        parallelFor(ctx, std::size_t(mLevel.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < mLevel.width; ++x) spreadTo(x, y);
        });
    }

    // The searched node that shares a node's cell, along one axis.
    int searchedBefore(int at, int size) const {
        const int last = std::max(mLevel.margin, size - mLevel.margin - 1);
        const int inside = std::clamp(at, mLevel.margin, last);
        return mLevel.margin + (inside - mLevel.margin) / mSparse * mSparse;
    }

    void spreadTo(int x, int y) {
        const int fromX = searchedBefore(x, mLevel.width), fromY = searchedBefore(y, mLevel.height);
        if (fromX == x && fromY == y) return;
        const std::int32_t from = std::int32_t(fromY) * mLevel.width + fromX;
        const std::int32_t own = std::int32_t(y) * mLevel.width + x;
        for (std::size_t k = 0; k < mCount; ++k) {
            const std::int32_t like = slot(from)[k];
            if (like < 0) continue;
            const int toX = like % mLevel.width + x - fromX, toY = like / mLevel.width + y - fromY;
            if (toX < 0 || toY < 0 || toX >= mLevel.width || toY >= mLevel.height) continue;
            slot(own)[k] = std::int32_t(toY) * mLevel.width + toX;
        }
    }

    SampleLevel& mLevel;
    std::size_t mCount;
    int mSparse = 1, mApart = 1;
};

}  // namespace

void findSimilarNodes(SampleLevel& level, std::size_t count, const RunContext& ctx) {
    level.similarCount = count;
    SimilarNodes(level, count).find(ctx);
}

}  // namespace vdbsynth
