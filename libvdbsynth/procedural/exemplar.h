#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// Procedural exemplars: textures of geometry whose process can be sampled again with another seed.
/// All lengths are voxels; the domain begins at 0.
struct ExemplarOptions {
    std::string kind;      ///< one of exemplarKinds()
    Index3 size{0, 0, 0};  ///< domain [voxels], each side 8..4096; 0: the kind's default for `resolution`
    int resolution = 64;   ///< longest side of the domain if `size` is 0, 16..4096
    /// Typical feature [voxels], 4..256; 0: the kind's default. A larger domain holds more features.
    double feature = 0;
};

struct ExemplarKind {
    std::string name, summary;
    double feature;           ///< default feature [voxels]
    double heightInFeatures;  ///< z side of the default domain in features; 0: as long as x and y
};

const std::vector<ExemplarKind>& exemplarKinds();

struct ExemplarField {
    BrickField field;   ///< distances [voxels], clamped to +-kExemplarLimit, over `domain` enlarged by
                        ///< kExemplarMargin
    IndexBox domain;    ///< begins at 0; the solid is not yet clipped to it
    bool exact = true;  ///< false: only the zero level is valid, distances must still be computed
};

inline constexpr float kExemplarLimit = 4.f;
inline constexpr int kExemplarMargin = 6;

/// @throw Error InvalidOption (unknown kind, a field out of its range)
void validate(const ExemplarOptions& options);

/// @throw Error InvalidOption (unknown kind, size or feature out of range), Cancelled
/// @par Repeats same bits for (options, ctx.seed), any number of threads
ExemplarField makeExemplar(const ExemplarOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
