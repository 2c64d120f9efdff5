#include "libvdbsynth/points/site_levels.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

struct InCell {
    Index3 cell;
    std::uint32_t number;
    bool operator<(const InCell& other) const {
        if (cell.x != other.cell.x) return cell.x < other.cell.x;
        if (cell.y != other.cell.y) return cell.y < other.cell.y;
        if (cell.z != other.cell.z) return cell.z < other.cell.z;
        return number < other.number;
    }
    bool sameCell(const InCell& other) const {
        return cell.x == other.cell.x && cell.y == other.cell.y && cell.z == other.cell.z;
    }
};

// A group of a cell's sites on one side of a wall.
struct Group {
    Vec3f facing;
    Vec3d point, normal;
    std::uint32_t members = 0;
};

void append(CoarserSites& coarser, const Group& group) {
    coarser.point.push_back(cast<float>(group.point * (1.0 / double(group.members))));
    const Vec3f normal = normalized(cast<float>(group.normal));
    coarser.normal.push_back(dot(normal, normal) > 0 ? normal : group.facing);
}

// Renumbers along a Morton curve.
void reorder(CoarserSites& coarser, const RunContext& ctx) {
    const std::vector<std::uint32_t> order = mortonOrder(coarser.point, ctx);
    CoarserSites sorted;
    std::vector<std::uint32_t> place(order.size());
    sorted.point.resize(order.size());
    sorted.normal.resize(order.size());
    parallelFor(ctx, order.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            sorted.point[i] = coarser.point[order[i]];
            sorted.normal[i] = coarser.normal[order[i]];
            place[order[i]] = std::uint32_t(i);
        }
    });
    sorted.parent = std::move(coarser.parent);
    parallelFor(ctx, sorted.parent.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) sorted.parent[i] = place[sorted.parent[i]];
    });
    coarser = std::move(sorted);
}

}  // namespace

Index3 cellOf(const Vec3f& point, double cell) {
    const auto number = [cell](float x) {
        return int(std::clamp(std::floor(double(x) / cell), -double(1 << 30), double(1 << 30)));
    };
    return {number(point.x), number(point.y), number(point.z)};
}

CoarserSites mergedByCells(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals, double cell,
                           const RunContext& ctx) {
    if (!(cell > 0)) throw Error(ErrorCode::InvalidOption, "`cell`: is not above 0");
    std::vector<InCell> cells(points.size());
    parallelFor(ctx, points.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            cells[i] = {cellOf(points[i], cell), std::uint32_t(i)};
        }
    });
    parallelSort(ctx, cells);
    CoarserSites coarser;
    coarser.parent.resize(points.size());
    std::vector<Group> groups;
    for (std::size_t first = 0; first < cells.size();) {
        groups.clear();
        const std::uint32_t base = std::uint32_t(coarser.point.size());
        std::size_t i = first;
        for (; i < cells.size() && cells[i].sameCell(cells[first]); ++i) {
            const std::uint32_t number = cells[i].number;
            std::size_t g = 0;
            while (g < groups.size() && !(dot(groups[g].facing, normals[number]) > 0)) ++g;
            if (g == groups.size()) groups.push_back({normals[number], {}, {}, 0});
            groups[g].point = groups[g].point + cast<double>(points[number]);
            groups[g].normal = groups[g].normal + cast<double>(normals[number]);
            ++groups[g].members;
            coarser.parent[number] = base + std::uint32_t(g);
        }
        for (const Group& group : groups) append(coarser, group);
        first = i;
    }
    reorder(coarser, ctx);
    return coarser;
}

}  // namespace vdbsynth
