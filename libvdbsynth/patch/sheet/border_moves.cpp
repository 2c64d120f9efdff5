#include "libvdbsynth/patch/sheet/border_moves.h"

#include "libvdbsynth/points/point_cells.h"

#include <cstdint>

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

}  // namespace vdbsynth
