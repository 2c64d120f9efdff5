// Which piece of the exemplar a patch is.
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/patch/onto/onto_cut.h"
#include "libvdbsynth/patch/onto/onto_layout_steps.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kChoice = 0x63686f6f;
constexpr int kProbes = 12;
constexpr double kGood = 2;    // times the cost of a good match
constexpr int kRounds = 2;     // of moving and turning
constexpr float kNear = 2;     // [steps] from a surface, of nodes that say how to
constexpr double kKept = 3;    // how much more the field's direction counts than that of what lies around
constexpr double kMost = 1.5;  // [steps] by which a patch is moved, or turned at its rim

// The disk's member nearest to the middle of every cell of a square.
std::vector<std::ptrdiff_t> nearestMembers(const SurfaceDisk& disk, int side, double step) {
    std::vector<std::ptrdiff_t> nearest(std::size_t(side) * std::size_t(side), -1);
    std::vector<float> best(nearest.size(), std::numeric_limits<float>::infinity());
    const double low = -0.5 * side * step;
    for (std::size_t m = 0; m < disk.size(); ++m) {
        const int ci = int(std::floor((double(disk.at[m].x) - low) / step)),
                  cj = int(std::floor((double(disk.at[m].y) - low) / step));
        for (int i = std::max(0, ci - 1); i <= std::min(side - 1, ci + 1); ++i)
            for (int j = std::max(0, cj - 1); j <= std::min(side - 1, cj + 1); ++j) {
                const std::size_t cell = std::size_t(i) * std::size_t(side) + std::size_t(j);
                const Vec2f middle{float(low + (i + 0.5) * step), float(low + (j + 0.5) * step)};
                const float away = length(disk.at[m] - middle);
                if (away >= best[cell]) continue;
                best[cell] = away;
                nearest[cell] = std::ptrdiff_t(m);
            }
    }
    return nearest;
}

}  // namespace

OntoLayer::OntoLayer(const OntoSurface& surface, const PatchField& exemplar, const OntoLayoutOptions& options,
                     OntoArrangement& arrangement, const RunContext& ctx)
    : mSurface(surface),
      mExemplar(exemplar),
      mOptions(options),
      mArrangement(arrangement),
      mContext(ctx),
      mDisks(surface),
      mRadius(0.5 * options.patch * exemplar.lattice.step) {
    // Of pieces so small that others of the same phase are in the exemplar.
    const int shorter = std::min(exemplar.lattice.nx, exemplar.lattice.ny),
              side = std::min(options.patch, std::max(2 * options.overlap, shorter * 2 / 5));
    mGood = kGood * nearMatchLevel(exemplar, side, options.overlap, kProbes, options.overlap, ctx);
}

Vec2f OntoLayer::columnOnDisk(int i, int j) const {
    const double step = mExemplar.lattice.step, low = 0.5 * (1 - mOptions.patch);
    return {float((low + i) * step), float((low + j) * step)};
}

PlanePlace OntoLayer::middleOf(const PatchPlace& place) const {
    const double step = mExemplar.lattice.step;
    return {(place.i + 0.5 * mOptions.patch) * step, (place.j + 0.5 * mOptions.patch) * step};
}

OntoOverlap OntoLayer::overlapOf(const SurfaceDisk& disk, double middle) const {
    const int side = mOptions.patch;
    const std::size_t size = mExemplar.columnLength();
    const std::vector<std::ptrdiff_t> nearest = nearestMembers(disk, side, mExemplar.lattice.step);
    OntoOverlap overlap;
    overlap.columns.nx = overlap.columns.ny = side;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const Vec2f at = columnOnDisk(i, j);
            const double away = double(length(at));
            const std::ptrdiff_t member = nearest[std::size_t(i) * std::size_t(side) + std::size_t(j)];
            if (away > mRadius || away < middle || member < 0 ||
                !mArrangement.known(disk.site[std::size_t(member)]))
                continue;
            overlap.columns.columns.push_back({i, j});
            overlap.at.push_back(at);
            auto& values = overlap.columns.values;
            values.resize(values.size() + size);
            readOnto(mExemplar, mArrangement, disk, member, at, values.data() + values.size() - size);
        }
    return overlap;
}

// Where patches that lie at the overlap would continue: the places at which this one would be the same.
std::vector<PatchPlace> OntoLayer::continuations(const OntoOverlap& overlap, const SurfaceDisk& disk) const {
    std::vector<std::int32_t> seen;
    std::vector<PatchPlace> places;
    const double step = mExemplar.lattice.step;
    for (std::size_t m = 0; m < disk.size() && !overlap.at.empty(); ++m) {
        if (double(length(disk.at[m])) > mRadius || !mArrangement.known(disk.site[m])) continue;
        const std::int32_t* labels = mArrangement.column(disk.site[m]);
        for (int k = 0; k < mArrangement.nz; ++k) {
            if ((k > 0 && labels[k] == labels[k - 1]) ||
                std::find(seen.begin(), seen.end(), labels[k]) != seen.end())
                continue;
            seen.push_back(labels[k]);
            const OntoPatch& patch = mArrangement.patches[std::size_t(labels[k])];
            const std::ptrdiff_t other = patch.disk.find(disk.site[m]);
            const Vec2f turn = turnBetween(disk, std::ptrdiff_t(m), patch.disk, other);
            const PlanePlace middle =
                patch.inExemplar(patch.disk.at[std::size_t(other)] + rotated(disk.at[m] * -1.f, turn));
            places.push_back({int(std::lround(middle.x / step - 0.5 * mOptions.patch)),
                              int(std::lround(middle.y / step - 0.5 * mOptions.patch))});
        }
    }
    return places;
}

PatchCandidate OntoLayer::choose(const OntoOverlap& overlap, const SurfaceDisk& disk) const {
    Random random(mContext.seed, mArrangement.patches.size(), kChoice);
    if (overlap.at.empty()) {
        const auto rows = std::uint32_t(mExemplar.lattice.nx - mOptions.patch + 1),
                   across = std::uint32_t(mExemplar.lattice.ny - mOptions.patch + 1);
        const int i = int(random.below(rows)), j = int(random.below(across));
        return {{i, j}, 0};
    }
    CandidateOptions options{mOptions.tolerance, continuations(overlap, disk), mOptions.overlap};
    auto candidates = patchCandidates(mExemplar, overlap.columns, options, mContext);
    const double values = double(overlap.columns.values.size());
    double least = std::numeric_limits<double>::infinity();
    for (const PatchCandidate& candidate : candidates) least = std::min(least, candidate.cost);
    if (!(least <= mGood * values)) {
        options.excluded.clear();
        candidates = patchCandidates(mExemplar, overlap.columns, options, mContext);
    }
    PatchCandidate chosen = candidates[random.below(std::uint32_t(candidates.size()))];
    chosen.cost /= values;
    return chosen;
}

// Moves and turns a patch so that sum (D_old - D_new)^2 is least, over nodes where both know a surface near,
// by Gauss and Newton; unknown are both moves [steps] and the turn, as a move at the rim.
void OntoLayer::fit(const OntoOverlap& overlap, OntoPatch& patch) const {
    const double step = mExemplar.lattice.step, radius = mRadius / step;
    const PlanePlace begin = patch.from;
    std::vector<float> now(mExemplar.columnLength());
    double turned = 0;
    for (int round = 0; round < kRounds && !overlap.at.empty(); ++round) {
        Eigen::Matrix3d squares = Eigen::Matrix3d::Identity() * 1e-3;
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (std::size_t c = 0; c < overlap.at.size(); ++c) {
            readBetween(mExemplar, patch.inExemplar(overlap.at[c]), now.data());
            const Vec2f arm = rotated(overlap.at[c], patch.turn) * float(1 / (step * radius));
            const float* old = overlap.columns.values.data() + c * now.size();
            for (std::size_t n = 0; n < now.size(); n += kFieldValues) {
                if (std::abs(old[n]) > kNear || std::abs(now[n]) > kNear) continue;
                const Eigen::Vector3d slope(double(now[n + 1]), double(now[n + 2]),
                                            double(now[n + 2] * arm.x - now[n + 1] * arm.y));
                squares += slope * slope.transpose();
                right += slope * double(old[n] - now[n]);
            }
        }
        // Turned only by a part of what its neighbours are: directions are the field's, and errors must not
        // add up around a limb.
        right[2] -= kKept * squares(2, 2) * turned;
        squares(2, 2) *= 1 + kKept;
        const Eigen::Vector3d move = squares.ldlt().solve(right);
        // Rotations are products of small ones, by the half angle's tangent.
        const double turn = std::clamp(turned + move[2], -kMost, kMost) - turned, half = 0.5 * turn / radius;
        turned += turn;
        const Vec2f by{float((1 - half * half) / (1 + half * half)), float(2 * half / (1 + half * half))};
        patch.turn = rotated(patch.turn, by);
        const auto moved = [&](double from, double along, double first, int count) {
            const double low = std::max(first - kMost * step, mRadius),
                         high = std::min(first + kMost * step, count * step - mRadius);
            return std::clamp(from + along * step, std::min(low, high), high);
        };
        patch.from.x = moved(patch.from.x, move[0], begin.x, mExemplar.lattice.nx);
        patch.from.y = moved(patch.from.y, move[1], begin.y, mExemplar.lattice.ny);
    }
}

std::size_t OntoLayer::lay(std::uint32_t centre, double middle, double core) {
    OntoPatch patch;
    patch.radius = mRadius;
    patch.disk = mDisks.around(centre, mRadius + kOntoRim * mExemplar.lattice.step);
    const OntoOverlap overlap = overlapOf(patch.disk, middle);
    const PatchCandidate chosen = choose(overlap, patch.disk);
    patch.from = middleOf(chosen.place);
    patch.cost = chosen.cost;
    fit(overlap, patch);
    const auto number = std::int32_t(mArrangement.patches.size());
    mArrangement.patches.push_back(std::move(patch));
    return cutOntoSurface(mSurface, mExemplar, number, core, mArrangement);
}

}  // namespace vdbsynth
