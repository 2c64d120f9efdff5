#include "libvdbsynth/patch/sheet/border_moves.h"

#include "libvdbsynth/patch/sheet/compact_warp.h"
#include "libvdbsynth/points/point_cells.h"

#include <cstdint>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::size_t kWanted = 192;  // centres of a warp, at most

// Places kept apart from each other.
class Spread {
public:
    explicit Spread(double apart) : mApart(apart), mCells(apart) {}

    bool add(const Vec3d& place) {
        if (mCells.anyNear(place,
                           [&](std::uint32_t other) { return length(mPlaces[other] - place) < mApart; }))
            return false;
        mCells.add(place, std::uint32_t(mPlaces.size()));
        mPlaces.push_back(place);
        return true;
    }

private:
    double mApart;
    PointCells mCells;
    std::vector<Vec3d> mPlaces;
};

}  // namespace

BorderMoves spreadMoves(const BorderMoves& found, double apart) {
    for (;; apart *= 1.3) {
        Spread spread(apart);
        BorderMoves kept;
        for (std::size_t c = 0; c < found.centres.size(); ++c)
            if (spread.add(found.centres[c])) {
                kept.centres.push_back(found.centres[c]);
                kept.moves.push_back(found.moves[c]);
            }
        if (kept.centres.size() <= kWanted) return kept;
    }
}

BorderWarp warpAtBorders(const BorderMoves& moves, double radius, const std::vector<Vec3d>& places) {
    BorderWarp result;
    CompactWarp warp(radius > 0 ? moves.centres : std::vector<Vec3d>{},
                     radius > 0 ? moves.moves : std::vector<Vec3d>{}, radius > 0 ? radius : 1);
    const bool any = !warp.empty();
    CompactWarp::Unfolded unfolded = warp.unfold(places);
    result.places = std::move(unfolded.places);
    if (!any) return result;
    result.shrunk = unfolded.factor < 1;
    result.warped = !warp.empty();
    result.centres = moves.centres.size();
    for (std::size_t c = 0; c < moves.centres.size(); ++c) {
        const Vec3d moved = warp.at(moves.centres[c]).place - moves.centres[c];
        result.before += 2 * length(moves.moves[c]);
        result.after += 2 * length(moves.moves[c] - moved);
    }
    return result;
}

}  // namespace vdbsynth
