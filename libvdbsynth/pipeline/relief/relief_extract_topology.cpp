// Whether a base has the scan's components and tunnels.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/measure/functionals.h"
#include "libvdbsynth/pipeline/relief/relief_extract_steps.h"

#include <cmath>

namespace vdbsynth {
namespace {

SurfaceCounts countsOf(const BrickField& field, bool whole, const RunContext& ctx) {
    const Occupancy solid = Occupancy::fromField(field, ctx);
    SurfaceCounts counts;
    counts.solids = findComponents(solid, Neighbours::All).sizes.size();
    counts.voids = findComponents(solid.complement(), Neighbours::Faces).interior.size();
    if (whole)
        counts.tunnels =
            std::lround(double(counts.solids + counts.voids) - eulerCharacteristic(solid, Beyond::Void));
    return counts;
}

std::string difference(const char* what, long scan, long base) {
    return scan == base
               ? ""
               : std::string(", ") + what + " " + std::to_string(scan) + " to " + std::to_string(base);
}

}  // namespace

void compareTopology(ReliefExtraction& result, const RunContext& ctx) {
    result.scanCounts = countsOf(result.fields.scan, !result.recorded, ctx);
    result.baseCounts = countsOf(result.fields.distance, !result.recorded, ctx);
    const SurfaceCounts &scan = result.scanCounts, &base = result.baseCounts;
    const std::string changed = difference("solid parts", long(scan.solids), long(base.solids)) +
                                difference("enclosed voids", long(scan.voids), long(base.voids)) +
                                difference("tunnels", scan.tunnels, base.tunnels);
    if (!changed.empty())
        message(ctx, MessageLevel::Warning,
                "the base is not of the scan's topology (" + changed.substr(2) +
                    "): a smaller `baseRadius` than " + roundedText(result.radius, 4) +
                    " or more voxels keep it");
}

}  // namespace vdbsynth
