// A comparison in text.
#include "tools/vdb_synth/compare_report.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/measure/patch_distribution.h"
#include "libvdbsynth/measure/verdict.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {
namespace {

std::string column(const std::string& text, std::size_t width) {
    return text.size() >= width ? text + " " : text + std::string(width - text.size(), ' ');
}

constexpr std::size_t kName = 38, kNumber = 13;

// A statistic as a person reads it: a number, three for a statistic by axis, or the word curve.
std::string valueText(const Statistic& statistic, double voxel) {
    if (!statistic.measured()) return "-";
    if (statistic.curve) return "curve";
    std::string text;
    for (double value : statistic.values)
        text += (text.empty() ? "" : " ") + shortNumber(value * std::pow(voxel, statistic.power));
    return text;
}

std::string sizeText(const IndexBox& box) {
    const Index3 size = box.size();
    return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
}

void appendModel(const char* role, const ModelStatistics& model, std::string& text) {
    text += std::string(role) + " " + model.name + ": " +
            (model.domainRecorded ? "texture, domain " : "object, box ") + sizeText(model.domain) +
            " voxels of " + shortNumber(model.voxelSize) + "\n";
}

void appendStatistics(const Comparison& comparison, std::size_t i, bool world, std::string& text) {
    const ModelStatistics &reference = comparison.reference, &other = comparison.others[i];
    const std::vector<Verdict>& verdicts = comparison.distances[i].verdicts;
    const std::size_t wide = 2 * kNumber;
    text += column(world ? "in world units" : "in voxels", kName) + column("reference", wide) +
            column("other", wide);
    if (!world && !verdicts.empty())
        text += column("distance", kNumber) + column("sigma", kNumber) + column("sigmas away", kNumber);
    text += "\n";
    for (std::size_t s = 0; s < std::min(reference.statistics.size(), other.statistics.size()); ++s) {
        const Statistic &a = reference.statistics[s], &b = other.statistics[s];
        if (world && (a.power == 0 || a.curve)) continue;
        text += column(a.name, kName) + column(valueText(a, world ? reference.voxelSize : 1), wide) +
                column(valueText(b, world ? other.voxelSize : 1), wide);
        if (const Verdict* v = world ? nullptr : findVerdict(verdicts, b.name))
            text += column(shortNumber(v->distance), kNumber) + column(shortNumber(v->sigma), kNumber) +
                    column(shortNumber(v->away()), kNumber) + (v->passes() ? "pass" : "FAR");
        text += "\n";
    }
}

void appendCounts(const Comparison& comparison, std::size_t i, std::string& text) {
    const ModelStatistics &a = comparison.reference, &b = comparison.others[i];
    const auto row = [&](const std::string& name, double of, double other) {
        text += column(name, kName) + column(shortNumber(of), 2 * kNumber) + shortNumber(other) + "\n";
    };
    text += "\ncounts\n";
    row("solid components", double(a.topology.solid.sizes.size()), double(b.topology.solid.sizes.size()));
    const auto largest = [](const Components& c) { return c.sizes.empty() ? 0.0 : double(c.sizes.front()); };
    row("largest component (voxels)", largest(a.topology.solid), largest(b.topology.solid));
    row("void components", double(a.topology.empty.sizes.size()), double(b.topology.empty.sizes.size()));
    row("enclosed void components", a.topology.enclosed, b.topology.enclosed);
    row("Euler characteristic", a.topology.eulerCharacteristic, b.topology.eulerCharacteristic);
    if (!a.domainRecorded && !b.domainRecorded) row("tunnels", a.topology.tunnels, b.topology.tunnels);
    row("islands (components under " + std::to_string(comparison.islandLimit) + " voxels)", double(a.islands),
        double(b.islands));
    row("| |grad| - 1 |, mean", a.gradient.mean, b.gradient.mean);
    row("| |grad| - 1 |, 99th percentile", a.gradient.percentile99, b.gradient.percentile99);
    row("band completeness", a.bandCompleteness, b.bandCompleteness);
    for (const ModelStatistics* model : {&a, &b})
        if (model->thicknessCoarsening > 1)
            text += model->name + ": thickness was measured at a spacing of " +
                    std::to_string(model->thicknessCoarsening) + " voxels; --full measures it on all\n";
}

// Heights in world units, so that models of different voxels compare.
void appendRelief(const ModelStatistics& a, const ModelStatistics& b, std::string& text) {
    if (!a.relief || !b.relief) return;
    const auto row = [&](const std::string& name, double of, double other) {
        text += column(name, kName) + column(shortNumber(of), 2 * kNumber) + shortNumber(other) + "\n";
    };
    text += "\nrelief (world)\n";
    row("Sa", a.relief->sa * a.voxelSize, b.relief->sa * b.voxelSize);
    row("Sq", a.relief->sq * a.voxelSize, b.relief->sq * b.voxelSize);
    row("Ssk", a.relief->ssk, b.relief->ssk);
    row("Sku", a.relief->sku, b.relief->sku);
    const std::size_t octaves = std::min(a.relief->octaves.size(), b.relief->octaves.size());
    for (std::size_t i = 0; i < octaves; ++i) {
        const ReliefOctave &of = a.relief->octaves[i], &other = b.relief->octaves[i];
        row("waves of " + shortNumber(of.shortest * a.voxelSize) + " to " +
                shortNumber(of.longest * a.voxelSize),
            of.deviation * a.voxelSize, other.deviation * b.voxelSize);
    }
}

void appendDistances(const Comparison& comparison, std::size_t i, std::string& text) {
    const ModelDistances& d = comparison.distances[i];
    text += "\n" + column("distances (voxels), patches of", kName);
    for (std::size_t s = 0; s < d.scales.size(); ++s)
        text += column(std::to_string(kPatchSide << s) + " voxels", kNumber);
    text += "\n";
    const auto row = [&](const char* name, double ModelDistances::Scale::*member) {
        text += column(name, kName);
        for (const ModelDistances::Scale& scale : d.scales)
            text += column(shortNumber(scale.*member), kNumber);
        text += "\n";
    };
    row("sliced Wasserstein", &ModelDistances::Scale::wasserstein);
    row("coherence (other in reference)", &ModelDistances::Scale::coherence);
    row("completeness (reference in other)", &ModelDistances::Scale::completeness);
    for (const Verdict& v : scaleVerdicts(comparison, i))
        text += column(v.name, kName) + shortNumber(v.away()) + " sigmas away, " +
                (v.passes() ? "pass" : "FAR") + "\n";
    text += column("LP-IoU, LP-F, mean IoU", kName) + shortNumber(d.localPatches.shareIoU) + "  " +
            shortNumber(d.localPatches.shareScore) + "  " + shortNumber(d.localPatches.meanIoU) + "\n";
    if (d.surface)
        text += column("surface: mean, rms, Hausdorff", kName) + shortNumber(d.surface->mean) + "  " +
                shortNumber(d.surface->rootMean) + "  " + shortNumber(d.surface->hausdorff) + "\n";
    text += "\nnovelty: " + sourceText(d) + "\n";
    if (d.sourceKind == SourceKind::None) return;
    const Novelty& n = d.novelty;
    text += column("voxels in verbatim runs", kName) + shortNumber(n.verbatimShare) + "\n" +
            column("mean, largest run (voxels)", kName) + shortNumber(n.meanRun) + "  " +
            shortNumber(n.largestRun) + "\n" + column("largest run over reference", kName) +
            shortNumber(n.largestShare) + "\n" + column("share of the reference used", kName) +
            shortNumber(n.exemplarUsed) + "\n" + column("seam ratio, share of seams", kName) +
            shortNumber(n.seamRatio) + "  " + shortNumber(n.seamShare) + "\n";
}

void appendVerdict(const Comparison& comparison, std::size_t i, std::string& text) {
    const std::vector<Verdict>& verdicts = comparison.distances[i].verdicts;
    if (verdicts.empty()) {
        text +=
            "\nverdict: none; the reference is stationary along no axis, or too small along one; see "
            "--stationary\n";
        return;
    }
    const auto passed = std::count_if(verdicts.begin(), verdicts.end(),
                                      [](const Verdict& verdict) { return verdict.passes(); });
    text += "\nverdict: " + std::string(allPass(comparison.distances[i]) ? "pass" : "FAR") + ", " +
            std::to_string(passed) + " of " + std::to_string(verdicts.size()) + " within the spread of " +
            std::to_string(comparison.parts) + " sub-volumes along " + axesText(comparison.stationary) + "\n";
}

}  // namespace

std::string shortNumber(double value) {
    return roundedText(value, 4);
}

std::vector<Verdict> scaleVerdicts(const Comparison& comparison, std::size_t i) {
    std::vector<Verdict> found;
    const std::vector<Statistic>& statistics = comparison.others[i].statistics;
    for (const Verdict& verdict : comparison.distances[i].verdicts)
        if (std::none_of(statistics.begin(), statistics.end(),
                         [&](const Statistic& statistic) { return statistic.name == verdict.name; }))
            found.push_back(verdict);
    return found;
}

std::string axesText(const std::array<bool, 3>& axes) {
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (axes[axis]) text += char('x' + axis);
    return text.empty() ? "none" : text;
}

bool allPass(const ModelDistances& distances) {
    return std::all_of(distances.verdicts.begin(), distances.verdicts.end(),
                       [](const Verdict& verdict) { return verdict.passes(); });
}

std::string sourceText(const ModelDistances& distances) {
    const std::string share = shortNumber(100 * distances.verified) + " %";
    const std::string failed =
        distances.verified > 0 ? "the map is correct for only " + share + " of the voxels and is ignored; "
                               : "";
    switch (distances.sourceKind) {
        case SourceKind::Map:
            return "by the source map, correct for " + share + " of the voxels";
        case SourceKind::Matching:
            return failed + "copies searched in a box of " + sizeText(distances.looked) + " voxels";
        default:
            return failed + "no surface to search";
    }
}

std::string comparisonText(const Comparison& comparison) {
    std::string text;
    appendModel("reference", comparison.reference, text);
    for (std::size_t i = 0; i < comparison.others.size(); ++i) {
        appendModel("other", comparison.others[i], text);
        text += "\n";
        appendStatistics(comparison, i, false, text);
        if (comparison.reference.voxelSize != 1) {
            text += "\n";
            appendStatistics(comparison, i, true, text);
        }
        appendCounts(comparison, i, text);
        appendRelief(comparison.reference, comparison.others[i], text);
        appendDistances(comparison, i, text);
        appendVerdict(comparison, i, text);
    }
    if (comparison.yardsticks.empty()) return text;
    text += "\n" + column("yardstick: 1 is another exemplar", kName) + column("results", kNumber) +
            column("fresh", kNumber) + column("shifted", kNumber) + "ratio\n";
    for (const Yardstick& y : comparison.yardsticks)
        text += column(y.name, kName) + column(shortNumber(y.results), kNumber) +
                column(shortNumber(y.fresh), kNumber) + column(shortNumber(y.shifted), kNumber) +
                shortNumber(y.ratio()) + "\n";
    return text;
}

}  // namespace vdbsynth::cli
