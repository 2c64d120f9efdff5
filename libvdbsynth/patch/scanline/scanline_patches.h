#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_exemplar.h"
#include "libvdbsynth/patch/patch_field.h"
#include "libvdbsynth/patch/scanline/point_pairing.h"
#include "libvdbsynth/patch/sheet/sheet_points.h"

#include <optional>

namespace vdbsynth {

class PointSetSurface;

/// The 2006 paper's method. It does not say how wide O_k is; here it is as wide as the margin E. Lengths are
/// in columns of the field.
struct ScanlineOptions {
    int patch = 16;                  ///< side of P, at least 4
    int margin = 4;                  ///< w_E, at least 1, under `patch`: of E, and of the overlap O
    double tolerance = 0.1;          ///< e, 0..10
    std::optional<PatchPlace> seed;  ///< of P_0 in the exemplar; none: drawn
    PairingOptions pairing;
    double clusterVariation = 0.05;  ///< 0..1/3, of the adaptive clusters that are targets of pairs
    int clusterPoints = 24;          ///< 2..10000, the most points of one
    bool relax = true;               ///< even sampling at the end
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const ScanlineOptions& options);

/// Where the time went [s]: the columns of the paper's table.
struct ScanlineSeconds {
    double search = 0, warp = 0, blend = 0, other = 0;
};

struct ScanlineResult {
    SheetPoints sheet;
    std::size_t patches = 0, pairs = 0;  ///< laid; pairs of all their warps
    std::size_t unwarped = 0;            ///< patches with fewer than four pairs
    ScanlineSeconds seconds;
};

/// Patch synthesis on point-set surfaces as published [duranleau2006, section 4], patch by patch in scan-line
/// order:
/// 1. a seed patch with its margin is laid at the corner;
/// 2. D(O_k) of what lies there is measured by projecting nodes on it, candidates are those of
///    patchCandidates, one is drawn by (seed, patch);
/// 3. targets are the clusters of points in O_k, sources the patch's points, a margin more on all sides; they
///    are paired (point_pairing.h), and the patch is warped by the thin-plate spline through the pairs and
///    through the corners of the patch that no overlap reaches, which stay;
/// 4. warped points over O_k move toward their image on what lies there, by a weight that falls from 1 at the
///    overlap's outer edge to 0 at its inner one, smoothly: the image is the nearer hit of the rays along +-n
///    within a margin, else the projection;
/// 5. all points in the box of the patch and its margin are replaced.
/// The sheet is made a margin larger on all sides, which is cut away, and its points are spread evenly.
/// @param field  of the exemplar's points, on the paper's surface, PointSetKind::AdamsonAlexa
/// @param size  [world] of the sheet along x and y, above 0; z: how far its points continue beyond that,
/// which is at most the margin
/// @throw Error as validate; InvalidOption (size), Unusable (a patch larger than the exemplar), Memory,
/// Cancelled
/// @par Cost    patches x (places x overlap + pairs^3 + points)   @par Repeats same bits for any number of
/// threads (`seconds` apart)
ScanlineResult scanlinePatches(const PatchExemplar& exemplar, const PatchField& field, const Vec3d& size,
                               const ScanlineOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
