#include "libvdbsynth/pipeline/analogy.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/measure/crumbs.h"
#include "libvdbsynth/pipeline/analogy_steps.h"
#include "libvdbsynth/pipeline/carry.h"
#include "libvdbsynth/pipeline/control.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace vdbsynth {
namespace {

constexpr float kResultBand = 6;  // [voxels] in which the result's distances are blended
constexpr int kCrumbSide = 4;     // [voxels] parts that fit a cube of this side may be crumbs
constexpr float kMaskBorder = 3;  // [voxels] over which a model's mask fades

DirectionSource directionOfPair(const LevelSet& plain, const DirectionSource& given) {
    if (given.kind != DirectionSource::Kind::Automatic) return given;
    DirectionSource source;
    const auto recorded = plain.grid->getMetadata<openvdb::StringMetadata>(kDirectionKey);
    if (recorded) parseDirection(recorded->value(), source);
    return source;
}

// 0..1 over the target's box.
BrickField weights(const AnalogyOptions& options, const IndexBox& box, const openvdb::FloatGrid& like,
                   const RunContext& ctx) {
    if (!options.mask) return BrickField(IndexBox::fromSize(box.size()), float(options.strength));
    ControlFrame frame;
    frame.box = box;
    frame.like = &like;
    const bool solid = options.mask->getGridClass() == openvdb::GRID_LEVEL_SET;
    const float border = kMaskBorder * float(voxelSizeOf(like));
    const BrickField mask = sampledScalar(*options.mask, frame, "`mask`", ctx);
    return BrickField::generate(mask.box(), ctx, [&](const IndexBox& brick, float* samples) {
        mask.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const float value = solid ? 0.5f - samples[i] / (2 * border) : samples[i];
            samples[i] = float(options.strength) * std::clamp(value, 0.f, 1.f);
        }
    });
}

// The target where the weight is 0, what was made where it is 1, in between their mean.
BrickField blended(const BrickField& target, const BrickField& made, const BrickField& weight,
                   const RunContext& ctx) {
    return BrickField::generate(made.box(), ctx, [&](const IndexBox& brick, float* samples) {
        std::array<float, BrickField::kSamples> plain, share;
        made.readBox(brick.min, brick.size(), samples);
        target.readBox(brick.min, brick.size(), plain.data());
        weight.readBox(brick.min, brick.size(), share.data());
        for (std::size_t i = 0; i < plain.size(); ++i) {
            const float before = std::clamp(plain[i], -kResultBand, kResultBand);
            samples[i] = share[i] == 1 ? samples[i] : before + share[i] * (samples[i] - before);
        }
    });
}

void clean(BrickField& field, const std::vector<PairFields>& pairs, const RunContext& ctx) {
    std::vector<std::shared_ptr<const BrickField>> exemplars;
    for (const PairFields& pair : pairs) exemplars.push_back(pair.textured);
    for (const bool ofVoid : {false, true}) {
        const CrumbLimits limits =
            crumbLimits(exemplars, std::uint64_t(kCrumbSide) * kCrumbSide * kCrumbSide, ofVoid, ctx);
        const std::size_t changed = removeCrumbs(field, limits, ofVoid, ctx);
        message(ctx, MessageLevel::Detail,
                std::to_string(changed) + " voxels of crumbs of the " + (ofVoid ? "void" : "solid") +
                    " changed sides");
    }
}

std::vector<MappedVoxel> mappedVoxels(const VolumeAnalogyResult& made, const std::vector<PairFields>& pairs,
                                      const IndexBox& box, const openvdb::FloatGrid& result) {
    std::vector<MappedVoxel> voxels;
    const auto on = result.getConstAccessor();
    for (const AnalogySource& source : made.sources) {
        const Index3 to = source.to + box.min;
        if (!on.isValueOn(toCoord(to))) continue;
        const PairFields& pair = pairs[std::size_t(source.pair)];
        Index3 from;
        for (int axis = 0; axis < 3; ++axis)
            from[axis] = int(std::lround(pair.place.corner[axis] + source.from[axis] * pair.place.step));
        voxels.push_back({to, {std::size_t(source.pair), from, nullptr}});
    }
    return voxels;
}

std::vector<GridPtr> sourceGrids(const VolumeAnalogyResult& made, const std::vector<MappedVoxel>& voxels,
                                 const std::vector<FrameField>& frames, const FrameField& target,
                                 const IndexBox& box, const std::vector<AnalogyModelPair>& models,
                                 const openvdb::FloatGrid& result, double scale) {
    auto source = openvdb::Vec3IGrid::create(openvdb::Vec3i(0));
    auto exemplar = openvdb::Int32Grid::create(0);
    auto rotation = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    source->setName("source");
    exemplar->setName("exemplar");
    rotation->setName("source_rotation");
    std::vector<GridPtr> grids{source, exemplar, rotation};
    if (scale != 1) {
        auto scales = openvdb::FloatGrid::create(1);
        scales->setName("source_scale");
        for (const MappedVoxel& voxel : voxels) scales->tree().setValueOn(toCoord(voxel.to), float(scale));
        grids.push_back(scales);
    }
    std::size_t next = 0;
    for (const AnalogySource& of : made.sources) {
        if (next == voxels.size()) break;
        const MappedVoxel& voxel = voxels[next];
        if (of.to + box.min != voxel.to) continue;
        ++next;
        const openvdb::Coord to = toCoord(voxel.to);
        const Index3& from = voxel.from.voxel;
        source->tree().setValueOn(to, openvdb::Vec3i(from.x, from.y, from.z));
        exemplar->tree().setValueOn(to, of.pair);
        Frame a, b;
        float ignored;
        const auto middle = [](const Index3& v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
        if (frames[std::size_t(of.pair)].at(middle(of.from), a, ignored) &&
            target.at(middle(of.to), b, ignored)) {
            const Vec3f turn = rotationBetween(a, b);
            rotation->tree().setValueOn(to, openvdb::Vec3f(turn.x, turn.y, turn.z));
        }
    }
    std::string hashes;
    for (const AnalogyModelPair& model : models)
        hashes += (hashes.empty() ? "" : ",") + levelSetHash(*model.textured->grid);
    for (const GridPtr& grid : grids) {
        grid->setTransform(result.transform().copy());
        grid->insertMeta("vdbsynth:map:exemplar_hash", openvdb::StringMetadata(hashes));
    }
    return grids;
}

GridPtr directionGrid(const FrameField& frames, const FieldPlace& place, const IndexBox& box) {
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    grid->setName("direction");
    grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    grid->setTransform(place.like->transform().copy());
    const Vec3d origin = place.toWorld({0, 0, 0});
    const SurfaceShell& shell = frames.shell();
    for (std::size_t i = 0; i < shell.size(); ++i) {
        const Vec3d world = normalized(place.toWorld(cast<double>(frames.directions().tangent[i])) - origin);
        grid->tree().setValueOn(toCoord(shell.table[i] + box.min), openvdb::Vec3f(toVec(world)));
    }
    return grid;
}

AnalogyResult madeAnalogy(const std::vector<AnalogyModelPair>& pairs, const LevelSet& target,
                          const AnalogyOptions& options, const RunContext& ctx) {
    AnalogyResult result;
    std::vector<PairFields> fields;
    for (const AnalogyModelPair& pair : pairs) {
        fields.push_back(gatherPair(pair, options.scale, ctx));
        const float reach = reachOf(*fields.back().plain, *fields.back().textured);
        if (reach > float(kMostReach - 1) * float(std::min(options.scale, 1.0)))
            throw Error(
                ErrorCode::Unusable,
                "the texture goes more than " + std::to_string(kMostReach - 1) +
                    " voxels from the plain model's surface; use larger voxels, or check that the two "
                    "models of the pair lie on each other");
        result.reach = std::max(result.reach, reach);
    }
    const int levels = options.synthesis.levels == 0 ? 3 : std::clamp(options.synthesis.levels, 1, 6);
    const int radius = (options.synthesis.half + 2) << (levels - 1);
    const int band = int(std::ceil(result.reach)) + radius + 2;
    const CutFaces cut = facesTouched(target);
    const IndexBox box = grown(target.domain, cut, band);
    requireMemory(ctx, double(box.volume()) * 6 + double(activeVoxels(*target.grid)) / 6 * 2 * band * 160,
                  "the analogy", "use larger voxels, fewer `levels` or a smaller `half`");
    const auto plain =
        std::make_shared<const BrickField>(widenBand(*target.grid, box, cut, float(band), ctx));
    const FieldPlace place{target.grid.get(), {double(box.min.x), double(box.min.y), double(box.min.z)}, 1};
    const FrameField frames = framesOf(plain, place, options.direction, "the target", ctx);
    std::vector<FrameField> pairFrames;
    for (std::size_t p = 0; p < pairs.size(); ++p)
        pairFrames.push_back(framesOf(fields[p].plain, fields[p].place,
                                      directionOfPair(*pairs[p].plain, options.exemplarDirection), "the pair",
                                      ctx));
    std::vector<AnalogyPair> given;
    for (std::size_t p = 0; p < pairs.size(); ++p)
        given.push_back({fields[p].plain, fields[p].textured, &pairFrames[p], fields[p].inner});
    VolumeAnalogyResult made = makeAnalogy(given, *plain, frames, options.synthesis, ctx);
    BrickField field = blended(*plain, made.distance, weights(options, box, *target.grid, ctx), ctx);
    clean(field, fields, ctx);
    try {
        result.model.grid =
            closeAndRebuild(field, box.min, cut, options.halfWidth, *target.grid, "the result", ctx);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::EmptyInput) throw;
        throw Error(ErrorCode::EmptyInput,
                    "the texture takes all of the target away: it goes " +
                        std::to_string(int(std::ceil(result.reach))) +
                        " voxels deep, and the target is thinner; use smaller voxels for the target, or a "
                        "smaller `scale` or `strength`");
    }
    result.model.domain = target.domainRecorded ? target.domain : solidBox(*result.model.grid, "the result");
    result.model.domainRecorded = target.domainRecorded;
    stampLevelSet(result.model);
    const std::vector<MappedVoxel> voxels = mappedVoxels(made, fields, box, *result.model.grid);
    result.sources =
        sourceGrids(made, voxels, pairFrames, frames, box, pairs, *result.model.grid, options.scale);
    std::vector<const LevelSet*> textured;
    for (const AnalogyModelPair& pair : pairs) textured.push_back(pair.textured);
    result.model.carried = carryToVoxels(voxels, textured, *result.model.grid, {}, ctx);
    if (options.keepDirections) result.directions = directionGrid(frames, place, box);
    result.levels = std::move(made.levels);
    for (const Vec3f& p : frames.directions().singularities)
        result.singularities.push_back(place.toWorld(cast<double>(p)));
    result.cut = frames.sweep().cut;
    return result;
}

}  // namespace

namespace {

void requireDirection(const DirectionSource& source, const char* field) {
    using Kind = DirectionSource::Kind;
    const auto finite = [](const Vec3d& v) { return std::isfinite(dot(v, v)); };
    requireOption(source.kind != Kind::Grid || source.grid, field, "Grid", "given with a `grid`");
    const bool axis = source.kind == Kind::Axis || source.kind == Kind::Around;
    requireOption(!axis || (finite(source.axis) && dot(source.axis, source.axis) > 0), field,
                  "Axis or Around", "given with an `axis` that is not 0");
    if (source.kind != Kind::Strokes) return;
    requireOption(!source.strokes.empty(), field, "Strokes", "given with `strokes`");
    for (const Stroke& stroke : source.strokes)
        requireOption(finite(stroke.position) && finite(stroke.direction), field, "Strokes",
                      "given with `strokes` of finite numbers");
}

}  // namespace

void validate(const AnalogyOptions& options, const std::vector<AnalogyModelPair>& pairs,
              const LevelSet& target) {
    requireOption(options.scale >= 0.25 && options.scale <= 4, "scale", roundedText(options.scale, 6),
                  "from 0.25 to 4");
    requireOption(options.strength >= 0 && options.strength <= 1, "strength",
                  roundedText(options.strength, 6), "from 0 to 1");
    validate(options.synthesis);
    requireHalfWidth(double(options.halfWidth));
    requireDirection(options.direction, "direction");
    requireDirection(options.exemplarDirection, "exemplarDirection");
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string what = pairs.size() > 1 ? "pair " + std::to_string(p + 1) : "the pair";
        requireModel(pairs[p].plain, what + ", plain");
        requireModel(pairs[p].textured, what + ", textured");
        requireOnePlace(pairs[p]);
    }
    requireModel(&target, "the target");
}

AnalogyResult makeAnalogyModel(const std::vector<AnalogyModelPair>& pairs, const LevelSet& target,
                               const AnalogyOptions& options, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        validate(options, pairs, target);
        return madeAnalogy(pairs, target, options, ctx);
    });
}

}  // namespace vdbsynth
