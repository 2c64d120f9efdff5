#include "libvdbsynth/patch/onto/onto_layout.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/smallest_rotation.h"
#include "libvdbsynth/patch/onto/onto_layout_steps.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kSeed = 0x6f6e746f;

void requireLayout(const PatchField& exemplar, const OntoLayoutOptions& options) {
    const auto require = [](bool holds, const char* text) {
        if (!holds) throw Error(ErrorCode::InvalidOption, text);
    };
    require(options.patch >= 4, "a patch must be at least four steps of the field wide");
    require(options.overlap >= 1 && 2 * options.overlap < options.patch,
            "`overlap`: over a surface, patches are round; it must be under half a patch");
    require(options.tolerance >= 0 && options.tolerance <= 10, "`tolerance` must be 0..10");
    require(options.repairs >= 0 && options.repairs <= 20, "`repairs` must be 0..20");
    if (options.patch > std::min(exemplar.lattice.nx, exemplar.lattice.ny))
        throw Error(ErrorCode::Unusable, "a patch is larger than the exemplar; a smaller `patch` fits");
}

using Reached = std::pair<float, std::uint32_t>;
using Reachable = std::priority_queue<Reached, std::vector<Reached>, std::greater<>>;

// How fast normals and the frames' directions turn between two sites, squared [1 / world^2].
float turning(const OntoSurface& surface, std::uint32_t a, std::uint32_t b) {
    const SurfaceSites& sites = surface.sites;
    const float way = length(sites.point[b] - sites.point[a]);
    if (!(way > 0)) return 0;
    const Vec3f bend = sites.normal[b] - sites.normal[a],
                turn = surface.tangent[b] - carried(surface.tangent[a], sites.normal[a], sites.normal[b]);
    return (dot(bend, bend) + dot(turn, turn)) / (way * way);
}

// Visits the sites nearest first from what is reached already. @param cost  of the way between two
template <typename Cost, typename Visit>
void outward(const SurfaceSites& sites, Reachable& open, std::vector<float>& way, const Cost& cost,
             const Visit& visit) {
    while (!open.empty()) {
        const auto [distance, site] = open.top();
        open.pop();
        if (distance > way[site]) continue;
        visit(site);
        for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n) {
            const std::uint32_t to = sites.neighbours[n];
            const float there = distance + cost(site, to);
            if (there >= way[to]) continue;
            way[to] = there;
            open.push({there, to});
        }
    }
}

// A site drawn from those that are farthest from edges and places where directions turn fast: at least half
// as far as the farthest.
std::uint32_t calmSite(const OntoSurface& surface, float radius, std::uint64_t seed) {
    const SurfaceSites& sites = surface.sites;
    std::vector<float> way(sites.size(), std::numeric_limits<float>::max());
    Reachable open;
    for (std::uint32_t site = 0; site < sites.size(); ++site)
        for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n)
            if (turning(surface, site, sites.neighbours[n]) * radius * radius > 1 && way[site] > 0) {
                way[site] = 0;
                open.push({0.f, site});
            }
    outward(
        sites, open, way,
        [&](std::uint32_t a, std::uint32_t b) { return length(sites.point[b] - sites.point[a]); },
        [](std::uint32_t) {});
    const float farthest = *std::max_element(way.begin(), way.end());
    std::vector<std::uint32_t> calm;
    for (std::uint32_t site = 0; site < sites.size(); ++site)
        if (way[site] >= 0.5f * farthest) calm.push_back(site);
    return calm[Random(seed, 0, kSeed).below(std::uint32_t(calm.size()))];
}

// The sites outward from one of them, part by part of the surface. A way counts 1 + (radius * turning)^2
// times, so that what is bent sharply comes last: patches that come from two sides across an edge do not fit,
// and what is calm should not suffer from it.
std::vector<std::uint32_t> layingOrder(const OntoSurface& surface, std::uint32_t seed, float radius) {
    const SurfaceSites& sites = surface.sites;
    std::vector<std::uint32_t> order;
    std::vector<float> way(sites.size(), std::numeric_limits<float>::infinity());
    std::vector<char> done(sites.size(), 0);
    std::uint32_t next = 0;
    while (order.size() < sites.size()) {
        Reachable open;
        way[seed] = 0;
        open.push({0.f, seed});
        outward(
            sites, open, way,
            [&](std::uint32_t a, std::uint32_t b) {
                return length(sites.point[b] - sites.point[a]) *
                       (1 + radius * radius * turning(surface, a, b));
            },
            [&](std::uint32_t site) {
                if (done[site]) return;
                done[site] = 1;
                order.push_back(site);
            });
        while (next < sites.size() && done[next]) ++next;
        seed = next;
    }
    return order;
}

}  // namespace

std::uint32_t OntoLayer::centreFor(std::uint32_t uncovered) {
    constexpr std::size_t kTried = 48;
    constexpr double kKnown = 0.35;
    const double inside = mRadius - mOptions.overlap * mExemplar.lattice.step;
    const SurfaceDisk around = mDisks.around(uncovered, mRadius + inside);
    std::vector<std::size_t> tried;
    for (std::size_t m = 0; m < around.size(); ++m)
        if (double(length(around.at[m])) <= inside) tried.push_back(m);
    std::uint32_t best = uncovered;
    double most = -1;
    const std::size_t stride = std::max<std::size_t>(1, tried.size() / kTried);
    for (std::size_t n = 0; n < tried.size(); n += stride) {
        std::size_t open = 0, known = 0;
        for (std::size_t m = 0; m < around.size(); ++m)
            if (double(length(around.at[m] - around.at[tried[n]])) <= mRadius)
                ++(mArrangement.known(around.site[m]) ? known : open);
        // Where too little is known to tell a good piece from a bad one, the more the better.
        const double share = double(known) / double(known + open);
        const double value = share >= kKnown ? 1 + double(open) : share;
        if (value <= most) continue;
        most = value;
        best = around.site[tried[n]];
    }
    return best;
}

OntoArrangement layOntoSurface(const OntoSurface& surface, const PatchField& exemplar,
                               const OntoLayoutOptions& options, const RunContext& ctx) {
    requireLayout(exemplar, options);
    const std::size_t count = surface.sites.size();
    OntoArrangement arrangement;
    arrangement.nz = exemplar.lattice.nz;
    arrangement.step = exemplar.lattice.step;
    arrangement.overlap = options.overlap * exemplar.lattice.step;
    requireMemory(ctx, 4.0 * double(count) * arrangement.nz + 64.0 * double(count), "the surface's map",
                  "a larger `scale` needs less");
    arrangement.label.assign(count * std::size_t(arrangement.nz), OntoArrangement::kNone);
    OntoLayer layer(surface, exemplar, options, arrangement, ctx);
    const float radius = float(0.5 * options.patch * exemplar.lattice.step);
    Stage stage(ctx, "laying patches", count);
    std::size_t passed = 0;
    for (const std::uint32_t site : layingOrder(surface, calmSite(surface, radius, ctx.seed), radius)) {
        ++passed;
        if (arrangement.known(site)) continue;
        layer.lay(layer.centreFor(site), 0, 0);
        // Where the disk around that place is bent, the site may lie outside.
        if (!arrangement.known(site)) layer.lay(site, 0, 0);
        stage.advance(passed);
        passed = 0;
    }
    stage.advance(passed);
    for (int round = 0; round < options.repairs; ++round)
        if (layer.repair() == 0) break;
    return arrangement;
}

}  // namespace vdbsynth
