#include "libvdbsynth/vdb/read/level_set_repair.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/read/band_contacts.h"
#include "libvdbsynth/vdb/read/field_kind.h"
#include "libvdbsynth/vdb/read/inactive_regions.h"
#include "libvdbsynth/vdb/read/level_set_repair_steps.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr double kNarrowest = 1.4999;  // [voxels]
constexpr double kFewContacts = 1e-4;  // share of the outside's contacts that gaps of the band explain

// change(value, active) for all values but the background. It returns the new value and may change the state.
template <typename Change>
void changeValues(openvdb::FloatGrid& grid, const RunContext& ctx, const Change& change) {
    std::vector<Leaf*> leaves;
    grid.tree().getNodes(leaves);
    parallelFor(ctx, leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
                bool active = leaves[i]->isValueOn(n);
                const float value = change(leaves[i]->getValue(n), active);
                active ? leaves[i]->setValueOn(n, value) : leaves[i]->setValueOff(n, value);
            }
    });
    openvdb::FloatTree::ValueAllIter tile = grid.tree().beginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        bool active = tile.isValueOn();
        tile.setValue(change(*tile, active));
        tile.setActiveState(active);
    }
}

void setBackground(openvdb::FloatGrid& grid, float value) {
    grid.tree().root().setBackground(value, /* updateChildNodes= */ false);
}

class Repair {
public:
    Repair(const FloatGridPtr& grid, const RunContext& ctx) : mContext(ctx), mSize(grid->voxelSize()) {
        mResult.field = grid;
        if (const FloatGridPtr whole = withSurfaceVoxels(*grid)) {
            mResult.field = whole;
            mCopied = true;
        }
        mFit = distanceFitOf(field(), ctx);
        mResult.halfWidth = kHalfWidth;
        mUniform = std::abs(mSize[0] - mSize[1]) <= 1e-6 * mSize[0] &&
                   std::abs(mSize[0] - mSize[2]) <= 1e-6 * mSize[0];
    }

    RepairedField run() {
        repairUnit();
        BandContacts contacts = bandContactsOf(field(), 1.5 * mUnit, mContext);
        if (contacts.jumps > 0 || field().background() <= 0) {
            repairSigns(contacts);
            if (!mResult.measureAnew) contacts = bandContactsOf(field(), 1.5 * mUnit, mContext);
        }
        if (!mResult.measureAnew && mUniform) repairBand(contacts);
        // Voxels that are no cubes are resampled anyway.
        if (mWidthUnknown && !mUniform) mResult.measureAnew = true;
        return mResult;
    }

private:
    const openvdb::FloatGrid& field() const { return *mResult.field; }

    // A copy at the first change.
    openvdb::FloatGrid& changing() {
        if (!mCopied) mResult.field = mResult.field->deepCopy();
        mCopied = true;
        return *mResult.field;
    }

    void say(const std::string& text) { mResult.said.push_back(text); }

    // Distances in voxels become those in world units; where they are neither, only the zero level counts.
    void repairUnit() {
        const double voxel = std::max({mSize[0], mSize[1], mSize[2]});
        if (mFit.inVoxels() && mUniform) {
            const float scale = float(voxel);
            changeValues(changing(), mContext, [scale](float value, bool&) { return value * scale; });
            setBackground(changing(), field().background() * scale);
            say("its distances are in voxels, taken times the voxel size");
        }
        const bool fits = mFit.measured == 0 || mFit.inWorldUnits() || mFit.inVoxels();
        if (!fits && (mFit.slope < 0.6 || mFit.slope > 1.6)) {
            say("its values grow by " + roundedText(mFit.slope, 3) +
                " per unit away from the surface, so they are no distances; measured anew");
            mResult.measureAnew = true;
        }
        mUnit = voxel * (fits || !(mFit.slope > 0) ? 1 : mFit.slope);
    }

    void turn() {
        changeValues(changing(), mContext, [](float value, bool&) { return 0 - value; });
        setBackground(changing(), 0 - field().background());
        say("its signs are turned (positive inside); turned back");
    }

    void repairSigns(const BandContacts& contacts) {
        bool believed = field().background() != 0;
        auto regions = std::make_unique<InactiveRegions>(field().tree(), believed, mContext);
        // Signs that contradict each other away from the band: regions are told by their connections alone.
        const bool outsideUnvoted = regions->outside().negative + regions->outside().positive == 0;
        if (believed && (regions->hasUnvoted() || (outsideUnvoted && field().background() < 0))) {
            believed = false;
            regions = std::make_unique<InactiveRegions>(field().tree(), believed, mContext);
        }
        InactiveRegions::Votes out = regions->outside();
        const double share = double(out.negative) / std::max(1.0, double(out.negative + out.positive));
        const std::size_t agreeing = contacts.inside.voxels + contacts.outside.voxels;
        mTurned = field().background() > 0 ? share >= 0.97 && 2 * contacts.jumps >= agreeing
                                           : share >= 0.97 || (field().background() < 0 && share > 0.5);
        mTurned = mTurned && rangeOf(field()).maximum > 0;
        if (mTurned) {
            turn();
            std::swap(out.negative, out.positive);
        }
        if (!(field().background() > 0) || double(field().background()) > 1000 * mUnit) {
            say("its background of " + roundedText(double(field().background()), 4) +
                " is no distance; what lies beyond its voxels is outside");
            mWidthUnknown = true;
        }
        const bool known = believed && field().background() > 0;
        // The outside touches the inside: a cut may have opened it, so regions end where the voxels end. Even
        // a few, as one solid of many may be cut.
        if (double(out.negative) > kFewContacts * double(out.negative + out.positive)) {
            fence(known);
            regions = std::make_unique<InactiveRegions>(field().tree(), known, mContext);
            mTurned = false;
        }
        const std::uint64_t mixed = regions->minorities();
        const bool filled = writeSigns(*regions, known);
        if (!closeCuts() && filled)
            say("its inside was marked as outside; filled from the signs of its band");
        if (double(mixed) > 0.01 * double(agreeing + contacts.jumps))
            say("its band has gaps, where inside and outside are guessed from the voxels around");
    }

    // A fence around all active voxels, and around the inactive inside where that is known.
    void fence(bool known) {
        openvdb::CoordBBox box = field().evalActiveVoxelBoundingBox();
        if (known)
            for (auto it = field().cbeginValueOff(); it; ++it)
                if (*it < 0) box.expand(it.getBoundingBox());
        box.expand(1);
        const openvdb::Coord size = box.dim();
        requireMemory(
            mContext,
            200 * (double(size[0]) * size[1] + double(size[1]) * size[2] + double(size[2]) * size[0]),
            "closing a level set that is cut open", "use larger voxels");
        for (int face = 0; face < 6; ++face) {
            openvdb::CoordBBox side = box;
            (face % 2 ? side.min() : side.max())[face / 2] = (face % 2 ? box.max() : box.min())[face / 2];
            mFence.push_back(side);
            changing().sparseFill(side, std::numeric_limits<float>::infinity(), /* active= */ true);
        }
    }

    // Which sign each region has by the voxels around it.
    bool isInside(const InactiveRegions& regions, int region, bool stored) const {
        if (regions.isOutside(region)) return false;
        InactiveRegions::Votes votes = regions.votes(region);
        if (mTurned) std::swap(votes.negative, votes.positive);
        return votes.negative == votes.positive ? stored : votes.negative > votes.positive;
    }

    // True where an inside that was known to be outside was filled.
    bool writeSigns(const InactiveRegions& regions, bool believed) {
        const bool unknown = mResult.measureAnew || mWidthUnknown;
        const float width = unknown ? float(double(kHalfWidth) * mUnit) : field().background();
        std::uint64_t filled = 0, emptied = 0;
        openvdb::FloatGrid& grid = changing();
        const openvdb::tree::ValueAccessor<const openvdb::Int32Tree> labels(regions.labels());
        for (auto it = grid.tree().beginValueOff(); it; ++it) {
            const bool stored = believed && *it < 0;
            const bool inside = isInside(regions, regions.find(labels.getValue(it.getCoord())), stored);
            const std::uint64_t voxels = it.getVoxelCount();
            if (inside && !(*it < 0)) filled += voxels;
            if (!inside && stored) emptied += voxels;
            // The widths of a sound band stay, which may be two.
            const bool keeps = !unknown && (*it < 0) == inside && *it != 0;
            if (!keeps) it.setValue(inside ? -width : width);
        }
        for (const openvdb::CoordBBox& side : mFence) grid.sparseFill(side, width, /* active= */ false);
        setBackground(grid, width);
        if (emptied > 0) say("voxels outside were marked as inside; emptied by the signs of its band");
        return filled > 0 && believed;
    }

    bool closeCuts() {
        const ClosedCuts closed = closedCuts(changing(), mUnit, mContext);
        if (closed.names.empty()) return false;
        mResult.cut = closed.planes;
        const bool flat = std::count(closed.planes.begin(), closed.planes.end(), true) > 0;
        say("its solid is cut open at " + closed.names + "; closed flat there" +
            (flat ? ", and taken as a piece of a larger solid, whose domain ends there" : ""));
        const double present = double(field().background()) / mUnit;
        if (!mResult.measureAnew && !mWidthUnknown && present >= kNarrowest && present <= 100)
            mResult.halfWidth = float(present);
        mResult.measureAnew = true;
        return true;
    }

    // A band ends early where voxels have neighbours beyond it that are nearer to the surface than it says.
    static bool endsEarly(const BandContacts& contacts) {
        const auto early = [](const BandSide& side) {
            return side.early >= 8 && double(side.early) > 0.05 * double(side.voxels);
        };
        return early(contacts.outside) || early(contacts.inside);
    }

    void repairBand(const BandContacts& contacts) {
        const double width = double(field().background()), voxels = width / mUnit;
        const ValueRange range = rangeOf(field());
        if (mWidthUnknown) {
            cutToKnown(range);
        } else if (voxels < kNarrowest) {
            mResult.measureAnew = true;
            say("its band of " + roundedText(voxels, 3) +
                " voxels a side is under 1.5; measured anew with 3");
        } else if (endsEarly(contacts)) {
            cutToKnown(range);
            say("its background says a band of " + roundedText(voxels, 3) +
                " voxels a side, its distances end earlier; " +
                (mResult.measureAnew ? "measured anew with 3"
                                     : "cut to " + roundedText(halfWidthOf(field()), 3)));
        } else if (std::min(range.minimum, contacts.deepest) < -1.001 * width ||
                   std::max(range.maximum, contacts.farthest) > 1.001 * width) {
            trim(float(std::min(width, double(kHalfWidth) * mUnit)));
            say("its distances go on beyond its background; cut to " + roundedText(halfWidthOf(field()), 3) +
                " voxels on both sides");
        }
    }

    // Good distances stay, as far as they reach on both sides but not beyond the usual band; else anew.
    void cutToKnown(const ValueRange& range) {
        const double width = std::min({double(kHalfWidth) * mUnit, range.maximum, -range.minimum});
        mResult.measureAnew = !(mFit.inWorldUnits() || mFit.inVoxels()) || width < 1.5 * mUnit;
        if (mResult.measureAnew) return;
        trim(float(width));
        mResult.measureAnew = endsEarly(bandContactsOf(field(), 1.5 * mUnit, mContext));
    }

    void trim(float width) {
        changeValues(changing(), mContext, [width](float value, bool& active) {
            active = active && value > -width && value < width;
            return active ? value : value < 0 ? -width : width;
        });
        setBackground(changing(), width);
        openvdb::tools::pruneLevelSet(changing().tree());
    }

    const RunContext& mContext;
    DistanceFit mFit;
    const openvdb::Vec3d mSize;
    bool mUniform = true, mCopied = false, mTurned = false, mWidthUnknown = false;
    std::vector<openvdb::CoordBBox> mFence;
    double mUnit = 1;  // what a voxel is in the field's values
    RepairedField mResult;
};

}  // namespace

RepairedField repairedField(const FloatGridPtr& grid, const RunContext& ctx) {
    return Repair(grid, ctx).run();
}

}  // namespace vdbsynth
