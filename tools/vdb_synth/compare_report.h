#pragma once
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/pipeline/compare/compare.h"
#include "tools/vdb_synth/view_page.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// A comparison as tables of text.
std::string comparisonText(const Comparison& comparison);

/// A comparison as JSON; docs/measures.md names the fields.
nlohmann::ordered_json comparisonJson(const Comparison& comparison);

struct ModelPictures {
    Picture shaded, slice;
    PageModel viewer;  ///< `shaded` stands where the browser has no WebGL
};

/// A comparison as one self-contained HTML page. @param pictures  reference first
std::string comparisonPage(const Comparison& comparison, const std::vector<ModelPictures>& pictures);

/// "xyz", "xy" ... or "none".
/// The verdicts of patches, which belong to no single statistic.
std::vector<Verdict> scaleVerdicts(const Comparison& comparison, std::size_t i);
std::string axesText(const std::array<bool, 3>& axes);
/// A number with four digits.
std::string shortNumber(double value);
/// "pass", "far" ...
bool allPass(const ModelDistances& distances);
/// How the sources of a result's voxels were found, in a sentence.
std::string sourceText(const ModelDistances& distances);

}  // namespace vdbsynth::cli
