#include "libvdbsynth/patch/onto/onto_layout.h"

#include "libvdbsynth/base/error.h"
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

// A way counts 1 + (radius * curvature)^2 times, so that what is bent sharply comes last: patches that come
// from two sides across an edge do not fit, and what is flat should not suffer from it.
float wayBetween(const SurfaceSites& sites, std::uint32_t a, std::uint32_t b, float radius) {
    const float way = length(sites.point[b] - sites.point[a]),
                bend = length(sites.normal[b] - sites.normal[a]);
    return way > 0 ? way + radius * radius * bend * bend / way : 0;
}

// The sites outward from one of them, part by part of the surface.
std::vector<std::uint32_t> outward(const SurfaceSites& sites, std::uint32_t seed, float radius) {
    using Reached = std::pair<float, std::uint32_t>;
    std::vector<std::uint32_t> order;
    std::vector<char> done(sites.size(), 0);
    std::vector<float> way(sites.size(), std::numeric_limits<float>::infinity());
    std::uint32_t next = 0;
    while (order.size() < sites.size()) {
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
        way[seed] = 0;
        open.push({0.f, seed});
        while (!open.empty()) {
            const auto [distance, site] = open.top();
            open.pop();
            if (done[site]) continue;
            done[site] = 1;
            order.push_back(site);
            for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n) {
                const std::uint32_t to = sites.neighbours[n];
                const float there = distance + wayBetween(sites, site, to, radius);
                if (there >= way[to]) continue;
                way[to] = there;
                open.push({there, to});
            }
        }
        while (next < sites.size() && done[next]) ++next;
        seed = next;
    }
    return order;
}

}  // namespace

std::uint32_t OntoLayer::centreFor(std::uint32_t uncovered) {
    constexpr std::size_t kTried = 24;
    const double inside = mRadius - mOptions.overlap * mExemplar.lattice.step;
    const SurfaceDisk around = mDisks.around(uncovered, mRadius + inside);
    std::vector<std::size_t> tried, open;
    for (std::size_t m = 0; m < around.size(); ++m) {
        const double away = double(length(around.at[m]));
        if (away <= inside && away >= 0.6 * inside) tried.push_back(m);
        if (!mArrangement.known(around.site[m])) open.push_back(m);
    }
    const auto covered = [&](const Vec2f& middle) {
        return std::count_if(open.begin(), open.end(),
                             [&](std::size_t m) { return double(length(around.at[m] - middle)) <= mRadius; });
    };
    std::uint32_t best = uncovered;
    auto most = covered({0, 0});
    const std::size_t stride = std::max<std::size_t>(1, tried.size() / kTried);
    for (std::size_t n = 0; n < tried.size(); n += stride)
        if (const auto count = covered(around.at[tried[n]]); count > most) {
            most = count;
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
    const std::uint32_t seed = Random(ctx.seed, 0, kSeed).below(std::uint32_t(count));
    const float radius = float(0.5 * options.patch * exemplar.lattice.step);
    Stage stage(ctx, "laying patches", count);
    std::size_t passed = 0;
    for (const std::uint32_t site : outward(surface.sites, seed, radius)) {
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
