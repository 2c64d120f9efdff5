#pragma once
#include "libvdbsynth/patch/patch_exemplar.h"
#include "libvdbsynth/patch/patch_field.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "tests/support/point_shapes.h"

#include <array>
#include <functional>

// Small exemplars of the room patch.
namespace vdbsynth::test {

/// The height field z = height sin(2 pi x / period) sin(2 pi y / period).
struct EggCrate {
    double period = 16, height = 2;

    double at(double x, double y) const {
        return height * sine(2 * kPi * x / period) * sine(2 * kPi * y / period);
    }
    /// dz/dx, dz/dy.
    Vec3d slope(double x, double y) const {
        const double w = 2 * kPi / period;
        return {height * w * cosine(w * x) * sine(w * y), height * w * sine(w * x) * cosine(w * y), 0};
    }
    Vec3d normal(double x, double y) const {
        const Vec3d s = slope(x, y);
        return normalized(Vec3d{-s.x, -s.y, 1});
    }
};

/// Points of the height field over [-margin, side + margin)^2, a unit apart, each moved at random by up to
/// `jitter` along both axes; exact normals.
inline PointShape eggCratePoints(const EggCrate& crate, int side, int margin, double jitter = 0.2) {
    PointShape shape;
    for (int i = -margin; i < side + margin; ++i)
        for (int j = -margin; j < side + margin; ++j) {
            Random random(11, std::uint64_t(std::uint32_t(i)) << 32 | std::uint32_t(j));
            const double x = i + 0.5 + random.uniform(-jitter, jitter),
                         y = j + 0.5 + random.uniform(-jitter, jitter);
            shape.point.push_back(cast<float>(Vec3d{x, y, crate.at(x, y)}));
            shape.normal.push_back(cast<float>(crate.normal(x, y)));
        }
    return shape;
}

/// A texture of points a unit apart, its box [0, side]^2.
inline PatchExemplar exemplarOf(const PointShape& shape, double side, double low = -4, double high = 4) {
    return patchExemplar(shape.point, shape.normal, {{0, 0, low}, {side, side, high}}, PatchPlane::XY, 1);
}

inline PatchExemplar eggCrateExemplar(const EggCrate& crate, int side, int margin = 8) {
    return exemplarOf(eggCratePoints(crate, side, margin), side, -crate.height - 2, crate.height + 2);
}

/// Rings of radius 5 and tube 1 that lie flat on a lattice of 16, points a unit apart.
inline PointShape ringSheet(int rings) {
    const PointShape ring = ringTorus(5, 1.2);
    PointShape shape;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < rings; ++j) {
            PointShape moved = ring;
            for (Vec3f& p : moved.point) p = p + Vec3f{8.f + 16.f * float(i), 8.f + 16.f * float(j), 0};
            shape = joined(shape, moved);
        }
    return shape;
}

/// A field of any values: distance, then gradient.
using NodeValues = std::array<float, kFieldValues>;
inline PatchField patchFieldFrom(const PatchLattice& lattice,
                                 const std::function<NodeValues(int i, int j, int k)>& values) {
    PatchField field{lattice, {}};
    for (int i = 0; i < lattice.nx; ++i)
        for (int j = 0; j < lattice.ny; ++j)
            for (int k = 0; k < lattice.nz; ++k) {
                const NodeValues node = values(i, j, k);
                field.values.insert(field.values.end(), node.begin(), node.end());
            }
    return field;
}

/// Independent random values, distances in [-3, 3).
inline PatchField noisePatchField(const PatchLattice& lattice, std::uint64_t seed) {
    return patchFieldFrom(lattice, [&](int i, int j, int k) {
        Random random(seed, (std::uint64_t(i) * 1000 + std::uint64_t(j)) * 1000 + std::uint64_t(k));
        NodeValues node;
        node[0] = float(random.uniform(-3, 3));
        for (int axis = 1; axis < kFieldValues; ++axis)
            node[std::size_t(axis)] = float(random.uniform(-1, 1));
        return node;
    });
}

inline PatchField measuredField(const PatchExemplar& exemplar, double step,
                                PointSetKind kind = PointSetKind::Apss) {
    PointSetSurfaceOptions options;
    options.kind = kind;
    options.kernel = exemplar.kernel;
    const PointSetSurface surface(exemplar.points, exemplar.normals, options);
    return patchField(surface, exemplar.points, latticeOf(exemplar.size, step), {});
}

}  // namespace vdbsynth::test
