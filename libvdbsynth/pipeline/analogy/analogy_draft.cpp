// What an analogy searches, at the target's resolution or, for a draft, half of it.
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/vdb/bricks.h"

#include <utility>

namespace vdbsynth {

std::vector<PairFields> halvedPairs(const std::vector<PairFields>& fields, const RunContext& ctx) {
    std::vector<PairFields> halved;
    for (PairFields pair : fields) {
        pair.plain = std::make_shared<const BrickField>(scaledField(*pair.plain, 0.5, ctx));
        pair.textured = std::make_shared<const BrickField>(scaledField(*pair.textured, 0.5, ctx));
        pair.inner = pair.plain->box();
        pair.place.step *= 2;
        halved.push_back(std::move(pair));
    }
    return halved;
}

std::shared_ptr<const BrickField> halvedTarget(const LevelSet& target, const IndexBox& box,
                                               const CutFaces& cut, float band, const RunContext& ctx) {
    const KnownBand known = gatherKnownBand(*target.grid, box, cut, 2 * reachToWiden(band / 2), ctx);
    return std::make_shared<const BrickField>(widenBandCoarse(known, band / 2, ctx));
}

VolumeAnalogyResult refinedDraft(const VolumeAnalogyResult& draft, const IndexBox& target) {
    VolumeAnalogyResult result;
    result.levels = draft.levels;
    for (const DepthRun& run : draft.depths) result.depths.push_back({2 * run.from, run.full});
    for (std::size_t i = 0; i < draft.sources.size(); ++i) {
        const Source& coarse = *draft.sources.strongest(i);
        const Affine back = rotationMatrix(cast<double>(coarse.rotation) * -1.0);
        const Index3 first = draft.sources.voxels()[i] * 2;
        forEachVoxel(IndexBox{first, first + Index3{1, 1, 1}}.intersection(target), [&](const Index3& p) {
            const Index3 corner = p - first;
            const Vec3d offset = Vec3d{corner.x - 0.5, corner.y - 0.5, corner.z - 0.5} * 0.5;
            Source source = coarse;
            source.position = coarse.position + transformed(back, offset);
            result.sources.add(p, source);
        });
    }
    return result;
}

}  // namespace vdbsynth
