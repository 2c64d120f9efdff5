#include "libvdbsynth/procedural/exemplar.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/procedural/kinds.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

Index3 defaultSize(const ExemplarKind& kind, const ExemplarOptions& options, double feature) {
    Index3 size{options.resolution, options.resolution, options.resolution};
    if (kind.heightInFeatures > 0)
        size.z = std::clamp(int(std::lround(kind.heightInFeatures * feature)), 8, options.resolution);
    return size;
}

// The shapes of which a kind is the union, or none.
std::optional<std::vector<Primitive>> shapesOf(const std::string& kind, const ExemplarRequest& request,
                                               const RunContext& ctx) {
    if (kind == "balls") return ballsPrimitives(request, ctx);
    if (kind == "grid") return gridPrimitives(request);
    if (kind == "chainmail") return chainmailPrimitives(request);
    if (kind == "fibres") return fibresPrimitives(request);
    if (kind == "weave") return weavePrimitives(request);
    if (kind == "flowers") return flowersPrimitives(request);
    if (kind == "three-tori") return threeToriPrimitives(request);
    return std::nullopt;
}

// The kinds that are no unions.
void makeField(const std::string& kind, const ExemplarRequest& request, ExemplarField& result,
               const RunContext& ctx) {
    if (kind == "foam") {
        result.field = foamField(request, ctx);
        return;
    }
    result.exact = false;
    if (kind == "sponge") {
        result.surface = spongeSurface(request);
        result.field = spongeField(request, ctx);
        return;
    }
    const Heights heights = kind == "bumps" ? bumpsHeights(request) : terrainHeights(request);
    result.surface = [heights](const Vec3d& p) { return p.z - heights(p.x, p.y); };
    result.field = heightsField(request, heights, ctx);
}

// The union sampled `fine` times as finely.
BrickField finerUnion(std::vector<Primitive> shapes, const IndexBox& box, int fine, const RunContext& ctx) {
    for (Primitive& shape : shapes) shape = scaled(shape, fine);
    IndexBox samples;
    for (int axis = 0; axis < 3; ++axis) {
        samples.min[axis] = box.min[axis] * fine;
        samples.max[axis] = box.max[axis] * fine;
    }
    return unionField(shapes, samples, kExemplarLimit, ctx);
}

void validateSampling(const ExemplarSampling& sampling) {
    for (int axis = 0; axis < 3; ++axis)
        requireOption(sampling.margin[axis] >= kExemplarMargin && sampling.margin[axis] <= 4096, "margin",
                      std::to_string(sampling.margin[axis]),
                      "from " + std::to_string(kExemplarMargin) + " to 4096 voxels");
    requireOption(sampling.fine >= 1 && sampling.fine <= 8, "fine", std::to_string(sampling.fine),
                  "from 1 to 8");
}

}  // namespace

const std::vector<ExemplarKind>& exemplarKinds() {
    static const std::vector<ExemplarKind> kinds{
        {"balls", "packed balls that do not overlap", 16, 0, 0.4},
        {"grid", "bars along three axes with a ball at each crossing", 16, 0, 0.12},
        {"chainmail", "a sheet of linked rings", 24, 0.9, 0.05},
        {"fibres", "wavy fibres along x", 12, 0, 0.2},
        {"foam", "closed cells with thin walls", 20, 0, 0.14},
        {"sponge", "a thresholded random field", 20, 0, 0.2},
        {"terrain", "hills with finer and finer detail", 32, 1.25, 0.06},
        {"three-tori", "three linked rings, a single object", 16, 0, 0.25},
        {"weave", "yarns over and under each other", 16, 1.25, 0.21},
        {"flowers", "loose flowers over a plane", 24, 0.9, 0.07},
        {"bumps", "round bumps on a plane", 16, 1, 0.2},
    };
    return kinds;
}

const ExemplarKind& exemplarKind(const std::string& name) {
    std::string names;
    for (const ExemplarKind& kind : exemplarKinds()) {
        if (kind.name == name) return kind;
        names += (names.empty() ? "" : ", ") + kind.name;
    }
    throw Error(ErrorCode::InvalidOption, "make " + name + ": unknown kind; one of " + names);
}

void validate(const ExemplarOptions& options) {
    exemplarKind(options.kind);
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
    return makeExemplar(options, ExemplarSampling{}, ctx);
}

ExemplarField makeExemplar(const ExemplarOptions& options, const ExemplarSampling& sampling,
                           const RunContext& ctx) {
    validate(options);
    validateSampling(sampling);
    const ExemplarKind& kind = exemplarKind(options.kind);
    const double feature = options.feature > 0 ? options.feature : kind.feature;
    Index3 size = options.size;
    if (size == Index3{0, 0, 0}) size = defaultSize(kind, options, feature);
    ExemplarRequest request;
    request.domain = IndexBox::fromSize(size);
    request.box = {request.domain.min - sampling.margin, request.domain.max + sampling.margin};
    request.feature = feature;
    request.seed = ctx.seed;
    // Only bricks near the surface hold samples, so that memory grows as its area.
    requireMemory(ctx, double(request.domain.volume()) * 12 * sampling.fine * sampling.fine,
                  "make " + kind.name, "use a smaller `resolution` or `size`");
    Stage stage(ctx, "make " + kind.name, 1);
    ExemplarField result;
    result.domain = request.domain;
    if (const auto shapes = shapesOf(kind.name, request, ctx)) {
        result.fine = sampling.fine;
        result.surface = unionDistance(*shapes, request.box, double(kExemplarLimit));
        result.field = finerUnion(*shapes, request.box, result.fine, ctx);
    } else {
        makeField(kind.name, request, result, ctx);
    }
    stage.advance();
    return result;
}

}  // namespace vdbsynth
