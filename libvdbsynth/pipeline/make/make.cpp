#include "libvdbsynth/pipeline/make/make.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/procedural/analogy_pair.h"
#include "libvdbsynth/vdb/grid_kinds.h"

namespace vdbsynth {

namespace {

void requireVoxelSize(double voxelSize) {
    requireOption(voxelSize > 0 && voxelSize < 1e30, "voxelSize", roundedText(voxelSize, 6),
                  "above 0 (world)");
}

ModelPair pairOf(const MakeOptions& options, const RunContext& ctx) {
    const AnalogyPairFields made = makeAnalogyPair(options.exemplar, ctx);
    const auto model = [&](const ExemplarField& field) {
        return modelFromField(field.field, kExemplarLimit, field.exact, 0, field.domain, options.voxelSize,
                              "make " + options.exemplar.kind, "use a larger `resolution` or another `seed`",
                              ctx);
    };
    ModelPair pair{model(made.plain), model(made.textured)};
    for (const LevelSet* of : {&pair.plain, &pair.textured})
        of->grid->insertMeta(kDirectionKey, openvdb::StringMetadata(made.direction));
    return pair;
}

LevelSet modelOf(const MakeOptions& options, const RunContext& ctx) {
    const ExemplarField made = makeExemplar(options.exemplar, ctx);
    return modelFromField(made.field, kExemplarLimit, made.exact, 0, made.domain, options.voxelSize,
                          "make " + options.exemplar.kind, "use a larger `size` or another `seed`", ctx);
}

}  // namespace

void validate(const MakeOptions& options) {
    requireVoxelSize(options.voxelSize);
    validate(options.exemplar);
}

ModelPair makePair(const MakeOptions& options, const RunContext& ctx) {
    requireVoxelSize(options.voxelSize);
    validatePair(options.exemplar);
    return withThreads(ctx, [&] { return pairOf(options, ctx); });
}

LevelSet makeModel(const MakeOptions& options, const RunContext& ctx) {
    validate(options);
    return withThreads(ctx, [&] { return modelOf(options, ctx); });
}

}  // namespace vdbsynth
