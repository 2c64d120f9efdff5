#include "libvdbsynth/pipeline/make.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/field_model.h"

namespace vdbsynth {

LevelSet makeModel(const MakeOptions& options, const RunContext& ctx) {
    requireOption(options.voxelSize > 0 && options.voxelSize < 1e30, "voxel-size",
                  std::to_string(options.voxelSize), "above 0 (world)");
    const ThreadLimit limit(ctx);
    const ExemplarField made = makeExemplar(options.exemplar, ctx);
    return modelFromField(made.field, kExemplarLimit, made.exact, made.domain, options.voxelSize,
                          "make " + options.exemplar.kind, "use a larger --size or another --seed", ctx);
}

}  // namespace vdbsynth
