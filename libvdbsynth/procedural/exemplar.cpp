#include "libvdbsynth/procedural/exemplar.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/procedural/kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

const ExemplarKind& findKind(const std::string& name) {
    std::string names;
    for (const ExemplarKind& kind : exemplarKinds()) {
        if (kind.name == name) return kind;
        names += (names.empty() ? "" : ", ") + kind.name;
    }
    throw Error(ErrorCode::InvalidOption, "make " + name + ": unknown kind; one of " + names);
}

Index3 defaultSize(const ExemplarKind& kind, const ExemplarOptions& options, double feature) {
    Index3 size{options.resolution, options.resolution, options.resolution};
    if (kind.heightInFeatures > 0)
        size.z = std::clamp(int(std::lround(kind.heightInFeatures * feature)), 8, options.resolution);
    return size;
}

}  // namespace

const std::vector<ExemplarKind>& exemplarKinds() {
    static const std::vector<ExemplarKind> kinds{
        {"balls", "packed balls that do not overlap", 16, 0},
        {"grid", "bars along three axes with a ball at each crossing", 16, 0},
        {"chainmail", "a sheet of linked rings", 24, 0.9},
        {"fibres", "wavy fibres along x", 12, 0},
        {"foam", "closed cells with thin walls", 20, 0},
        {"sponge", "a thresholded random field", 20, 0},
        {"terrain", "hills with finer and finer detail", 32, 1.25},
        {"three-tori", "three linked rings, a single object", 16, 0},
        {"weave", "yarns over and under each other", 16, 1.25},
        {"flowers", "loose flowers over a plane", 24, 0.9},
        {"bumps", "round bumps on a plane", 16, 1},
    };
    return kinds;
}

void validate(const ExemplarOptions& options) {
    findKind(options.kind);
    requireOption(options.feature == 0 || (options.feature >= 4 && options.feature <= 256), "feature",
                  roundedText(options.feature, 6), "from 4 to 256 voxels");
    requireOption(options.resolution >= 16 && options.resolution <= 4096, "resolution",
                  std::to_string(options.resolution), "from 16 to 4096");
    const Index3& size = options.size;
    for (int axis = 0; axis < 3; ++axis)
        requireOption(size == Index3{0, 0, 0} || (size[axis] >= 8 && size[axis] <= 4096), "size",
                      std::to_string(size.x) + "," + std::to_string(size.y) + "," + std::to_string(size.z),
                      "three whole numbers from 8 to 4096");
}

ExemplarField makeExemplar(const ExemplarOptions& options, const RunContext& ctx) {
    validate(options);
    const ExemplarKind& kind = findKind(options.kind);
    const double feature = options.feature > 0 ? options.feature : kind.feature;
    Index3 size = options.size;
    if (size == Index3{0, 0, 0}) size = defaultSize(kind, options, feature);
    requireMemory(ctx, double(size.x) * size.y * size.z * 12, "make " + kind.name,
                  "use a smaller `resolution` or `size`");
    ExemplarRequest request;
    request.domain = IndexBox::fromSize(size);
    request.box = request.domain.expanded(kExemplarMargin);
    request.feature = feature;
    request.seed = ctx.seed;
    Stage stage(ctx, "make " + kind.name, 1);
    ExemplarField result;
    result.domain = request.domain;
    const auto fromPrimitives = [&](const std::vector<Primitive>& primitives) {
        result.field = unionField(primitives, request.box, kExemplarLimit, ctx);
    };
    if (kind.name == "balls")
        fromPrimitives(ballsPrimitives(request, ctx));
    else if (kind.name == "grid")
        fromPrimitives(gridPrimitives(request));
    else if (kind.name == "chainmail")
        fromPrimitives(chainmailPrimitives(request));
    else if (kind.name == "fibres")
        fromPrimitives(fibresPrimitives(request));
    else if (kind.name == "weave")
        fromPrimitives(weavePrimitives(request));
    else if (kind.name == "flowers")
        fromPrimitives(flowersPrimitives(request));
    else if (kind.name == "three-tori")
        fromPrimitives(threeToriPrimitives(request));
    else if (kind.name == "bumps")
        result.field = bumpsField(request, ctx);
    else if (kind.name == "foam")
        result.field = foamField(request, ctx);
    else if (kind.name == "sponge")
        result.field = spongeField(request, ctx);
    else
        result.field = terrainField(request, ctx);
    result.exact = kind.name != "sponge" && kind.name != "terrain" && kind.name != "bumps";
    stage.advance();
    return result;
}

}  // namespace vdbsynth
