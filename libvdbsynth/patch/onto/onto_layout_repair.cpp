// Patches over the worst seams.
#include "libvdbsynth/patch/onto/onto_layout_steps.h"
#include "libvdbsynth/points/site_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr float kClamp = 1.5f, kMissing = 3;  // [steps]

// How far apart two patches' surfaces are at a node.
float apartAt(const PatchField& exemplar, const OntoArrangement& arrangement, std::uint32_t site, int k,
              std::int32_t p, std::int32_t q) {
    float values[2];
    int read = 0;
    for (const std::int32_t label : {p, q}) {
        const OntoPatch& patch = arrangement.patches[std::size_t(label)];
        const std::ptrdiff_t member = patch.disk.find(site);
        if (member < 0) return kMissing;
        values[read++] = std::clamp(
            readDistance(exemplar, patch.inExemplar(patch.disk.at[std::size_t(member)]), k), -kClamp, kClamp);
    }
    return std::abs(values[0] - values[1]);
}

}  // namespace

// Of the pairs of nodes of which this is the first.
double OntoLayer::seamOf(std::uint32_t site) const {
    const SurfaceSites& sites = mSurface.sites;
    const std::int32_t* here = mArrangement.column(site);
    double sum = 0;
    const auto add = [&](std::uint32_t other, int k, int l, std::int32_t label) {
        if (label == here[k]) return;
        sum += double(apartAt(mExemplar, mArrangement, site, k, here[k], label) +
                      apartAt(mExemplar, mArrangement, other, l, here[k], label));
    };
    for (int k = 0; k < mArrangement.nz; ++k) {
        for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n)
            if (sites.neighbours[n] > site)
                add(sites.neighbours[n], k, k, mArrangement.column(sites.neighbours[n])[k]);
        if (k + 1 < mArrangement.nz) add(site, k, k + 1, here[k + 1]);
    }
    return sum;
}

bool OntoLayer::tryRepair(std::uint32_t centre) {
    const double step = mExemplar.lattice.step, core = mRadius - mOptions.overlap * step;
    const SurfaceDisk disk = mDisks.around(centre, mRadius + 3 * step);
    const std::size_t nz = std::size_t(mArrangement.nz);
    const auto seams = [&] {
        return std::accumulate(disk.site.begin(), disk.site.end(), 0.0,
                               [&](double sum, std::uint32_t site) { return sum + seamOf(site); });
    };
    std::vector<std::int32_t> before;
    for (const std::uint32_t site : disk.site) {
        const std::int32_t* labels = mArrangement.column(site);
        before.insert(before.end(), labels, labels + nz);
    }
    const double old = seams();
    // Of the middle, which is not compared, everything is replaced.
    lay(centre, core, core);
    if (seams() < old) return true;
    mArrangement.patches.pop_back();
    for (std::size_t m = 0; m < disk.size(); ++m)
        std::copy_n(before.begin() + std::ptrdiff_t(m * nz), nz,
                    mArrangement.label.begin() + std::ptrdiff_t(std::size_t(disk.site[m]) * nz));
    return false;
}

int OntoLayer::repair() {
    const SurfaceSites& sites = mSurface.sites;
    // Cells half a patch wide; a patch is laid over the middle of the worst.
    const CoarserSites cells = mergedByCells(sites.point, sites.normal, mRadius, mContext);
    std::vector<double> sums(cells.point.size(), 0.0);
    std::vector<std::uint32_t> middle(sums.size(), 0);
    std::vector<float> nearest(sums.size(), std::numeric_limits<float>::infinity());
    for (std::uint32_t site = 0; site < sites.size(); ++site) {
        const std::uint32_t cell = cells.parent[site];
        sums[cell] += seamOf(site);
        const float away = length(sites.point[site] - cells.point[cell]);
        if (away >= nearest[cell]) continue;
        nearest[cell] = away;
        middle[cell] = site;
    }
    std::vector<std::size_t> order(sums.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sums[a] > sums[b]; });
    order.resize((order.size() + 3) / 4);
    Stage stage(mContext, "mending seams", order.size());
    int kept = 0;
    for (const std::size_t cell : order) {
        if (sums[cell] > 0 && tryRepair(middle[cell])) ++kept;
        stage.advance();
    }
    return kept;
}

}  // namespace vdbsynth
