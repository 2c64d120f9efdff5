#include "libvdbsynth/map/exemplar_variant.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vdbsynth {
namespace {

constexpr int kMostVariants = 24;
constexpr double kInsideTolerance = 1e-6;  // [voxels] for positions inside the exemplar

std::array<double, 4> quaternionOf(const Vec3d& rotation) {
    const double angle = length(rotation);
    if (angle == 0) return {0, 0, 0, 1};
    const double s = sine(angle / 2) / angle;
    return {rotation.x * s, rotation.y * s, rotation.z * s, cosine(angle / 2)};
}

Vec3d middleOf(const Index3& size) {
    return {(size.x - 1) / 2.0, (size.y - 1) / 2.0, (size.z - 1) / 2.0};
}

// The transform from a variant back to its exemplar, computed once.
class Back {
public:
    Back(const ExemplarVariant& variant, const Index3& exemplarSize)
        : mRotation(rotationMatrix(-variant.rotation)),
          mFrom(middleOf(variant.size)),
          mTo(middleOf(exemplarSize)),
          mShrink(1 / variant.scale) {}
    Vec3d operator()(const Vec3d& p) const { return transformed(mRotation, (p - mFrom) * mShrink) + mTo; }

private:
    Affine mRotation;
    Vec3d mFrom, mTo;
    double mShrink;
};

float trilinear(const BrickField& field, const Vec3d& p) {
    const Index3 low{int(std::floor(p.x)), int(std::floor(p.y)), int(std::floor(p.z))};
    const double f[3] = {p.x - low.x, p.y - low.y, p.z - low.z};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Index3 step{corner >> 2 & 1, corner >> 1 & 1, corner & 1};
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= step[axis] ? f[axis] : 1 - f[axis];
        if (weight != 0) sum += weight * double(field.at(low + step));
    }
    return float(sum);
}

// A field over a variant whose samples are computed from their positions in the exemplar.
template <typename Value>
BrickField throughBack(const ExemplarVariant& variant, const Index3& exemplarSize, const RunContext& ctx,
                       const Value& value) {
    const Back back(variant, exemplarSize);
    return BrickField::fromVoxels(IndexBox::fromSize(variant.size), ctx, [&](const Index3& p) {
        return value(back({double(p.x), double(p.y), double(p.z)}));
    });
}

}  // namespace

Affine rotationMatrix(const Vec3d& rotation) {
    const std::array<double, 4> q = quaternionOf(rotation);
    return vdbsynth::rotation(q[0], q[1], q[2], q[3]);
}

double similarity(const Vec3d& rotation, const Vec3d& other) {
    const std::array<double, 4> a = quaternionOf(rotation), b = quaternionOf(other);
    return std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
}

Index3 variantSize(const Index3& exemplar, const Vec3d& rotation, double scale,
                   const std::array<bool, 3>& grows) {
    const Affine matrix = rotationMatrix(rotation);
    Index3 size = exemplar;
    for (int axis = 0; axis < 3; ++axis) {
        if (!grows[std::size_t(axis)]) continue;
        double extent = 0;
        for (int from = 0; from < 3; ++from)
            extent += std::abs(matrix[std::size_t(from * 4 + axis)]) * exemplar[from];
        size[axis] = std::max(1, int(std::ceil(extent * scale - kInsideTolerance)));
    }
    return size;
}

Vec3d inExemplar(const ExemplarVariant& variant, const Index3& exemplarSize, const Vec3d& p) {
    return Back(variant, exemplarSize)(p);
}

BrickField variantOf(const BrickField& distances, const ExemplarVariant& variant, float limit,
                     const RunContext& ctx) {
    const float scale = float(variant.scale);
    return throughBack(variant, distances.box().size(), ctx, [&](const Vec3d& p) {
        const float value = trilinear(distances, p);
        // Smaller distances that end at the limit only mean that nothing is nearer.
        if (std::abs(value) >= limit * 0.9999f) return value < 0 ? -limit : limit;
        return std::clamp(value * scale, -limit, limit);
    });
}

ExemplarFields variantsOf(const ExemplarFields& exemplars, const std::vector<ExemplarVariant>& variants,
                          float limit, const RunContext& ctx) {
    if (variants.empty()) return exemplars;
    Stage stage(ctx, "rotating and scaling the exemplar", variants.size());
    ExemplarFields fields;
    for (const ExemplarVariant& variant : variants) {
        const auto& from = exemplars[std::size_t(variant.exemplar)];
        const bool same = variant.plain() && variant.size == from->box().size();
        fields.push_back(same ? from
                              : std::make_shared<const BrickField>(variantOf(*from, variant, limit, ctx)));
        stage.advance();
    }
    return fields;
}

BrickField variantOfScalar(const BrickField& scalar, const ExemplarVariant& variant, const RunContext& ctx) {
    return throughBack(variant, scalar.box().size(), ctx,
                       [&](const Vec3d& p) { return trilinear(scalar, p); });
}

BrickField variantMask(const Index3& exemplarSize, const ExemplarVariant& variant, const BrickField* mask,
                       const std::array<bool, 6>& continues, const RunContext& ctx) {
    return throughBack(variant, exemplarSize, ctx, [&](const Vec3d& p) {
        for (int axis = 0; axis < 3; ++axis)
            if ((p[axis] < -kInsideTolerance && !continues[std::size_t(2 * axis)]) ||
                (p[axis] > exemplarSize[axis] - 1 + kInsideTolerance &&
                 !continues[std::size_t(2 * axis + 1)]))
                return 0.f;
        return !mask || trilinear(*mask, p) > 1 - 1e-4f ? 1.f : 0.f;
    });
}

std::array<bool, 6> facesOfOneSide(const BrickField& field, const std::array<bool, 3>& grows) {
    std::array<bool, 6> faces{};
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        if (grows[std::size_t(axis)]) continue;
        IndexBox layer = field.box();
        if (face % 2)
            layer.min[axis] = layer.max[axis];
        else
            layer.max[axis] = layer.min[axis];
        std::vector<float> samples(std::size_t(layer.volume()));
        field.readBox(layer.min, layer.size(), samples.data());
        const auto inside = std::count_if(samples.begin(), samples.end(), [](float v) { return v < 0; });
        faces[std::size_t(face)] = inside == 0 || inside == std::ptrdiff_t(samples.size());
    }
    return faces;
}

int axisOfDrift(const ExemplarVariant& variant, const std::array<bool, 6>& faces,
                const std::array<bool, 3>& grows) {
    const Affine matrix = rotationMatrix(variant.rotation);
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!grows[axis] && !(faces[2 * axis] && faces[2 * axis + 1]) &&
            std::abs(matrix[axis * 5] * variant.scale - 1) >= 1e-9)
            return int(axis);
    return -1;
}

Index3 variantCells(const IndexBox& box) {
    const Index3 size = box.size();
    return {(size.x + kVariantCell - 1) / kVariantCell, (size.y + kVariantCell - 1) / kVariantCell,
            (size.z + kVariantCell - 1) / kVariantCell};
}

BrickField fieldOfNumbers(const std::vector<std::int32_t>& numbers, const IndexBox& box,
                          const RunContext& ctx) {
    const Index3 cells = variantCells(box);
    return BrickField::generate(IndexBox::fromSize(box.size()), ctx,
                                [&](const IndexBox& brick, float* samples) {
                                    forEachVoxel(brick, [&](const Index3& p) {
                                        const Index3 cell{std::min(p.x / kVariantCell, cells.x - 1),
                                                          std::min(p.y / kVariantCell, cells.y - 1),
                                                          std::min(p.z / kVariantCell, cells.z - 1)};
                                        *samples++ = float(numbers[latticeIndex(cell, cells)]);
                                    });
                                });
}

ChosenVariants chooseVariants(const std::vector<WantedVariant>& wanted, const RunContext& ctx) {
    ChosenVariants chosen;
    for (double degrees = 8;; degrees *= 1.25) {
        throwIfCancelled(ctx);
        chosen = {};
        chosen.tolerance = degrees;
        const double leastSimilarity = cosine(degrees * kPi / 360), ratio = 1 + degrees / 96;
        std::vector<int> count;
        for (const WantedVariant& want : wanted) {
            std::int32_t nearest = -1;
            for (std::size_t v = 0; v < chosen.variants.size() && nearest < 0; ++v) {
                const ExemplarVariant& variant = chosen.variants[v];
                if (variant.exemplar == want.exemplar && variant.scale <= want.scale * ratio &&
                    want.scale <= variant.scale * ratio &&
                    similarity(variant.rotation, want.rotation) >= leastSimilarity)
                    nearest = std::int32_t(v);
            }
            if (nearest < 0) {
                nearest = std::int32_t(chosen.variants.size());
                chosen.variants.push_back({want.exemplar, want.rotation, want.scale, {0, 0, 0}});
                count.resize(std::max(count.size(), std::size_t(want.exemplar) + 1), 0);
                if (++count[std::size_t(want.exemplar)] > kMostVariants) break;
            }
            chosen.number.push_back(nearest);
        }
        if (chosen.number.size() == wanted.size()) return chosen;
    }
}

}  // namespace vdbsynth
