#include "libvdbsynth/patch/scanline/scanline_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

template <typename Visit>
void PointBuckets::eachKey(const PlaneBox& box, const Visit& visit) const {
    const auto at = [&](double x) { return int(std::floor(x / mSide)); };
    for (int j = at(box.y0); j <= at(box.y1); ++j)
        for (int i = at(box.x0); i <= at(box.x1); ++i) visit(keyOf(i, j));
}

std::vector<ScanlinePoint> PointBuckets::gathered(const PlaneBox& box) const {
    std::vector<ScanlinePoint> points;
    eachKey(box, [&](std::uint64_t key) {
        if (const auto bucket = mBuckets.find(key); bucket != mBuckets.end())
            for (const ScanlinePoint& point : bucket->second)
                if (box.holds(point.point)) points.push_back(point);
    });
    return points;
}

void PointBuckets::removeInside(const PlaneBox& box) {
    eachKey(box, [&](std::uint64_t key) {
        const auto bucket = mBuckets.find(key);
        if (bucket == mBuckets.end()) return;
        auto& points = bucket->second;
        points.erase(std::remove_if(points.begin(), points.end(),
                                    [&](const ScanlinePoint& point) { return box.holds(point.point); }),
                     points.end());
    });
}

void PointBuckets::insert(const ScanlinePoint& point) {
    const auto at = [&](float x) { return int(std::floor(double(x) / mSide)); };
    mBuckets[keyOf(at(point.point.x), at(point.point.y))].push_back(point);
}

std::vector<ScanlinePoint> PointBuckets::all() const {
    std::vector<std::pair<std::int32_t, std::int32_t>> keys;
    for (const auto& bucket : mBuckets)
        keys.emplace_back(std::int32_t(std::uint32_t(bucket.first)), std::int32_t(bucket.first >> 32));
    std::sort(keys.begin(), keys.end());
    std::vector<ScanlinePoint> points;
    for (const auto& key : keys) {
        const auto& bucket = mBuckets.at(keyOf(key.second, key.first));
        points.insert(points.end(), bucket.begin(), bucket.end());
    }
    return points;
}

double ScanlinePatch::kept(const Vec3f& place) const {
    const auto fade = [&](double from) {
        const double t = std::clamp(1 - from / margin, 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    return std::max(left ? fade(double(place.x) - x) : 0, below ? fade(double(place.y) - y) : 0);
}

}  // namespace vdbsynth
