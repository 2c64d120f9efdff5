// Input of analogy: models as fields of distances over one box.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

// The box without what lies beyond a model's domain at its cut faces.
IndexBox knownPart(const LevelSet& model, const CutFaces& cut, IndexBox box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = int(axis);
        if (cut[2 * axis]) box.min[a] = std::max(box.min[a], model.domain.min[a]);
        if (cut[2 * axis + 1]) box.max[a] = std::min(box.max[a], model.domain.max[a]);
    }
    return box;
}

// A field over a larger box, where the solid that it ends in gets deeper by a voxel each voxel.
BrickField deepened(const BrickField& known, const Index3& before, const Index3& size,
                    const RunContext& ctx) {
    if (known.box().size() == size) return known;
    return BrickField::fromVoxels(IndexBox::fromSize(size), ctx, [&](const Index3& p) {
        const Index3 inside = p - before;
        Index3 nearest = inside;
        int beyond = 0;
        for (int axis = 0; axis < 3; ++axis) {
            nearest[axis] = std::clamp(inside[axis], 0, known.box().max[axis]);
            beyond = std::max(beyond, std::abs(inside[axis] - nearest[axis]));
        }
        return std::max(known.inside(nearest) - float(beyond), -float(kMostReach));
    });
}

// True if a face's whole layer is in the solid, deeper than what is read at a voxel there.
bool inSolid(const BrickField& field, int axis, bool high) {
    constexpr float kDeep = -1.5f;
    IndexBox layer = field.box();
    (high ? layer.min : layer.max)[axis] = (high ? layer.max : layer.min)[axis];
    std::vector<float> values(std::size_t(layer.volume()));
    field.readBox(layer.min, layer.size(), values.data());
    return std::all_of(values.begin(), values.end(), [](float d) { return d <= kDeep; });
}

// A slab's underside is a cut far from its texture. The solid is made to continue below it, for otherwise the
// margin of neighbourhoods would take the texture's lowest layers from what can be copied.
IndexBox deepenedBox(const IndexBox& box, const CutFaces& cut, const BrickField& plain,
                     const BrickField& textured) {
    IndexBox deep = box;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true})
            if (cut[std::size_t(2 * axis + int(high))] && inSolid(plain, axis, high) &&
                inSolid(textured, axis, high))
                (high ? deep.max : deep.min)[axis] += high ? kMostReach : -kMostReach;
    return deep;
}

}  // namespace

BrickField scaledField(const BrickField& field, double scale, const RunContext& ctx) {
    const Index3 size = field.box().size();
    Index3 to;
    for (int axis = 0; axis < 3; ++axis) to[axis] = std::max(1, int(std::lround(size[axis] * scale)));
    const float back = float(1 / scale);
    return BrickField::generate(IndexBox::fromSize(to), ctx, [&](const IndexBox& brick, float* samples) {
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const Index3 p = brick.min + Index3{i >> 6, (i >> 3) & 7, i & 7};
            samples[i] = sampleTrilinear(field, {float(p.x) * back, float(p.y) * back, float(p.z) * back}) *
                         float(scale);
        }
    });
}

void requireOnePlace(const AnalogyModelPair& pair) {
    const auto& a = pair.plain->grid->transform();
    const auto& b = pair.textured->grid->transform();
    if (!(a == b))
        throw Error(ErrorCode::ShapeMismatch,
                    "the two models of the pair must have the same voxels in the same place: voxel sizes " +
                        std::to_string(voxelSizeOf(*pair.plain->grid)) + " and " +
                        std::to_string(voxelSizeOf(*pair.textured->grid)) +
                        "; convert both with the same `voxelSize`");
}

BrickField gatherTextured(const LevelSet& textured, const IndexBox& box, const CutFaces& cut, float reach,
                          double scale, const RunContext& ctx) {
    const IndexBox known = knownPart(textured, cut, box);
    const BrickField field = deepened(gatherWideBand(*textured.grid, known, cut, reach, ctx),
                                      known.min - box.min, box.size(), ctx);
    return scale == 1 ? field : scaledField(field, scale, ctx);
}

float reachOf(const BrickField& plain, const BrickField& textured) {
    float reach = 0;
    std::vector<float> a(std::size_t(plain.box().size().z)), b(a.size());
    for (int x = 0; x <= plain.box().max.x; ++x)
        for (int y = 0; y <= plain.box().max.y; ++y) {
            plain.readBox({x, y, 0}, {1, 1, plain.box().size().z}, a.data());
            textured.readBox({x, y, 0}, {1, 1, plain.box().size().z}, b.data());
            for (std::size_t z = 0; z < a.size(); ++z)
                if (std::abs(b[z]) < 1) reach = std::max(reach, std::abs(a[z]));
        }
    return reach;
}

PairFields gatherPair(const AnalogyModelPair& pair, double scale, const RunContext& ctx) {
    const CutFaces cutPlain = facesTouched(*pair.plain), cutTextured = facesTouched(*pair.textured);
    CutFaces cut;
    for (std::size_t f = 0; f < cut.size(); ++f) cut[f] = cutPlain[f] || cutTextured[f];
    IndexBox domain = pair.plain->domain;
    const IndexBox& other = pair.textured->domain;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = int(axis);
        domain.min[a] =
            cut[2 * axis] ? std::max(domain.min[a], other.min[a]) : std::min(domain.min[a], other.min[a]);
        domain.max[a] =
            cut[2 * axis + 1] ? std::min(domain.max[a], other.max[a]) : std::max(domain.max[a], other.max[a]);
    }
    if (domain.empty())
        throw Error(ErrorCode::ShapeMismatch, "the two models of the pair do not overlap: domains " +
                                                  boxText(pair.plain->domain) + " and " + boxText(other));
    PairFields fields;
    fields.box = grownBox(domain, cut, kMostReach);
    requireMemory(ctx, double(fields.box.volume()) * 12, "the pair", "use larger voxels or crop the pair");
    constexpr float kFaces = 3;  // [voxels] reach that says whether a face is in the solid
    const auto gathered = [&](const LevelSet& model, const CutFaces& faces, float reach, double by) {
        return std::make_shared<const BrickField>(gatherTextured(model, fields.box, faces, reach, by, ctx));
    };
    if (std::find(cut.begin(), cut.end(), true) != cut.end())
        fields.box = deepenedBox(fields.box, cut, *gathered(*pair.plain, cutPlain, kFaces, 1),
                                 *gathered(*pair.textured, cutTextured, kFaces, 1));
    fields.plain = gathered(*pair.plain, cutPlain, float(kMostReach), scale);
    fields.textured = gathered(*pair.textured, cutTextured, float(kMostReach), scale);
    fields.cutTextured = cutTextured;
    fields.inner = fields.plain->box();
    fields.place = {pair.plain->grid.get(),
                    {double(fields.box.min.x), double(fields.box.min.y), double(fields.box.min.z)},
                    1 / scale};
    return fields;
}

}  // namespace vdbsynth
