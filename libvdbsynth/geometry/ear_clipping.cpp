#include "libvdbsynth/geometry/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kGone = 0xffffffff;
constexpr std::size_t kLeafCorners = 8;
// Flipped area, of all, that rounding to the grid may cause.
constexpr double kFlippedShare = 1e-6;

// Of a corner without area: not between its neighbours, but beyond one of them or upon it.
bool isSpike(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) >= 0;
}

// False if the triangle, which runs counter-clockwise, surely has no point in the box.
bool mayMeet(const PlanePoint (&t)[3], const PlanePoint& low, const PlanePoint& high) {
    if (std::max({t[0].x, t[1].x, t[2].x}) < low.x || std::min({t[0].x, t[1].x, t[2].x}) > high.x)
        return false;
    if (std::max({t[0].y, t[1].y, t[2].y}) < low.y || std::min({t[0].y, t[1].y, t[2].y}) > high.y)
        return false;
    for (int i = 0; i < 3; ++i) {
        const PlanePoint &a = t[i], &b = t[(i + 1) % 3];
        const PlanePoint innermost{b.y > a.y ? low.x : high.x, b.x > a.x ? high.y : low.y};
        if (doubleArea(a, b, innermost) < 0) return false;
    }
    return true;
}

}  // namespace

bool EarClipper::triangulate(const std::vector<PlanePoint>& ring, std::vector<Triangle>& triangles) {
    triangles.clear();
    if (ring.size() < 3) return true;
    start(ring);
    double covered = 0, signedArea = 0;
    const auto emit = [&](std::uint32_t corner) {
        const Triangle t{mPrevious[corner], corner, mNext[corner]};
        const double area = double(doubleArea(ring[t[0]], ring[t[1]], ring[t[2]]));
        covered += std::abs(area);
        signedArea += area;
        triangles.push_back(t);
    };
    while (mLeft > 3) {
        const std::uint32_t corner = nextEar();
        emit(corner);
        unlink(corner);
    }
    emit(mFirst);
    return mSimple && covered - signedArea <= kFlippedShare * covered;
}

void EarClipper::start(const std::vector<PlanePoint>& ring) {
    const std::size_t n = ring.size();
    mRing = ring.data();
    mLeft = n;
    mFirst = 0;
    mNext.resize(n);
    mPrevious.resize(n);
    mEntry.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        mNext[i] = std::uint32_t(i + 1 == n ? 0 : i + 1);
        mPrevious[i] = std::uint32_t(i == 0 ? n - 1 : i - 1);
    }
    mLeaves = 1;
    while (mLeaves * kLeafCorners < n) mLeaves *= 2;
    mBoxes.resize(2 * mLeaves);
    mSorted.resize(n);
    std::iota(mSorted.begin(), mSorted.end(), 0u);
    mLeafOf.resize(n);
    buildBox(1, 0, mLeaves);
    mQueue.clear();
    mSpikes.clear();
    mHead = 0;
    for (std::size_t i = 0; i < n; ++i) enqueue(std::uint32_t(i));
    mSimple = true;
    mWork = 0;
    // Twice what a fine comb needs; the rest is for hostile files.
    mMostWork = std::min(4e9, double(n) * (1000 + 16 * std::sqrt(double(n))));
    mSecondLooks = 0;
}

void EarClipper::buildBox(std::size_t box, std::size_t firstLeaf, std::size_t leaves) {
    const auto begin = mSorted.begin() + std::ptrdiff_t(leafBegin(firstLeaf));
    const auto end = mSorted.begin() + std::ptrdiff_t(leafBegin(firstLeaf + leaves));
    Box& own = mBoxes[box];
    own.low = {kPlaneMost, kPlaneMost};
    own.high = {0, 0};
    own.left = std::uint32_t(end - begin);
    for (auto corner = begin; corner != end; ++corner) {
        const PlanePoint& p = mRing[*corner];
        own.low = {std::min(own.low.x, p.x), std::min(own.low.y, p.y)};
        own.high = {std::max(own.high.x, p.x), std::max(own.high.y, p.y)};
        if (leaves == 1) mLeafOf[*corner] = std::uint32_t(firstLeaf);
    }
    if (leaves == 1) return;
    const bool wide = own.high.x - own.low.x >= own.high.y - own.low.y;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const std::int64_t one = wide ? mRing[a].x : mRing[a].y, other = wide ? mRing[b].x : mRing[b].y;
        return one != other ? one < other : a < b;
    };
    std::nth_element(begin, mSorted.begin() + std::ptrdiff_t(leafBegin(firstLeaf + leaves / 2)), end, before);
    buildBox(2 * box, firstLeaf, leaves / 2);
    buildBox(2 * box + 1, firstLeaf + leaves / 2, leaves / 2);
}

bool EarClipper::isSpikeAt(std::uint32_t corner) const {
    const PlanePoint &a = mRing[mPrevious[corner]], &b = mRing[corner], &c = mRing[mNext[corner]];
    return doubleArea(a, b, c) == 0 && isSpike(a, b, c);
}

// A corner that waits already moves to the end: corners are cut all around the ring in turn, which makes
// better triangles than a fan. Spikes cannot wait: where parts of the ring touch, they hide what is inside.
void EarClipper::enqueue(std::uint32_t corner) {
    if (isSpikeAt(corner)) mSpikes.push_back(corner);
    mEntry[corner] = mQueue.size();
    mQueue.push_back(corner);
}

std::uint32_t EarClipper::nextEar() {
    while (!mSpikes.empty()) {
        const std::uint32_t corner = mSpikes.back();
        mSpikes.pop_back();
        if (mNext[corner] != kGone && isSpikeAt(corner)) return corner;
    }
    while (mHead < mQueue.size() && mWork <= mMostWork) {
        const std::size_t place = mHead++;
        const std::uint32_t corner = mQueue[place];
        if (mEntry[corner] == place && mNext[corner] != kGone && isEar(corner, Rule::Strict)) return corner;
    }
    // In a simple ring only the neighbours of a cut corner can become ears; others need a second look, and
    // those that cross themselves give in somewhere.
    const std::size_t mostLooks = 1000 + 16 * mNext.size();
    for (Rule rule : {Rule::Strict, Rule::DiagonalMayTouch, Rule::FlatToo, Rule::Convex}) {
        std::uint32_t corner = mFirst;
        for (std::size_t i = 0; i < mLeft && mSecondLooks < mostLooks; ++i, corner = mNext[corner]) {
            ++mSecondLooks;
            if (!isEar(corner, rule)) continue;
            mSimple = mSimple && rule != Rule::Convex;
            return corner;
        }
    }
    mSimple = false;
    return mNext[mFirst];
}

bool EarClipper::isEar(std::uint32_t corner, Rule rule) {
    ++mWork;
    const std::uint32_t ear[3] = {mPrevious[corner], corner, mNext[corner]};
    const PlanePoint &a = mRing[ear[0]], &b = mRing[ear[1]], &c = mRing[ear[2]];
    const std::int64_t area = doubleArea(a, b, c);
    if (area == 0) return rule >= Rule::FlatToo;
    if (area < 0) return false;
    return rule >= Rule::Convex || !isBlocked(ear, rule);
}

bool EarClipper::isBlocked(const std::uint32_t (&ear)[3], Rule rule) {
    const PlanePoint triangle[3] = {mRing[ear[0]], mRing[ear[1]], mRing[ear[2]]};
    std::size_t open[64];
    std::size_t count = 0;
    open[count++] = 1;
    while (count > 0) {
        const std::size_t at = open[--count];
        const Box& box = mBoxes[at];
        ++mWork;
        if (box.left == 0 || !mayMeet(triangle, box.low, box.high)) continue;
        if (at < mLeaves) {
            open[count++] = 2 * at + 1;
            open[count++] = 2 * at;
            continue;
        }
        const std::size_t end = leafBegin(at - mLeaves + 1);
        for (std::size_t i = leafBegin(at - mLeaves); i < end; ++i)
            if (blocks(mSorted[i], ear, rule)) return true;
        mWork += double(kLeafCorners);
    }
    return false;
}

// Inside the ear's triangle; or on its border, with an edge that leads inside.
bool EarClipper::blocks(std::uint32_t corner, const std::uint32_t (&ear)[3], Rule rule) const {
    if (mNext[corner] == kGone || corner == ear[0] || corner == ear[1] || corner == ear[2]) return false;
    const PlanePoint &a = mRing[ear[0]], &b = mRing[ear[1]], &c = mRing[ear[2]], &p = mRing[corner];
    const std::int64_t ab = doubleArea(a, b, p), bc = doubleArea(b, c, p), ca = doubleArea(c, a, p);
    if (ab < 0 || bc < 0 || ca < 0) return false;
    if (ab > 0 && bc > 0 && (ca > 0 || rule == Rule::Strict)) return true;
    const auto leadsInside = [&](const PlanePoint& q) {
        return (ab > 0 || doubleArea(a, b, q) > 0) && (bc > 0 || doubleArea(b, c, q) > 0) &&
               (ca > 0 || doubleArea(c, a, q) > 0);
    };
    return leadsInside(mRing[mPrevious[corner]]) || leadsInside(mRing[mNext[corner]]);
}

void EarClipper::unlink(std::uint32_t corner) {
    const std::uint32_t before = mPrevious[corner], after = mNext[corner];
    mNext[before] = after;
    mPrevious[after] = before;
    mNext[corner] = mPrevious[corner] = kGone;
    for (std::size_t box = mLeaves + mLeafOf[corner]; box > 0; box /= 2) --mBoxes[box].left;
    --mLeft;
    mFirst = after;
    enqueue(before);
    enqueue(after);
}

}  // namespace vdbsynth
