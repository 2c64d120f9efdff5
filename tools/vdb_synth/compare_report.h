#pragma once
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/pipeline/compare.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace vdbsynth::cli {

/// A comparison as tables for people.
std::string comparisonText(const Comparison& comparison);

/// A comparison for programs; docs/measures.md names the fields.
nlohmann::ordered_json comparisonJson(const Comparison& comparison);

struct ModelPictures {
    Picture shaded, slice;
};

/// A comparison as one page of HTML that needs nothing but itself. @param pictures  reference first
std::string comparisonPage(const Comparison& comparison, const std::vector<ModelPictures>& pictures);

/// "xyz", "xy" ... or "none".
/// The verdicts that are not of a statistic: those of patches.
std::vector<Verdict> scaleVerdicts(const Comparison& comparison, std::size_t i);
std::string axesText(const std::array<bool, 3>& axes);
/// A number as people read it: four digits.
std::string shortNumber(double value);
/// "pass", "far" ...
bool allPass(const ModelDistances& distances);
/// How the places that a result came from were found, in a sentence.
std::string sourceText(const ModelDistances& distances);

}  // namespace vdbsynth::cli
