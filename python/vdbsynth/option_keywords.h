#pragma once
#include "python/vdbsynth/call.h"
#include "python/vdbsynth/keywords.h"

#include "libvdbsynth/measure/minimal_wall.h"
#include "libvdbsynth/patch/patch_synthesis.h"
#include "libvdbsynth/pipeline/analogy/filter_analogy.h"
#include "libvdbsynth/pipeline/compare/compare.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/fill/fill.h"
#include "libvdbsynth/pipeline/make/make_points.h"
#include "libvdbsynth/pipeline/mask/mask.h"
#include "libvdbsynth/pipeline/match/match.h"
#include "libvdbsynth/pipeline/patch/patch_onto.h"
#include "libvdbsynth/pipeline/pose/pose.h"
#include "libvdbsynth/pipeline/relief/relief.h"
#include "libvdbsynth/pipeline/relief/relief_bake.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"
#include "libvdbsynth/pipeline/render/render_options.h"
#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/pipeline/texture/texture.h"
#include "libvdbsynth/pipeline/texture/texture_outputs.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/level_set_to_points.h"

#include <map>
#include <tuple>

namespace vdbsynth::python {

// Options of what only this module does: arrays, meshes and points in memory.
struct BandOptions {
    double halfWidth = kHalfWidth;
};
struct ArrayOptions {
    double halfWidth = kHalfWidth;
    bool domainRecorded = false;
};
struct ShapeOptions {
    double halfWidth = kHalfWidth;
    bool carry = true, keepSource = false;
};
/// As the command line's convert, attributes are transferred.
struct ConvertOptions : ModelOptions {
    ConvertOptions() { carry = true; }
};

// The one place that says which keyword is which field. Fields of structs inside structs have their own
// names.
void describe(Keywords& keywords, Call& call);
void describe(Keywords& keywords, BandOptions& options);
void describe(Keywords& keywords, ArrayOptions& options);
void describe(Keywords& keywords, ShapeOptions& options);
void describe(Keywords& keywords, SolidOptions& options);
void describe(Keywords& keywords, ModelOptions& options);
void describe(Keywords& keywords, ModelOutputOptions& options);
void describe(Keywords& keywords, VolumeOptions& options);
void describe(Keywords& keywords, VdbReadOptions& options);
void describe(Keywords& keywords, MeshingOptions& options);
void describe(Keywords& keywords, PointOptions& options);
void describe(Keywords& keywords, SynthOptions& options);
void describe(Keywords& keywords, FillOptions& options);
void describe(Keywords& keywords, RepeatOptions& options);
void describe(Keywords& keywords, MatchOptions& options);
void describe(Keywords& keywords, PoseOptions& options);
void describe(Keywords& keywords, AnalogyOptions& options);
void describe(Keywords& keywords, FilterAnalogyOptions& options);
void describe(Keywords& keywords, ExemplarOptions& options);
void describe(Keywords& keywords, MakeOptions& options);
void describe(Keywords& keywords, MakePointsOptions& options);
void describe(Keywords& keywords, CompareOptions& options);
void describe(Keywords& keywords, PatchSourceOptions& options);
void describe(Keywords& keywords, PatchOptions& options);
void describe(Keywords& keywords, PatchOntoOptions& options);
void describe(Keywords& keywords, TextureOptions& options);
void describe(Keywords& keywords, TextureOutputOptions& options);
void describe(Keywords& keywords, ReliefOptions& options);
void describe(Keywords& keywords, ReliefExtractOptions& options);
void describe(Keywords& keywords, ReliefBakeOptions& options);
void describe(Keywords& keywords, MinimalWallOptions& options);
void describe(Keywords& keywords, MaskOptions& options);
void describe(Keywords& keywords, RenderOptions& options);

/// Fields of an options struct from what a function was given. @throw as Keywords::read
template <typename... Options>
void readKeywords(const std::string& function, const py::kwargs& given, Options&... options) {
    Keywords keywords(function);
    (describe(keywords, options), ...);
    keywords.read(given);
}

/// Keywords of every function, for its text, vdbsynth.keywords() and the test of the stubs.
std::map<std::string, std::vector<Keyword>>& keywordsOfFunctions();

/// A function's text with its keywords, which are recorded. @param Options  in the order of readKeywords
template <typename... Options>
std::string documented(const std::string& function, const std::string& text) {
    std::tuple<Options...> options;
    Keywords keywords(function);
    std::apply([&](auto&... each) { (describe(keywords, each), ...); }, options);
    std::string page = text + "\n\nKeywords:\n";
    for (const Keyword& keyword : keywords.all())
        page += "  " + keyword.name + ": " + keyword.type + " = " + keyword.initial + "\n      " +
                keyword.about + "\n";
    keywordsOfFunctions()[function] = keywords.all();
    return page;
}

}  // namespace vdbsynth::python
