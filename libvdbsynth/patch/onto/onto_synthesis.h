#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/onto/onto_arrangement.h"
#include "libvdbsynth/patch/onto/onto_points.h"
#include "libvdbsynth/patch/patch_exemplar.h"

namespace vdbsynth {

/// How an exemplar is laid over a surface; fields of the same name are those of PatchOptions.
struct OntoOptions {
    double patch = 0;    ///< [world] side of the square that a round patch has the area of; 0: found
    double overlap = 0;  ///< 0.05..0.8; 0: a quarter
    double tolerance = 0.1;
    double step = 0;  ///< [spacings] 0.5..64; 0: as fieldStep
    int repairs = 2;  ///< 0..20
    bool warp = true;
    bool blend = true;
    double scale = 1;         ///< 0.001..1000: 2 makes the exemplar twice as large
    double heightOffset = 0;  ///< [world] outward from where the exemplar's middle height lies on the surface
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const OntoOptions& options);

/// The exemplar `scale` times as large, its corner where it was.
PatchExemplar scaledExemplar(const PatchExemplar& exemplar, double scale);

/// [world] How far apart the surface's sites should be at least, for a step of the field each on average.
/// @param exemplar  scaled
double siteSpacing(const PatchExemplar& exemplar, const OntoOptions& options);

struct OntoResult {
    SheetPoints sheet;  ///< places as the surface's sites
    OntoArrangement arrangement;
    double patch = 0, overlap = 0, step = 0;  ///< [world] as used; of the patch the diameter
    double zero = 0;  ///< [world] plane space, the height that lies on the surface itself
    std::size_t patches = 0;
    BorderStats borders;
    OntoBend bend;
    double search = 0, warp = 0, other = 0;  ///< [s] where the time went; does not repeat
};

/// An exemplar's geometry over a surface, patch by patch, on its points: layOntoSurface, then ontoPoints. The
/// exemplar is flat, so its heights stand along the surface's normals.
/// @param exemplar  scaled   @param surface  its sites siteSpacing apart
/// @throw Error as validate; Unusable (an exemplar too small for a patch), Memory, Cancelled
/// @par Cost    about as synthesizePatches for the same area
/// @par Repeats same bits for any number of threads
OntoResult synthesizeOnto(const PatchExemplar& exemplar, const OntoSurface& surface,
                          const OntoOptions& options, const RunContext& ctx = {});

/// The points of an arrangement that is known already, of its own exemplar bit for bit, or of another one.
/// @param arrangement  its disks need only a centre; they are made again
/// @param zero     OntoResult::zero   @param options  warp and blend are read
/// @throw Error ShapeMismatch (an exemplar of another height, centres or labels beyond the surface, a site
/// beyond its patch's disk), Memory, Cancelled
/// @par Repeats same bits for any number of threads
OntoResult repeatOnto(const PatchExemplar& exemplar, const OntoSurface& surface, OntoArrangement arrangement,
                      double zero, const OntoOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
