#include "libvdbsynth/distance/close_band.h"

#include "libvdbsynth/distance/normalize_band.h"
#include "libvdbsynth/distance/rebuild_band.h"

#include <algorithm>
#include <utility>

namespace vdbsynth {

BrickField closedBand(const BrickField& field, const Index3& corner, const CloseOptions& options,
                      const RunContext& ctx) {
    const float limit = options.draft ? options.band : std::max(options.halfWidth, options.band);
    const float unit = options.draft ? 1.f : float(options.voxelSize);
    BrickField closed = closeField(field, field.box(), options.cut, limit, ctx, unit);
    closed.translate(corner);
    if (options.draft) {
        Stage stage(ctx, "normalising the narrow band", 1);
        closed = normalizeBand(std::move(closed), limit, ctx);
        stage.advance();
        return closed;
    }
    RebuildOptions rebuild;
    rebuild.halfWidth = options.halfWidth;
    rebuild.keepDistances = true;
    rebuild.band = options.band;
    rebuild.voxelSize = unit;
    return rebuiltBand(closed, rebuild, ctx);
}

}  // namespace vdbsynth
