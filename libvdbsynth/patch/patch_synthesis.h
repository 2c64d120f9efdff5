#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_arrangement.h"
#include "libvdbsynth/patch/patch_exemplar.h"
#include "libvdbsynth/patch/scanline/point_pairing.h"
#include "libvdbsynth/patch/sheet/sheet_points.h"

#include <optional>

namespace vdbsynth {

/// How patches come together: placed, cut, warped along the cuts and blended; or as published.
enum class PatchMethod { Default, Paper };

struct PatchOptions {
    PatchMethod method = PatchMethod::Default;
    double width = 0, depth = 0;  ///< [world] of the sheet along the plane's first and second axis
    /// [world] at least 0: how far the points continue beyond that on all sides. Its outermost 7 spacings
    /// know less of the surface around them.
    double border = 0;
    double patch = 0;        ///< [world] side of a patch; 0: one and a half features (patch_size.h)
    double overlap = 0;      ///< 0.05..0.8 of a patch over earlier ones; 0: a third
    double tolerance = 0.1;  ///< 0..10, e: candidates within (1 + e) of the best are drawn from
    double step = 0;  ///< [spacings] 0.5..64, of the field that patches are compared by; 0: see fieldStep

    // Of the default method.
    bool tile = false;  ///< the sheet continues at its opposite sides; its size is whole steps of the field
    int repairs = 2;    ///< 0..20 rounds in which patches are laid over the worst seams
    bool warp = true;
    bool blend = true;

    // Of the paper's method.
    std::optional<Vec3d> seedPlace;  ///< [world] minimum corner of the first patch, in the exemplar's axes
    std::optional<PairingWeights>
        weights;  ///< none: from the exemplar's own near matches (pairing_weights.h)
    PairingLimits limits;
    int rounds = 3;  ///< 0..20 of pairing again
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PatchOptions& options);

/// [world] The step of the field that patches of an exemplar are compared by: as `step` says, else 2
/// spacings, or more where its box has over 72 of these along its longer side; the paper's have 51 to 84.
double fieldStep(const PatchExemplar& exemplar, const PatchOptions& options);

struct PatchResult {
    SheetPoints sheet;  ///< plane space; the sheet is [0, width) x [0, depth), its border around it
    PatchArrangement arrangement;             ///< of the default method: the source map; else empty
    double patch = 0, overlap = 0, step = 0;  ///< [world] as used
    std::size_t patches = 0;
    BorderStats borders;                                ///< of the default method
    PairingWeights weights;                             ///< of the paper's method, as used
    std::size_t pairs = 0, unwarped = 0;                ///< of the paper's method
    double search = 0, warp = 0, blend = 0, other = 0;  ///< [s] where the time went; does not repeat
};

/// A sheet of an exemplar's geometry, patch by patch, on its points.
///
/// The default places patches by the paper's search, but on the fields of the patches that lie there, cuts
/// them into the sheet (layout/patch_layout.h), then warps and blends along the cuts (sheet/sheet_points.h):
/// the paper's warp and blend have least to do where sides agree, and a cut runs there. The paper's method is
/// in scanline/scanline_patches.h.
/// @throw Error as validate; Unusable (an exemplar too small for a patch), EmptyInput, Memory, Cancelled
/// @par Cost    about 3 microseconds for each point that comes out, on two cores
/// @par Repeats same bits for any number of threads
PatchResult synthesizePatches(const PatchExemplar& exemplar, const PatchOptions& options,
                              const RunContext& ctx = {});

/// The same arrangement of another exemplar of the same box, or of the same one.
/// @throw Error ShapeMismatch (the arrangement's patches reach beyond the exemplar)
/// @par Repeats with the run's own exemplar the same points bit for bit
SheetResult repeatPatches(const PatchExemplar& exemplar, const PatchArrangement& arrangement,
                          const PatchOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
