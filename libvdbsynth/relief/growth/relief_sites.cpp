#include "libvdbsynth/relief/growth/relief_sites.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

bool finite(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void requireFinite(const std::vector<Vec3f>& values, const std::string& what, const std::string& name) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!finite(values[i]))
            throw Error(ErrorCode::Unusable, what + ": " + name + " " + std::to_string(i) + " is not finite");
}

struct Near {
    float squared;
    std::uint32_t site;
    bool operator<(const Near& other) const {
        return squared != other.squared ? squared < other.squared : site < other.site;
    }
};

// Walks about one site after another; `mSeen` names the last site that a site was reached from.
class Walk {
public:
    explicit Walk(const SurfaceSites& sites) : mSites(sites), mSeen(sites.size(), 0) {}

    const std::vector<Near>& around(std::uint32_t centre, float radius) {
        mFound.assign(1, {0, centre});
        const std::uint32_t mark = centre + 1;
        mSeen[centre] = mark;
        for (std::size_t at = 0; at < mFound.size(); ++at) {
            const std::uint32_t from = mFound[at].site;
            for (std::size_t k = mSites.begin[from]; k < mSites.begin[from + 1]; ++k) {
                const std::uint32_t to = mSites.neighbours[k];
                if (mSeen[to] == mark) continue;
                mSeen[to] = mark;
                const Vec3f d = mSites.point[to] - mSites.point[centre];
                if (dot(d, d) <= radius * radius) mFound.push_back({dot(d, d), to});
            }
        }
        mFound.erase(mFound.begin());
        std::sort(mFound.begin(), mFound.end());
        return mFound;
    }

private:
    const SurfaceSites& mSites;
    std::vector<std::uint32_t> mSeen;
    std::vector<Near> mFound;
};

}  // namespace

ReliefFrame reliefFrame(const Vec3f& point, const Vec3f& normal, const Vec3f& tangent) {
    Vec3f along = tangent - normal * dot(tangent, normal);
    if (!(dot(along, along) > 1e-12f * dot(tangent, tangent))) {
        // The axis that is farthest from the normal.
        const Vec3f size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
        Vec3f axis;
        axis[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
        along = axis - normal * dot(axis, normal);
    }
    along = normalized(along);
    return {point, along, cross(normal, along), normal};
}

std::vector<ReliefFrame> reliefFrames(const SurfaceSites& sites, const std::vector<Vec3f>& tangent,
                                      const RunContext& ctx) {
    std::vector<ReliefFrame> frames(sites.size());
    parallelFor(ctx, sites.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            frames[i] = reliefFrame(sites.point[i], sites.normal[i], tangent[i]);
    });
    return frames;
}

void requireSites(const SurfaceSites& sites, const std::vector<Vec3f>& tangent, const std::string& what) {
    const std::size_t n = sites.size();
    if (n == 0) throw Error(ErrorCode::EmptyInput, what + " has no sites");
    if (sites.normal.size() != n || tangent.size() != n || sites.begin.size() != n + 1 ||
        sites.begin[n] != sites.neighbours.size())
        throw Error(ErrorCode::ShapeMismatch,
                    what + ": points, normals, tangents and neighbours differ in number");
    for (std::uint32_t neighbour : sites.neighbours)
        if (neighbour >= n)
            throw Error(ErrorCode::ShapeMismatch,
                        what + ": neighbour " + std::to_string(neighbour) + " is no site");
    requireFinite(sites.point, what, "point");
    requireFinite(sites.normal, what, "normal");
    requireFinite(tangent, what, "tangent");
}

void requireReliefSites(const ReliefSites& relief, const std::string& what) {
    requireSites(relief.sites, relief.tangent, what);
    if (relief.displacement.size() != relief.sites.size())
        throw Error(ErrorCode::ShapeMismatch, what + " has " + std::to_string(relief.sites.size()) +
                                                  " sites but " + std::to_string(relief.displacement.size()) +
                                                  " displacements");
    requireFinite(relief.displacement, what, "displacement");
}

double meanSpacing(const SurfaceSites& sites) {
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        if (sites.degree(i) == 0) continue;
        const std::uint32_t last = sites.neighbours[sites.begin[i + 1] - 1];
        const double reach = double(length(sites.point[last] - sites.point[i]));
        sum += reach * std::sqrt(kPi / (double(sites.degree(i)) + 0.5));
        ++counted;
    }
    return counted > 0 ? sum / double(counted) : 0;
}

ReliefNeighbourhoods reliefNeighbourhoods(const SurfaceSites& sites, double radius, double falloff,
                                          const RunContext& ctx) {
    constexpr std::size_t kGrain = 1024;
    const std::size_t n = sites.size();
    std::vector<std::vector<Near>> found(n);
    std::vector<char> cut(n, 0);
    parallelFor(ctx, n, kGrain, [&](std::size_t begin, std::size_t end) {
        Walk walk(sites);
        for (std::size_t i = begin; i < end; ++i) {
            if (i % 64 == 0) throwIfCancelled(ctx);
            const std::vector<Near>& near = walk.around(std::uint32_t(i), float(radius));
            cut[i] = near.size() > kMostNeighbours;
            found[i].assign(near.begin(),
                            near.begin() + std::ptrdiff_t(std::min(near.size(), kMostNeighbours)));
        }
    });
    ReliefNeighbourhoods result;
    result.begin.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        result.begin[i + 1] = result.begin[i] + found[i].size();
        result.cut += cut[i] ? 1 : 0;
    }
    requireMemory(ctx, double(result.begin[n]) * 24, "the neighbourhoods of the sites",
                  "make `neighbourhood` smaller");
    result.member.resize(result.begin[n]);
    result.weight.resize(result.begin[n]);
    const double scale = -0.5 / (falloff * radius * falloff * radius);
    parallelFor(ctx, n, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < found[i].size(); ++k) {
                result.member[result.begin[i] + k] = found[i][k].site;
                result.weight[result.begin[i] + k] = float(exponential(scale * double(found[i][k].squared)));
            }
    });
    return result;
}

}  // namespace vdbsynth
