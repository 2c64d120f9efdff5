#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"

#include <functional>
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
    double detail;            ///< radius of the finest rounding that is part of its look [features]

    /// A sheet along x and y; the others fill space.
    bool isSheet() const { return heightInFeatures > 0; }
};

const std::vector<ExemplarKind>& exemplarKinds();

/// The kind of this name. @throw Error InvalidOption, which names all
const ExemplarKind& exemplarKind(const std::string& name);

inline constexpr float kExemplarLimit = 4.f;
inline constexpr int kExemplarMargin = 6;

/// How far beyond its domain and how finely an exemplar is sampled. The geometry stays as it is,
/// but of balls and foam, which are packed anew in a larger box.
struct ExemplarSampling {
    Index3 margin{kExemplarMargin, kExemplarMargin, kExemplarMargin};  ///< [voxels] beyond the domain, at
                                                                       ///< least kExemplarMargin
    int fine = 1;                                                      ///< samples along a voxel's side, 1..8
};

struct ExemplarField {
    BrickField field;   ///< distances [samples], clamped to +-kExemplarLimit, over `domain` enlarged by the
                        ///< margin; sample i * fine is the middle of voxel i
    IndexBox domain;    ///< [voxels] begins at 0; the solid is not yet clipped to it
    int fine = 1;       ///< samples along a voxel's side; 1 of kinds that are no unions of simple shapes
    bool exact = true;  ///< false: only the zero level is valid, distances must still be computed
    /// The surface between samples: of a place [voxels] about its distance [voxels], negative inside, right
    /// where it is zero and in its gradient's direction there; empty of foam. May be called from many
    /// threads.
    std::function<double(const Vec3d&)> surface;
};

/// @throw Error InvalidOption (unknown kind, a field out of its range)
void validate(const ExemplarOptions& options);

/// @throw Error InvalidOption (unknown kind, size or feature out of range), Cancelled
/// @par Repeats same bits for (options, ctx.seed), any number of threads
ExemplarField makeExemplar(const ExemplarOptions& options, const RunContext& ctx = {});
/// The same with more around it, or sampled more finely.
/// @throw Error as makeExemplar; InvalidOption (a field of `sampling` out of its range)
ExemplarField makeExemplar(const ExemplarOptions& options, const ExemplarSampling& sampling,
                           const RunContext& ctx);

}  // namespace vdbsynth
