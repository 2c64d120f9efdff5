#include "libvdbsynth/analogy/source_usage.h"

#include <algorithm>
#include <utility>

namespace vdbsynth {
namespace {

constexpr float kWeight = 2;
constexpr int kPartBits = 2;  // parts of 4 voxels a side

std::uint64_t keyOf(const SourceUsage::Row& row) {
    std::uint64_t key = std::uint64_t(std::uint32_t(row.exemplar));
    for (int axis = 0; axis < 3; ++axis) key = key << 16 | std::uint64_t(row.voxel[axis] >> kPartBits);
    return key;
}

}  // namespace

SourceUsage::SourceUsage(const std::vector<Row>& rows, std::size_t targets) : mPart(rows.size()) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) keys[r] = {keyOf(rows[r]), std::uint32_t(r)};
    std::sort(keys.begin(), keys.end());
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (k == 0 || keys[k].first != keys[k - 1].first) mShare.push_back(0);
        mPart[keys[k].second] = std::int32_t(mShare.size()) - 1;
        mShare.back() += 1;
    }
    for (float& share : mShare) share *= float(targets) / float(rows.size());
    mUsed.assign(mShare.size(), 0);
}

float SourceUsage::cost(std::int32_t row) const {
    const std::size_t part = std::size_t(mPart[std::size_t(row)]);
    return mShare[part] > 0 ? 1 + kWeight * std::max(0.f, mUsed[part] / mShare[part] - 1) : 1;
}

void SourceUsage::change(std::int32_t from, std::int32_t to) {
    if (from >= 0) mUsed[std::size_t(mPart[std::size_t(from)])] -= 1;
    if (to >= 0) mUsed[std::size_t(mPart[std::size_t(to)])] += 1;
}

}  // namespace vdbsynth
