#include "libvdbsynth/relief/growth/orientation_iteration.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/smallest_rotation.h"
#include "libvdbsynth/relief/growth/grown_relief_steps.h"
#include "libvdbsynth/relief/growth/orientation_iteration_steps.h"
#include "libvdbsynth/surface/direction_field.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// The sites of a patch, at most kReferences, evenly by distance from its middle, which comes first.
std::vector<std::uint32_t> patchAround(std::uint32_t middle, const ReliefNeighbourhoods& neighbourhoods) {
    std::vector<std::uint32_t> patch{middle};
    const std::size_t size = neighbourhoods.size(middle), taken = std::min(size, kReferences - 1);
    for (std::size_t k = 0; k < taken; ++k)
        patch.push_back(neighbourhoods.member[neighbourhoods.begin[middle] + k * size / taken]);
    return patch;
}

// Frames of a patch, all oriented as its middle one.
std::vector<ReliefFrame> patchFrames(const ReliefSites& surface, const std::vector<std::uint32_t>& patch) {
    const SurfaceSites& sites = surface.sites;
    const std::uint32_t middle = patch[0];
    std::vector<ReliefFrame> frames;
    for (std::uint32_t i : patch)
        frames.push_back(
            reliefFrame(sites.point[i], sites.normal[i],
                        carried(surface.tangent[middle], sites.normal[middle], sites.normal[i])));
    return frames;
}

// The first directions: outward from the middle, each site by the neighbours that have theirs.
std::vector<Vec3f> grownDirections(const RotationCosts& costs, const SurfaceSites& sites,
                                   std::uint32_t middle, double smoothness, const RunContext& ctx) {
    ReliefNeighbourhoods graph;
    graph.begin.assign(sites.begin.begin(), sites.begin.end());
    graph.member = sites.neighbours;
    GrowthQueue queue(graph, sites.size());
    std::vector<Vec3f> tangent(sites.size());
    const auto take = [&](std::uint32_t i) {
        tangent[i] = bestDirection(costs, i, neighboursMean(sites, tangent, i, queue.allDone()), smoothness);
        queue.done(i);
    };
    tangent[middle] = costs.frame[middle].tangent;
    queue.done(middle);
    for (std::uint32_t start = 0, grown = 0; start < sites.size(); ++start) {
        for (std::uint32_t i; queue.next(i);) {
            take(i);
            if (++grown % 1024 == 0) throwIfCancelled(ctx);
        }
        if (!queue.isDone(start)) take(start);
    }
    for (std::uint32_t i; queue.next(i);) take(i);
    return tangent;
}

double radiusFor(const SurfaceSites& sites, double given) {
    if (given > 0) return given;
    const double spacing = meanSpacing(sites);
    return spacing > 0 ? kSpacingsInNeighbourhood * spacing : 1;
}

void sayFound(const ReliefOrientation& result, const OrientationOptions& options, const char* what,
              const RunContext& ctx) {
    const std::string change = roundedText(result.change, 3) + " degrees";
    if (result.converged)
        message(ctx, MessageLevel::Note,
                std::string("the orientation of the ") + what + " is found by iteration (" +
                    countText(std::size_t(result.rounds), "round") + ", last change " + change +
                    "); give directions where it should follow others");
    else
        message(ctx, MessageLevel::Warning,
                std::string("the orientation of the ") + what + " still changes by " + change + " (`limit` " +
                    roundedText(options.limit, 3) + ") after " +
                    countText(std::size_t(result.rounds), "round") +
                    "; give directions, or a larger `neighbourhood` or `smoothness`");
}

// Of every grown site: the better rotations, among where it and its neighbours came from.
ReliefOrientation reoriented(const ReliefSites& grown, const std::vector<std::uint32_t>& source,
                             const ReliefMatcher& matcher, const ReliefNeighbourhoods& neighbourhoods,
                             const OrientationOptions& options, const RunContext& ctx) {
    const SurfaceSites& sites = grown.sites;
    const RotationCosts costs = rotationCosts(
        grown, matcher, neighbourhoods, options.angles,
        [&](std::size_t i, std::vector<std::uint32_t>& references) {
            references.assign(1, source[i]);
            for (std::size_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
                references.push_back(source[sites.neighbours[k]]);
        },
        ctx);
    ReliefOrientation result;
    for (const ReliefFrame& frame : costs.frame) result.tangent.push_back(frame.tangent);
    relaxOrientation(costs, sites, options, result, ctx);
    return result;
}

}  // namespace

void validate(const OrientationOptions& options) {
    const auto require = [](double value, double low, double high, const char* field, const char* range) {
        requireOption(value >= low && value <= high, field, roundedText(value, 4), range);
    };
    require(options.neighbourhood, 0, 1e30, "neighbourhood", "a radius, or 0 for 4 spacings of the sites");
    require(options.weightFalloff, 0.05, 100, "weightFalloff", "0.05 to 100");
    require(options.angles, 8, 360, "angles", "8 to 360");
    require(options.smoothness, 0, 100, "smoothness", "0 to 100");
    require(options.limit, 0.01, 90, "limit", "0.01 to 90 degrees");
    require(options.rounds, 1, 1000, "rounds", "1 to 1000");
}

std::vector<Vec3f> smoothestTangents(const SurfaceSites& sites, const RunContext& ctx) {
    const double spacing = meanSpacing(sites);
    return smoothDirectionField(sites, sitePlaces(sites, spacing > 0 ? spacing : 1), {1, 0, 0}, ctx).tangent;
}

ReliefOrientation iterateOrientation(ReliefSites surface, const ReliefDistance& distance,
                                     const OrientationOptions& options, const RunContext& ctx) {
    validate(options);
    const bool given = !surface.tangent.empty();
    if (!given) surface.tangent.assign(surface.sites.size(), {1, 0, 0});
    requireReliefSites(surface, "the surface");
    return withThreads(ctx, [&] {
        if (!given) surface.tangent = smoothestTangents(surface.sites, ctx);
        const double radius = radiusFor(surface.sites, options.neighbourhood);
        const ReliefNeighbourhoods neighbourhoods =
            reliefNeighbourhoods(surface.sites, radius, options.weightFalloff, ctx);
        const std::uint32_t middle = seedOfSample(surface, radius, kTypicalSeed, ctx);
        const std::vector<std::uint32_t> patch = patchAround(middle, neighbourhoods);
        const ReliefMatcher matcher(patchFrames(surface, patch), distance);
        std::vector<std::uint32_t> all(patch.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = std::uint32_t(i);
        const RotationCosts costs = rotationCosts(
            surface, matcher, neighbourhoods, options.angles,
            [&](std::size_t, std::vector<std::uint32_t>& references) { references = all; }, ctx);
        ReliefOrientation result;
        result.tangent = grownDirections(costs, surface.sites, middle, options.smoothness, ctx);
        relaxOrientation(costs, surface.sites, options, result, ctx);
        sayFound(result, options, "sample", ctx);
        return result;
    });
}

OrientedRelief growAndOrient(const ReliefSites& sample, const ReliefDistance& distance,
                             const SurfaceSites& target, const GrownReliefOptions& options,
                             const OrientationOptions& orientation, const RunContext& ctx) {
    validate(options);
    validate(orientation);
    requireReliefSites(sample, "the sample");
    requireSites(target, std::vector<Vec3f>(target.size()), "the target");
    return withThreads(ctx, [&] {
        const ReliefMatcher matcher(reliefFrames(sample.sites, sample.tangent, ctx), distance);
        const ReliefNeighbourhoods neighbourhoods = reliefNeighbourhoods(
            target, radiusFor(target, options.neighbourhood), options.weightFalloff, ctx);
        OrientedRelief best;
        std::vector<Vec3f> tangent = smoothestTangents(target, ctx);
        RunContext quiet = ctx;  // what the first growth says holds for all
        quiet.onMessage = nullptr;
        double change = 0;
        bool converged = false;
        int growths = 0;
        while (!converged && growths < kMostGrowths) {
            GrownRelief relief =
                growRelief(sample, distance, target, tangent, options, growths == 0 ? ctx : quiet);
            const ReliefSites surface{target, tangent, relief.displacement};
            if (growths++ == 0 || relief.grownMean < best.relief.grownMean) {
                best.orientation.tangent = tangent;
                best.relief = relief;
            }
            std::vector<Vec3f> next =
                reoriented(surface, relief.source, matcher, neighbourhoods, orientation, ctx).tangent;
            change = meanAngle(tangent, next);
            converged = change < orientation.limit;
            tangent.swap(next);
        }
        best.orientation.rounds = growths;
        best.orientation.change = change;
        best.orientation.converged = converged;
        sayFound(best.orientation, orientation, "target", ctx);
        return best;
    });
}

}  // namespace vdbsynth
