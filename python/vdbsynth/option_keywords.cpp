#include "python/vdbsynth/option_keywords.h"

namespace vdbsynth::python {

template <>
struct Words<OpenMesh> {
    static constexpr const char* kType = "Literal['close', 'shell']";
    static constexpr std::pair<const char*, OpenMesh> kAll[] = {{"close", OpenMesh::Close},
                                                                {"shell", OpenMesh::Shell}};
};
template <>
struct Words<ThinParts> {
    static constexpr const char* kType = "Literal['scale', 'keep', 'as-is']";
    static constexpr std::pair<const char*, ThinParts> kAll[] = {
        {"scale", ThinParts::Scale}, {"keep", ThinParts::Keep}, {"as-is", ThinParts::AsIs}};
};
template <>
struct Words<VolumeValues> {
    static constexpr const char* kType = "Literal['inside', 'distance', 'density']";
    static constexpr std::pair<const char*, VolumeValues> kAll[] = {{"inside", VolumeValues::Inside},
                                                                    {"distance", VolumeValues::Distance},
                                                                    {"density", VolumeValues::Density}};
};
template <>
struct Words<PatchMethod> {
    static constexpr const char* kType = "Literal['default', 'paper']";
    static constexpr std::pair<const char*, PatchMethod> kAll[] = {{"default", PatchMethod::Default},
                                                                   {"paper", PatchMethod::Paper}};
};
template <>
struct Words<PatchPlane> {
    static constexpr const char* kType = "Plane";
    static constexpr std::pair<const char*, PatchPlane> kAll[] = {
        {"xy", PatchPlane::XY}, {"yz", PatchPlane::YZ}, {"zx", PatchPlane::ZX}};
};
template <>
struct Words<TextureMethod> {
    static constexpr const char* kType = "Literal['default', 'parameterize', 'match', 'hybrid']";
    static constexpr std::pair<const char*, TextureMethod> kAll[] = {
        {"default", TextureMethod::Default},
        {"parameterize", TextureMethod::Parameterize},
        {"match", TextureMethod::Match},
        {"hybrid", TextureMethod::Hybrid}};
};
template <>
struct Words<SampleBlend> {
    static constexpr const char* kType = "Literal['automatic', 'off', 'weight', 'histogram']";
    static constexpr std::pair<const char*, SampleBlend> kAll[] = {{"automatic", SampleBlend::Automatic},
                                                                   {"off", SampleBlend::Off},
                                                                   {"weight", SampleBlend::Weight},
                                                                   {"histogram", SampleBlend::Histogram}};
};
template <>
struct Words<ReliefMethod> {
    static constexpr const char* kType = "Literal['default', 'paper']";
    static constexpr std::pair<const char*, ReliefMethod> kAll[] = {{"default", ReliefMethod::Default},
                                                                    {"paper", ReliefMethod::Paper}};
};
template <>
struct Words<BaseKind> {
    static constexpr const char* kType = "Literal['twicing', 'gaussian', 'flow', 'normals', 'quadrics']";
    static constexpr std::pair<const char*, BaseKind> kAll[] = {{"twicing", BaseKind::Twicing},
                                                                {"gaussian", BaseKind::Gaussian},
                                                                {"flow", BaseKind::Flow},
                                                                {"normals", BaseKind::Normals},
                                                                {"quadrics", BaseKind::Quadrics}};
};

void describe(Keywords& keywords, PairingWeights& weights);
void describe(Keywords& keywords, PairingLimits& limits);
template <>
struct Value<PairingWeights> : DictValue<PairingWeights> {};
template <>
struct Value<PairingLimits> : DictValue<PairingLimits> {};
template <>
struct Value<ExemplarOptions> : DictValue<ExemplarOptions> {};
template <>
struct Value<PatchBox> {
    static std::string type() { return "tuple[Place, Place]"; }
    static std::string text(const PatchBox&) { return "..."; }
    static PatchBox from(const std::string& name, py::handle value) {
        const std::vector<py::object> corners = elementsFrom(name, value, "two corners");
        if (corners.size() != 2) refuse(name, "two corners", value);
        return {placeFrom(name, corners[0]), placeFrom(name, corners[1])};
    }
};
// Borrowed: a call's keywords live as long as the call.
template <>
struct Value<const LevelSet*> {
    static std::string type() { return "LevelSet | None"; }
    static std::string text(const LevelSet*) { return "None"; }
    static const LevelSet* from(const std::string& name, py::handle value) {
        if (value.is_none()) return nullptr;
        if (!py::isinstance<LevelSet>(value)) refuse(name, "a LevelSet", value);
        return &py::cast<const LevelSet&>(value);
    }
};

namespace {

Keyword calledBack(const char* name, const char* type, const char* about, py::object& field) {
    return {name, type, "None", about, {[&field, name](py::handle value) {
                if (!value.is_none() && !PyCallable_Check(value.ptr())) refuse(name, "callable", value);
                field = py::reinterpret_borrow<py::object>(value);
            }}};
}

}  // namespace

void describe(Keywords& keywords, Call& call) {
    keywords.add("seed", call.context.seed, "of all randomness");
    keywords.add("threads", call.context.threads,
                 "of this call; 0: one per core. Results do not depend on it");
    keywords.add("maxMemory", call.context.maxMemory, "bytes that the run may plan to use; 0: no limit");
    keywords.add(
        calledBack("onProgress", "Callable[[str, int, int], object] | None",
                   "called with (stage, done, total) by the calling thread; what it raises ends the run",
                   call.onProgress));
    keywords.add(calledBack(
        "onMessage", "Callable[[str, str], object] | None",
        "called with ('detail' | 'note' | 'warning', text); None: the logger \"vdbsynth\"", call.onMessage));
    keywords.add({"cancel",
                  "Event | None",
                  "None",
                  "an object with is_set(), such as threading.Event; set: Error Cancelled",
                  {[&call](py::handle value) {
                      if (!value.is_none() && !py::hasattr(value, "is_set"))
                          refuse("cancel", "an object with is_set()", value);
                      call.cancel = py::reinterpret_borrow<py::object>(value);
                  }}});
}

void describe(Keywords& keywords, BandOptions& options) {
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the band, 1.5 to 100");
}

void describe(Keywords& keywords, ArrayOptions& options) {
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the band, 1.5 to 100");
    keywords.add("domainRecorded", options.domainRecorded,
                 "True: a texture that continues beyond the array, which is its domain, capped there; False: "
                 "an object");
}

void describe(Keywords& keywords, ShapeOptions& options) {
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the band, 1.5 to 100");
    keywords.add("carry", options.carry, "attributes become grids in LevelSet.attributes");
    keywords.add("keepSource", options.keepSource, "keeps a mesh in LevelSet.source");
}

void describe(Keywords& keywords, SolidOptions& options) {
    keywords.add("open", options.open,
                 "how to treat meshes that are not watertight: a solid by winding numbers, or a shell");
    keywords.add("thickness", options.thickness, "[world] of a shell, above 0");
    keywords.add("exact", options.exact,
                 "exact distances for closed meshes, within two voxels of the surface");
}

void describe(Keywords& keywords, ModelOptions& options) {
    keywords.add("voxelSize", options.voxelSize, "[world] above 0; 0: by resolution. A VDB is resampled");
    keywords.add("resolution", options.resolution,
                 "voxels along the longest side, 2 to 100000; 0: 128 for meshes and points, a VDB's own");
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the level set made from a mesh, 1.5 to 100");
    describe(keywords, options.solid);
    keywords.add("grid", options.grid,
                 "which grid of a VDB or array of a raster file, NAME or NAME[1]; '': the usual one");
    keywords.add("iso", options.iso, "makes a fog volume a solid: where its value is above this");
    HeightOptions& heights = options.heights;
    keywords.add("pixelSize", heights.pixelSize,
                 "[world] of a pixel's or sample's smallest side; 0: the file's, else 1");
    keywords.add("pixelSides", heights.pixelSides,
                 "[world] along columns, rows and slices, instead of pixelSize");
    keywords.add("pixelSize", options.volume.pixelSize, "");
    keywords.add("pixelSides", options.volume.pixelSides, "");
    keywords.add(
        "height", heights.height,
        "[world] of an image from black to white; 0: a tenth of its longer side, real values unchanged");
    keywords.add("base", heights.base,
                 "[world] of solid under an image's lowest point; 0: a twentieth of its longer side");
    keywords.add("plane", heights.plane, "ground plane of an image");
    keywords.add("threshold", options.volume.threshold, "a volume is solid where its value is above it");
    keywords.add("below", options.volume.below,
                 "a volume is solid where its value is below it, as of distances");
    keywords.add("labels", options.volume.labels,
                 "a volume is solid where its value is one of these, numbers or (low, high)");
    keywords.add("carry", options.carry,
                 "fills LevelSet.attributes: other grids of a VDB, attributes of vertices and points");
    keywords.add("keepSource", options.keepSource, "keeps a mesh in LevelSet.source");
    keywords.add("unitScale", options.unitScale,
                 "multiplies all coordinates: 1000 reads metres as millimetres");
    keywords.add("imageAsVolume", options.imageAsVolume, "reads an image as a volume of one slice");
}

void describe(Keywords& keywords, ModelOutputOptions& options) {
    keywords.add("points", options.points, ".ply holds points with normals instead of a mesh");
    keywords.add("sharp", options.sharp,
                 "meshes keep sharp edges and corners, from the model's source if it has one");
    keywords.add("adaptivity", options.adaptivity, "0 to 1, for meshes: how far flat regions are merged");
    keywords.add("spacing", options.spacing, "[voxels] between points, 0.25 to 100");
    keywords.add("plane", options.plane, "of height images");
    keywords.add("height", options.height,
                 "[world] of white in a .png of heights; 0: that of the highest point");
    keywords.add("unit", options.unit, "of the world, for a model whose file named none; '': unknown");
    keywords.add("values", options.values, "of volumes (.npy, .tif, .vti, .nii)");
    keywords.add("extraGrids", options.extraGrids, "written next to `surface` into .vdb outputs");
    keywords.add("name", options.name, "of the level set's grid in .vdb outputs; '': surface");
    keywords.add("half", options.half, ".vdb outputs hold halves");
    keywords.add("metadata", options.metadata, "of .vdb outputs");
}

void describe(Keywords& keywords, VolumeOptions& options) {
    keywords.add("threshold", options.threshold, "solid where the value is above it");
    keywords.add("below", options.below, "solid where the value is below it, as of distances");
    keywords.add("labels", options.labels, "solid where the value is one of these, numbers or (low, high)");
}

void describe(Keywords& keywords, VdbReadOptions& options) {
    keywords.add("gridName", options.gridName,
                 "which grid, NAME or NAME[1]; '': surface, else the first level set");
    keywords.add("iso", options.iso, "a fog volume is solid where its value is above this");
}

void describe(Keywords& keywords, MeshingOptions& options) {
    keywords.add("adaptivity", options.adaptivity, "0 to 1: how far flat regions may be merged");
    keywords.add("sharp", options.sharp, "keeps edges and corners; not with adaptivity");
}

void describe(Keywords& keywords, PointOptions& options) {
    keywords.add("spacing", options.spacing, "[voxels] least distance between two points, 0.25 to 100");
}

void describe(Keywords& keywords, SynthOptions& options) {
    keywords.add("size", options.size,
                 "of the result along x, y, z: whole voxels, or multiples such as '2x'; at least the domain");
    keywords.add("exemplarBox", options.exemplarBox, "[index] overrides the (first) exemplar's domain");
    keywords.add("border", options.border,
                 "for all axes or for each; None: cut where a domain is recorded or given, else object");
    keywords.add("origin", options.origin,
                 "[world] where the minimum corner of the result's domain goes; None: the exemplar's");
    keywords.add("block", options.block,
                 "[voxels] side of the matched blocks, 4 to 256; 0: from the exemplar, at most 16");
    keywords.add("levels", options.levels, "passes, coarse to fine, 1 to 8; 0: as many as useful");
    keywords.add(
        "drift", options.drift,
        "[voxels] largest distance of a source from its destination along an axis that keeps its length");
    keywords.add("method", options.method,
                 "texture optimization, or blocks in raster order, or as in the paper of 2004");
    keywords.add("draft", options.draft,
                 "synthesizes at half the resolution and reads the result at the full one");
    keywords.add("exemplarMask", options.exemplarMask,
                 "sources only where this grid is active; of the first exemplar");
    keywords.add("exemplarMap", options.exemplarMap,
                 "over the result: which exemplar to use where; needs several");
    keywords.add("rotationMap", options.rotationMap,
                 "over the result: rotation vectors, or angles about z [radians]");
    keywords.add(
        "direction", options.direction,
        "over the result: the exemplar is rotated along it, instead of rotationMap; None: not rotated");
    keywords.add("exemplarDirection", options.exemplarDirection,
                 "of the exemplars, an axis or a vector; None: as recorded, else axis:x");
    keywords.add("scaleMap", options.scaleMap, "over the result: scale of the copied geometry, 0.25 to 4");
    keywords.add("guide", options.guide,
                 "over the result: a scalar that controls where parts of the exemplars go");
    keywords.add("exemplarGuides", options.exemplarGuides, "the same scalar over each exemplar");
    keywords.add("guideWeight", options.guideWeight,
                 "[voxels^2] cost of a guide difference of one standard deviation, 0.001 to 1000");
    keywords.add("longestRun", options.longestRun,
                 "share of an exemplar that may be copied in one piece, 0.01 to 1");
    keywords.add("indexCache", options.indexCache,
                 "folder that stores search indices between runs; '': none");
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the result");
    keywords.add("carried", options.carried, "values of transferred attributes");
}

void describe(Keywords& keywords, FillOptions& options) {
    keywords.add(
        "block", options.block,
        "[voxels] side of the matched blocks, 4 to 256; 0: 16, or 8 where the hole is already closed");
    keywords.add("levels", options.levels,
                 "passes, 1 to 8; 0: as many as useful, one where the hole is already closed");
}

void describe(Keywords& keywords, RepeatOptions& options) {
    keywords.add("carried", options.carried, "values of transferred attributes");
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the result, 1.5 to 100; 0: the map's");
    keywords.add(
        "origin", options.origin,
        "[world] of a map of a synthesis: where the minimum corner of the result's domain goes; None: "
        "as in the map's run");
}

void describe(Keywords& keywords, MatchOptions& options) {
    keywords.add("block", options.block, "[voxels] side of the block, 4 to 256");
    keywords.add("at", options.at, "[index] minimum corner of the block in the query");
    keywords.add("count", options.count, "number of matches, 1 to 100000");
    keywords.add("tolerance", options.tolerance,
                 "0: exact; else differences are at most (1 + tolerance) times the least");
    keywords.add("check", options.check, "with a tolerance: also finds the exact matches, to compare");
    keywords.add("indexCache", options.indexCache,
                 "folder that stores search indices between runs; '': none");
    keywords.add("mask", options.mask, "over the query: compares active samples only");
}

void describe(Keywords& keywords, PoseOptions& options) {
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the result, 1.5 to 100");
    keywords.add("reach", options.reach,
                 "[voxels] farthest that the result's surface lies from the surface at rest, 0 to 64");
    keywords.add("restGrid", options.restGrid,
                 "attribute of a posed level set that says for every voxel where it is at rest [world]");
}

void describe(Keywords& keywords, AnalogyOptions& options) {
    VolumeAnalogyOptions& synthesis = options.synthesis;
    keywords.add("levels", synthesis.levels,
                 "of the pyramid, 1 to 6; 0: as many as resolve the texture, at most 3");
    keywords.add("sweeps", synthesis.sweeps, "over the voxels of every level, 1 to 10");
    keywords.add("half", synthesis.half, "a neighbourhood is (2 half + 1)^3 samples, 1 to 4");
    keywords.add("coarseHalf", synthesis.coarseHalf, "the same at the next coarser level, 1 to 3");
    keywords.add("components", synthesis.components,
                 "principal axes that features are compared along, 4 to 256");
    keywords.add("coherence", synthesis.coherence,
                 "preference for a source that continues a neighbour's, 0 to 100");
    keywords.add(
        "epsilon", synthesis.epsilon,
        "of the approximate search: squared distances are at most 1 + epsilon times the least, 0 to 100");
    keywords.add("causal", synthesis.causal,
                 "compares only voxels behind the current one in the sweep, as in the paper");
    keywords.add("curvatureAdapted", synthesis.curvatureAdapted,
                 "neighbourhoods follow the surface's curvature");
    keywords.add("aligned", synthesis.aligned,
                 "False: the paper's naive variant, axis-aligned neighbourhoods");
    keywords.add("direction", options.direction, "of the texture over the target");
    keywords.add("exemplarDirection", options.exemplarDirection, "over the plain model of each pair");
    keywords.add("scale", options.scale,
                 "of the texture, 0.25 to 4: 2 is twice as large in the target's voxels");
    keywords.add("strength", options.strength, "0 to 1: blend from the target to the result");
    keywords.add("mask", options.mask,
                 "0 to 1 over the target, by which strength is multiplied; of a level set its inside");
    keywords.add(
        "thin", options.thin,
        "where the target is thinner than the texture is deep: scale its depth, keep such parts, or as-is");
    keywords.add("draft", options.draft, "a quick look: searched at half the resolution");
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the result, 1.5 to 100");
    keywords.add("keepDirections", options.keepDirections, "fills the result's directions");
}

void describe(Keywords& keywords, FilterAnalogyOptions& options) {
    keywords.add("half", options.half, "a voxel is computed from the (2 half + 1)^3 around it, 1 to 4");
    keywords.add("levels", options.levels, "1 to 4; each further one adds 3^3 positions 2^level apart");
    keywords.add("components", options.components,
                 "principal axes for the search of nonlinear effects, 4 to 256");
}

void describe(Keywords& keywords, ExemplarOptions& options) {
    keywords.add("kind", options.kind, "of exemplar");
    keywords.add("size", options.size,
                 "[voxels] of the domain, each side 8 to 4096; 0: the kind's default for `resolution`");
    keywords.add("resolution", options.resolution,
                 "voxels along the longest side if `size` is 0, 16 to 4096");
    keywords.add("feature", options.feature,
                 "[voxels] of a typical feature, 4 to 256; 0: the kind's default");
}

void describe(Keywords& keywords, MakeOptions& options) {
    // The kind is an argument of its own.
    keywords.add("size", options.exemplar.size,
                 "[voxels] of the domain, each side 8 to 4096; 0: the kind's default for `resolution`");
    keywords.add("resolution", options.exemplar.resolution,
                 "voxels along the longest side if `size` is 0, 16 to 4096");
    keywords.add("feature", options.exemplar.feature,
                 "[voxels] of a typical feature, 4 to 256; 0: the kind's default");
    keywords.add("voxelSize", options.voxelSize, "[world] above 0");
}

void describe(Keywords& keywords, MakePointsOptions& options) {
    describe(keywords, options.model);
    keywords.add("spacing", options.spacing,
                 "[voxels] least distance between two points, 0.125 to 100; 0: by the kind's finest detail");
    keywords.add("margin", options.margin,
                 "[voxels] of geometry beyond the domain, 0 to 4000; negative: two thirds of the feature");
}

void describe(Keywords& keywords, CompareOptions& options) {
    keywords.add("stationary", options.stationary,
                 "axes along which the reference is stationary, such as 'xy'; None: found");
    keywords.add(
        "process", options.process,
        "the process that the reference is a sample of, {'kind': ..., 'feature': ...}: gives yardsticks");
    keywords.add("fresh", options.fresh, "fresh samples of the process, 2 to 100");
    keywords.add("full", options.full, "thickness and pores on every voxel, of any model");
    keywords.add("reliefRadius", options.reliefRadius,
                 "[world] radius of the base from which relief is measured; None: it is not");
}

void describe(Keywords& keywords, PatchSourceOptions& options) {
    keywords.add({"plane",
                  Value<std::optional<PatchPlane>>::type(),
                  "None",
                  "that the texture lies along; None: the file's, else across its shortest side; of an image "
                  "its ground plane",
                  {[&options](py::handle value) {
                      options.plane = Value<std::optional<PatchPlane>>::from("plane", value);
                      if (options.plane)
                          options.model.heights.plane = Value<HeightPlane>::from("plane", value);
                  }}});
    Keywords ofModels("");
    describe(ofModels, options.model);
    for (const Keyword& keyword : ofModels.all())
        if (keyword.name != "plane") keywords.add(keyword);
    keywords.add("margin", options.margin,
                 "[world] how far the points continue beyond the box, where the file does not say the box");
    keywords.add("whole", options.whole, "the box is that of the points: for patch_hole");
    keywords.add("box", options.box,
                 "[world] corners of the texture, height included; the file's is not read then");
}

void describe(Keywords& keywords, PairingWeights& weights) {
    keywords.add("position", weights.position, "w_p");
    keywords.add("normal", weights.normal, "w_n");
    keywords.add("variation", weights.variation, "w_v");
    keywords.add("length", weights.length, "w_l");
    keywords.add("direction", weights.direction, "w_d");
}

void describe(Keywords& keywords, PairingLimits& limits) {
    keywords.add("position", limits.position, "[spacings] between the points");
    keywords.add("normal", limits.normal, "[degrees] between the normals");
    keywords.add("variation", limits.variation, "of surface variation");
}

void describe(Keywords& keywords, PatchOptions& options) {
    keywords.add("method", options.method, "placed, cut, warped and blended; or as published in 2006");
    keywords.add("width", options.width, "[world] of the sheet along the plane's first axis");
    keywords.add("depth", options.depth, "[world] along its second axis");
    keywords.add("border", options.border,
                 "[world] how far the points continue beyond that; patch sets its own");
    keywords.add("patch", options.patch, "[world] side of a patch; 0: one and a half features");
    keywords.add("overlap", options.overlap, "0.05 to 0.8 of a patch over earlier ones; 0: a third");
    keywords.add("tolerance", options.tolerance,
                 "0 to 10: candidates within (1 + tolerance) of the best are drawn from");
    keywords.add("step", options.step,
                 "[spacings] of the field that patches are compared by, 0.5 to 64; 0: found");
    keywords.add("tile", options.tile, "the sheet continues at its opposite sides");
    keywords.add("repairs", options.repairs,
                 "rounds in which patches are laid over the worst seams, 0 to 20");
    keywords.add("warp", options.warp, "both sides of a seam are warped to each other");
    keywords.add("blend", options.blend, "points at seams are blended");
    keywords.add("seedPlace", options.seedPlace,
                 "[world] of the paper's method: minimum corner of the first patch");
    keywords.add("weights", options.weights,
                 "of the paper's method: position, normal, variation, length, direction; None: found");
    keywords.add("limits", options.limits, "of the paper's method: position, normal, variation");
    keywords.add("rounds", options.rounds, "of the paper's method: of pairing again, 0 to 20");
}

void describe(Keywords& keywords, PatchOntoOptions& options) {
    OntoOptions& onto = options.onto;
    keywords.add("patch", onto.patch,
                 "[world] side of the square that a round patch has the area of; 0: found");
    keywords.add("overlap", onto.overlap, "0.05 to 0.8; 0: a quarter");
    keywords.add("tolerance", onto.tolerance,
                 "0 to 10: candidates within (1 + tolerance) of the best are drawn from");
    keywords.add("step", onto.step,
                 "[spacings] of the field that patches are compared by, 0.5 to 64; 0: found");
    keywords.add("repairs", onto.repairs, "rounds in which patches are laid over the worst seams, 0 to 20");
    keywords.add("warp", onto.warp, "both sides of a seam are warped to each other");
    keywords.add("blend", onto.blend, "points at seams are blended");
    keywords.add("scale", onto.scale, "0.001 to 1000: 2 makes the exemplar twice as large");
    keywords.add("heightOffset", onto.heightOffset,
                 "[world] outward from where the exemplar's middle height lies on the surface");
    keywords.add("direction", options.direction,
                 "of the exemplar's first axis over the model; None: the smoothest field");
}

namespace {

void describeSynthesis(Keywords& keywords, CoordinateOptions& options) {
    keywords.add("levels", options.levels,
                 "of the hierarchy, 1 to 12; 0: as many as the sample's size asks for");
    keywords.add("passes", options.passes, "of correction on every level, 0 to 20");
    keywords.add("coarsePasses", options.coarsePasses, "on the coarsest level, 0 to 100");
    keywords.add("similar", options.similar, "texels like a candidate that are tried beside it, 0 to 8");
    keywords.add("coherence", options.coherence,
                 "how much more a jump must improve than a continuation, 0 to 10");
    keywords.add("uniformity", options.uniformity,
                 "how much a place of the sample costs that is used twice as often as others, 0 to 10");
    keywords.add("histogram", options.histogram,
                 "the same for values that are used twice as often as in the sample, 0 to 10");
    keywords.add("maxRotation", options.maxRotation,
                 "[degrees] how far charts may be rotated from the sites' tangents, 0 to 180");
}

}  // namespace

void describe(Keywords& keywords, TextureOptions& options) {
    keywords.add("method", options.method,
                 "by surface coordinates, or one of the three of the paper of 2004");
    keywords.add("scale", options.scale, "0.01 to 100: 2 makes the texture twice as large");
    keywords.add("direction", options.direction, "of the sample's u axis over the target; None: free");
    describeSynthesis(keywords, options.synthesis);
    keywords.add("blend", options.blend, "how colours are mixed where pieces of the sample meet");
    keywords.add("regionBlend", options.regionBlend,
                 "[texels] how far from borders between regions colours cross-fade, 0 to 1000");
    keywords.add("neighbours", options.neighbours, "of the paper's methods, 4 to 128");
    keywords.add("levels", options.levels, "");
    keywords.add("coherent", options.coherent, "of `match`: only candidates that continue neighbours");
    keywords.add("matchSample", options.matchSample,
                 "[texels] side of the part of the sample that `hybrid` matches in; 0: all");
}

void describe(Keywords& keywords, TextureOutputOptions& options) {
    keywords.add("bake", options.bake,
                 "pictures (.png, .exr) are baked onto the target's own texture coordinates");
    keywords.add("bakeSize", options.bakeSize, "[pixels] side of a picture, 16 to 16384");
    keywords.add("bakeBits", options.bakeBits, "of .png: 8 or 16");
    keywords.add("voxelSize", options.model.voxelSize,
                 "[world] of a level set made from a mesh; 0: by resolution");
    keywords.add("resolution", options.model.resolution, "voxels along the longest side; 0: 128");
    keywords.add("halfWidth", options.model.halfWidth, "[voxels] of a level set made from a mesh");
    keywords.add("metadata", options.metadata, "of .vdb outputs");
}

void describe(Keywords& keywords, ReliefOptions& options) {
    keywords.add("method", options.method,
                 "by surface coordinates, or the exhaustive growth of the paper of 2006");
    keywords.add("base", options.base, "how the smooth base under a scan's relief is made");
    keywords.add("baseRadius", options.baseRadius,
                 "[world of the sample] standard deviation of the base's Gaussian; 0: found");
    keywords.add("wholeSample", options.wholeSample, "also copies from parts of a scan that are plain");
    keywords.add("scale", options.scale,
                 "0.05 to 20: at 1 a voxel of the sample lands on a voxel of the target");
    keywords.add("strength", options.strength, "-100 to 100 of the relief; below 0 inverted");
    keywords.add("minWall", options.minWall, "[world] that carving leaves of thin parts");
    keywords.add("direction", options.direction, "of u over the target; None: free");
    keywords.add("exemplarDirection", options.exemplarDirection,
                 "of u over scans; None: the smoothest field");
    describeSynthesis(keywords, options.synthesis);
    keywords.add("neighbourhood", options.neighbourhood,
                 "[world of the target] radius, of the paper's method; 0: found");
    keywords.add("top", options.top, "[percent] eta of the paper's method");
    keywords.add("mask", options.mask, "0 to 1 over the target, by which strength is multiplied");
    keywords.add("maskModel", options.maskModel, "relief only inside this model");
    keywords.add("maskAttribute", options.maskAttribute,
                 "name of an attribute of the target, painted 0 to 1; '': none");
    keywords.add("maskImage", options.maskImage,
                 "[rows x columns] painted on the target's texture coordinates, its attribute `uv`");
    keywords.add("fade", options.fade, "[world] depth inside maskModel over which the relief rises to full");
    keywords.add("fit", options.fit,
                 "lays a tileable picture round the axis of `direction` in a whole number of periods");
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the result, 1.5 to 100");
}

void describe(Keywords& keywords, ReliefExtractOptions& options) {
    keywords.add("base", options.base, "how the smooth base is made");
    keywords.add("baseRadius", options.baseRadius,
                 "[world] standard deviation of the base's Gaussian, 1 to 1000 voxels; 0: found");
    keywords.add("strength", options.strength,
                 "-100 to 100: also makes base + strength * relief, the result's surface");
    keywords.add("halfWidth", options.halfWidth, "[voxels] of the level sets, 1.5 to 100");
}

void describe(Keywords& keywords, ReliefBakeOptions& options) {
    keywords.add("size", options.size, "[pixels] side of a picture, 16 to 16384");
    keywords.add("bits", options.bits, "of .png: 8 or 16");
    keywords.add("reach", options.reach,
                 "[world] how far along the normal relief is looked for; 0: the result's reach");
}

void describe(Keywords& keywords, MinimalWallOptions& options) {
    keywords.add("share", options.share,
                 "above 0, to 1: of the surface's area, the thinnest part that is looked at");
}

void describe(Keywords& keywords, MaskOptions& options) {
    // The kind is an argument of its own.
    keywords.add("box", options.box, "[index] of a box, both corners inclusive");
    keywords.add("center", options.center, "[world] of a ball");
    keywords.add("radius", options.radius, "[world] of a ball, above 0");
    keywords.add("range", options.range,
                 "lowest and highest value of active voxels; a number: this value only");
    keywords.add("voxelSize", options.voxelSize, "[world] of a box or a ball, above 0; None: 1");
}

std::map<std::string, std::vector<Keyword>>& keywordsOfFunctions() {
    static std::map<std::string, std::vector<Keyword>> all;
    return all;
}

}  // namespace vdbsynth::python
