#pragma once
#include "libvdbsynth/relief/growth/relief_distance.h"
#include "libvdbsynth/relief/growth/relief_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// One v of N(t)': where the displaced site is in the frame of t, and w_v.
struct ReliefTerm {
    Vec3f place;  ///< [voxels of the sample]
    float weight;
};

/// One place of the sample for one t.
struct ReliefMatch {
    float cost = 0;  ///< SSD [voxels^2], the sum of eq. 1
    std::uint32_t site = 0;

    bool operator<(const ReliefMatch& other) const {
        return cost != other.cost ? cost < other.cost : site < other.site;
    }
};

/// The sample of eq. 1: frames at its sites, in voxels, and the distances around them.
class ReliefMatcher {
public:
    /// @param distance  borrowed for the lifetime of this
    ReliefMatcher(std::vector<ReliefFrame> frames, const ReliefDistance& distance);

    std::size_t size() const { return mFrames.size(); }
    const ReliefFrame& frame(std::size_t site) const { return mFrames[site]; }  ///< its point in voxels
    const ReliefDistance& distance() const { return *mDistance; }

    /// N(t)' of a surface with relief: members that `done` (null: all) marks, displaced, in t's frame.
    /// @param frame  of t, world
    void terms(const ReliefFrame& frame, const SurfaceSites& sites, const std::vector<Vec3f>& displacement,
               const ReliefNeighbourhoods& neighbourhoods, std::size_t t, const char* done,
               std::vector<ReliefTerm>& out) const;

    /// eq. 1: SSD = sum over v of w_v dist(v, sample's surface)^2, v mapped rigidly from the frame of t to
    /// that of s [breckon2006]. Sums of what is not negative only grow, so one that is over `most` may be
    /// left early.
    /// @return the sum, or anything over `most` if it is
    float cost(const ReliefFrame& frame, const std::vector<ReliefTerm>& terms, float most) const {
        float sum = 0;
        for (const ReliefTerm& term : terms) {
            sum += term.weight * mDistance->squared(frame.point + frame.toWorld(term.place));
            if (sum > most) break;
        }
        return sum;
    }

    /// The `count` sites of the smallest cost, exhaustively, best first, equal costs by number.
    /// @param likely  sites that are looked at first, for a bound: changes only the time taken
    /// @throw Error Cancelled
    /// @par Cost    O(sites * terms) at most   @par Repeats same bits for any number of threads
    std::vector<ReliefMatch> best(const std::vector<ReliefTerm>& terms, std::size_t count,
                                  const std::vector<std::uint32_t>& likely, const RunContext& ctx = {}) const;

private:
    std::vector<ReliefFrame> mFrames;
    const ReliefDistance* mDistance;
};

/// How far a surface's neighbourhoods lie from the sample's surface where they came from.
struct ReliefMismatch {
    double mean = 0;  ///< [world^2] mean over sites of SSD / sum of w_v, over whole neighbourhoods
    /// Share of places beyond the field's box, which are left out: at the border of an open sample a
    /// neighbourhood continues where the sample does not.
    double outside = 0;
    double capped = 0;  ///< share of the others whose distance is the band's half-width (relief_distance.h)
    std::size_t sites = 0;  ///< that have neighbours inside and so were counted
};

/// eq. 1 for any assignment, so that methods can be compared: of every site t of `surface` the whole N(t),
/// what came later than t too, is mapped from t's frame to the frame `source[t]` of the sample. While
/// relief grows only a part of N(t) is there, so a front may take its source from the sample's border;
/// bestMismatch does not mind.
/// @param source          [sites] frames on the sample, world; their points need not be its sites
/// @param neighbourhoods  of surface.sites
/// @throw Error ShapeMismatch (another number of sources), as requireReliefSites, Cancelled
/// @par Cost    O(sites * members)   @par Repeats same bits for any number of threads
ReliefMismatch assignedMismatch(const ReliefSites& surface, const std::vector<ReliefFrame>& source,
                                const ReliefDistance& distance, const ReliefNeighbourhoods& neighbourhoods,
                                const RunContext& ctx = {});

/// The same with the best site of the sample for every site, exhaustively: a measure that asks no method
/// where its relief came from.
/// @param sample  its displacements are not looked at
/// @par Cost    O(sites * sample's sites * members) at most
ReliefMismatch bestMismatch(const ReliefSites& surface, const ReliefSites& sample,
                            const ReliefDistance& distance, const ReliefNeighbourhoods& neighbourhoods,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
