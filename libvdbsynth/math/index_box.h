#pragma once
#include <algorithm>
#include <cstdint>

namespace vdbsynth {

/// A voxel's integer coordinates. Ordered by x, then y, then z.
struct Index3 {
    int x = 0, y = 0, z = 0;

    int& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    const int& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    friend bool operator==(const Index3& a, const Index3& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
    friend bool operator!=(const Index3& a, const Index3& b) { return !(a == b); }
    friend bool operator<(const Index3& a, const Index3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    }
    friend Index3 operator+(const Index3& a, const Index3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Index3 operator-(const Index3& a, const Index3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Index3 operator*(const Index3& a, int s) { return {a.x * s, a.y * s, a.z * s}; }
};

/// A box of voxels, both corners inclusive. Empty when any side is under 1.
struct IndexBox {
    Index3 min{0, 0, 0};
    Index3 max{-1, -1, -1};

    Index3 size() const { return {max.x - min.x + 1, max.y - min.y + 1, max.z - min.z + 1}; }
    bool empty() const { return max.x < min.x || max.y < min.y || max.z < min.z; }
    std::int64_t volume() const {
        if (empty()) return 0;
        // Saturates: sides up to 2^29 are legal.
        const double exact = double(size().x) * size().y * size().z;
        return exact < 9e18 ? std::int64_t(size().x) * size().y * size().z : std::int64_t(9e18);
    }
    bool contains(const Index3& p) const {
        return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
    }
    bool contains(const IndexBox& o) const { return contains(o.min) && contains(o.max); }
    IndexBox intersection(const IndexBox& o) const {
        return {{std::max(min.x, o.min.x), std::max(min.y, o.min.y), std::max(min.z, o.min.z)},
                {std::min(max.x, o.max.x), std::min(max.y, o.max.y), std::min(max.z, o.max.z)}};
    }
    IndexBox expanded(int by) const {
        return {{min.x - by, min.y - by, min.z - by}, {max.x + by, max.y + by, max.z + by}};
    }
    friend bool operator==(const IndexBox& a, const IndexBox& b) { return a.min == b.min && a.max == b.max; }

    static IndexBox fromSize(const Index3& size) { return {{0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}}; }
    static IndexBox cube(const Index3& corner, int side) {
        return {corner, {corner.x + side - 1, corner.y + side - 1, corner.z + side - 1}};
    }
};

}  // namespace vdbsynth
