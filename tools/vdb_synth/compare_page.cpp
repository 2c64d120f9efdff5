// A comparison as one page: models to turn, slices, verdicts, curves. The page is self-contained; its script
// turns the models (view_page.h) and shows a curve's value under the pointer.
#include "tools/vdb_synth/compare_report.h"
#include "tools/vdb_synth/html_text.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/measure/patch_distribution.h"
#include "libvdbsynth/measure/verdict.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {
namespace {

const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1100px; padding: 0 1em; color: #1c2228; background: #fff }
h1 { font-size: 1.5em } h2 { font-size: 1.15em; margin-top: 2em }
table { border-collapse: collapse; width: 100% } th, td { text-align: left; padding: .25em .6em; border-bottom: 1px solid #dfe4e8; font-variant-numeric: tabular-nums }
th { font-weight: 600; color: #55606a } .pass { color: #17693b } .far { color: #a62b1f; font-weight: 600 }
.models, .curves { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 1em }
figure { margin: 0 } img, svg { width: 100%; height: auto; border: 1px solid #dfe4e8; background: #fff } figcaption { color: #55606a; font-size: .9em }
.verdict { font-size: 1.2em; padding: .5em .8em; background: #f2f5f7; display: inline-block }
figure.viewer canvas { width: 100%; aspect-ratio: 6 / 5 }
)";

const char* kScript = R"(<script>
for (const svg of document.querySelectorAll("svg[data-curves]")) {
  const curves = JSON.parse(svg.dataset.curves), note = svg.parentNode.querySelector("output");
  svg.addEventListener("mousemove", event => {
    const box = svg.getBoundingClientRect(), n = curves[0].values.length;
    const i = Math.max(0, Math.min(n - 1, Math.round(((event.clientX - box.left) / box.width * 400 - 40) / 350 * (n - 1))));
    note.textContent = " at " + i + ": " + curves.map(c => c.name + " " + (+c.values[i]).toPrecision(3)).join(", ");
  });
}
document.body.dataset.ready = "yes";
</script>)";

const char* const kColours[] = {"#55606a", "#c2571a", "#2166ac", "#17693b", "#7b3294", "#a67c00"};

std::string image(const Picture& picture, const std::string& what) {
    return "<img alt=\"" + htmlText(what) + "\" src=\"data:image/png;base64," +
           base64Text(encodePng(picture)) + "\">";
}

// A name within a JSON string within an attribute.
std::string jsonName(const std::string& name) {
    std::string result;
    for (char c : name)
        if (c == '"' || c == '\\')
            result += std::string("\\") + c;
        else if (std::uint8_t(c) >= 32)
            result += c;
    return result;
}

std::string pair(double x, double y) {
    return fixedText(x, 1) + "," + fixedText(y, 1) + " ";
}

struct NamedCurve {
    std::string name;
    std::vector<double> values;
};

// The curves of all models for one statistic; r = 0 .. n - 1 from left to right.
std::string chart(const std::string& title, const std::vector<NamedCurve>& curves) {
    double low = 0, high = 0;
    std::size_t n = 2;
    for (const NamedCurve& curve : curves)
        for (double value : curve.values) {
            low = std::min(low, value);
            high = std::max(high, value);
            n = std::max(n, curve.values.size());
        }
    if (high <= low) high = low + 1;
    std::string lines, json;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        if (curves[c].values.empty()) continue;
        std::string points, values;
        for (std::size_t i = 0; i < curves[c].values.size(); ++i) {
            const double value = curves[c].values[i];
            points += pair(40 + 350.0 * double(i) / double(n - 1), 190 - 170 * (value - low) / (high - low));
            values += (i ? "," : "") + shortNumber(value);
        }
        lines += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" +
                 std::string(kColours[c % std::size(kColours)]) + "\" points=\"" + points + "\"/>";
        json += std::string(json.empty() ? "" : ",") + "{\"name\":\"" + jsonName(curves[c].name) +
                "\",\"values\":[" + values + "]}";
    }
    return "<figure><svg viewBox=\"0 0 400 210\" data-curves=\"" + htmlText("[" + json + "]") +
           "\"><g font-size=\"11\" fill=\"#55606a\"><text x=\"2\" y=\"24\">" + shortNumber(high) +
           "</text><text x=\"2\" y=\"194\">" + shortNumber(low) + "</text><text x=\"40\" y=\"206\">0</text>" +
           "<text x=\"390\" y=\"206\" text-anchor=\"end\">" + std::to_string(n - 1) +
           " voxels</text></g><path d=\"M40 20V190H390\" fill=\"none\" stroke=\"#b8c0c7\"/>" + lines +
           "</svg><figcaption>" + htmlText(title) + "<output></output></figcaption></figure>\n";
}

// A statistic with one curve per axis holds them one after another.
std::string charts(const Comparison& comparison, std::size_t s) {
    const Statistic& first = comparison.reference.statistics[s];
    const std::size_t length = std::size_t(comparison.reach) + 1;
    std::string html;
    for (std::size_t part = 0; part < first.values.size() / length; ++part) {
        std::vector<NamedCurve> curves;
        const auto add = [&](const ModelStatistics& model) {
            const std::vector<double>& values = model.statistics.at(s).values;
            curves.push_back({model.name, {}});  // empty if not measured; keeps the model's colour
            if (values.size() < (part + 1) * length) return;
            const auto begin = values.begin() + std::ptrdiff_t(part * length);
            curves.back().values.assign(begin, begin + std::ptrdiff_t(length));
        };
        add(comparison.reference);
        for (const ModelStatistics& other : comparison.others) add(other);
        const bool several = first.values.size() > length;
        html += chart(first.name + (several ? std::string(", along ") + char('x' + int(part)) : ""), curves);
    }
    return html;
}

std::string cells(const std::vector<std::string>& texts, const char* tag = "td") {
    std::string row = "<tr>";
    for (const std::string& text : texts)
        row += "<" + std::string(tag) + ">" + text + "</" + std::string(tag) + ">";
    return row + "</tr>\n";
}

std::string verdictCell(const Verdict& verdict) {
    return verdict.passes() ? "<span class=\"pass\">pass</span>" : "<span class=\"far\">far</span>";
}

std::string numbers(const Statistic& statistic) {
    if (!statistic.measured()) return "-";
    if (statistic.curve) return "curve";
    std::string text;
    for (double value : statistic.values) text += (text.empty() ? "" : ", ") + shortNumber(value);
    return text;
}

std::string statisticsTable(const Comparison& comparison, std::size_t i) {
    const ModelStatistics &reference = comparison.reference, &other = comparison.others[i];
    const std::vector<Verdict>& verdicts = comparison.distances[i].verdicts;
    std::string html =
        "<table>" + cells({"statistic (voxels)", htmlText(reference.name), htmlText(other.name), "distance",
                           "sigma of the sub-volumes", "sigmas away", "verdict"},
                          "th");
    const std::size_t count = std::min(reference.statistics.size(), other.statistics.size());
    for (std::size_t s = 0; s < count; ++s) {
        std::vector<std::string> row{htmlText(other.statistics[s].name), numbers(reference.statistics[s]),
                                     numbers(other.statistics[s])};
        const Statistic &a = reference.statistics[s], &b = other.statistics[s];
        if (const Verdict* v = findVerdict(verdicts, b.name))
            row.insert(row.end(), {shortNumber(v->distance), shortNumber(v->sigma), shortNumber(v->away()),
                                   verdictCell(*v)});
        else
            row.insert(row.end(), {a.measured() && b.measured() ? shortNumber(statisticDistance(a, b)) : "-",
                                   "", "", ""});
        html += cells(row);
    }
    for (const Verdict& v : scaleVerdicts(comparison, i))
        html += cells({htmlText(v.name), "0", shortNumber(v.distance), shortNumber(v.distance),
                       shortNumber(v.sigma), shortNumber(v.away()), verdictCell(v)});
    return html + "</table>\n";
}

std::string countsTable(const Comparison& comparison, std::size_t i) {
    const ModelStatistics &a = comparison.reference, &b = comparison.others[i];
    std::string html = "<table>" + cells({"counts", htmlText(a.name), htmlText(b.name)}, "th");
    const auto row = [&](const std::string& name, double of, double other) {
        html += cells({htmlText(name), shortNumber(of), shortNumber(other)});
    };
    row("solid components", double(a.topology.solid.sizes.size()), double(b.topology.solid.sizes.size()));
    row("void components", double(a.topology.empty.sizes.size()), double(b.topology.empty.sizes.size()));
    row("islands, components under " + std::to_string(comparison.islandLimit) + " voxels", double(a.islands),
        double(b.islands));
    row("Euler characteristic", a.topology.eulerCharacteristic, b.topology.eulerCharacteristic);
    row("| |grad| - 1 |, mean", a.gradient.mean, b.gradient.mean);
    row("| |grad| - 1 |, 99th percentile", a.gradient.percentile99, b.gradient.percentile99);
    row("band completeness", a.bandCompleteness, b.bandCompleteness);
    return html + "</table>\n";
}

std::string distancesTable(const ModelDistances& d) {
    std::string html = "<table>" + cells({"patches of", "sliced Wasserstein (voxels)", "coherence (voxels)",
                                          "completeness (voxels)"},
                                         "th");
    for (std::size_t s = 0; s < d.scales.size(); ++s)
        html += cells({std::to_string(kPatchSide << s) + " voxels", shortNumber(d.scales[s].wasserstein),
                       shortNumber(d.scales[s].coherence), shortNumber(d.scales[s].completeness)});
    html += "</table>\n<p>LP-IoU " + shortNumber(d.localPatches.shareIoU) + ", LP-F " +
            shortNumber(d.localPatches.shareScore) + ", mean best overlap " +
            shortNumber(d.localPatches.meanIoU);
    if (d.surface)
        html += ". Surfaces: mean distance " + shortNumber(d.surface->mean) + " voxels, Hausdorff " +
                shortNumber(d.surface->hausdorff);
    html += ".</p>\n<p>Novelty " + htmlText(sourceText(d));
    if (d.sourceKind != SourceKind::None)
        html += ": " + shortNumber(100 * d.novelty.verbatimShare) + " % in verbatim runs, the largest " +
                shortNumber(d.novelty.largestRun) + " voxels, " + shortNumber(100 * d.novelty.largestShare) +
                " % of the reference's; " + shortNumber(100 * d.novelty.exemplarUsed) +
                " % of the reference used; seam ratio " + shortNumber(d.novelty.seamRatio);
    return html + ".</p>\n";
}

std::string yardstickTable(const Comparison& comparison) {
    if (comparison.yardsticks.empty()) return "";
    std::string html =
        "<h2>Yardstick: 1 is as far as another exemplar of the process</h2><table>" +
        cells({"statistic", "results", "fresh exemplars", "shifted by half a voxel", "ratio"}, "th");
    for (const Yardstick& y : comparison.yardsticks)
        html += cells({htmlText(y.name), shortNumber(y.results), shortNumber(y.fresh), shortNumber(y.shifted),
                       "<span class=\"" + std::string(y.ratio() <= 1 ? "pass" : "far") + "\">" +
                           shortNumber(y.ratio()) + "</span>"});
    return html + "</table>\n";
}

std::string modelFigures(const Comparison& comparison, const std::vector<ModelPictures>& pictures) {
    std::string html = "<div class=\"models\">";
    for (std::size_t m = 0; m < pictures.size(); ++m) {
        const ModelStatistics& model = m == 0 ? comparison.reference : comparison.others[m - 1];
        const std::string name = (m == 0 ? "Reference " : "") + model.name;
        const Index3 size = model.domain.size();
        html += viewerFigure(pictures[m].viewer, image(pictures[m].shaded, name)) +
                image(pictures[m].slice, "slice of " + name) +
                "<figcaption><span style=\"color:" + kColours[m % std::size(kColours)] +
                "\">&#9632;</span> " + htmlText(name) + ", " + std::to_string(size.x) + " x " +
                std::to_string(size.y) + " x " + std::to_string(size.z) + " voxels of " +
                shortNumber(model.voxelSize) + "</figcaption></figure>\n";
    }
    return html + "</div>\n" + kViewerBar;
}

std::string otherSection(const Comparison& comparison, std::size_t i) {
    const ModelDistances& d = comparison.distances[i];
    std::string html = "<h2>" + htmlText(comparison.others[i].name) + "</h2>\n";
    if (d.verdicts.empty())
        html +=
            "<p class=\"verdict\">No verdict: the reference is stationary along no axis, or too small.</p>";
    else
        html += "<p class=\"verdict " + std::string(allPass(d) ? "pass\">Within" : "far\">Not within") +
                " the spread of the reference's own " + std::to_string(comparison.parts) +
                " sub-volumes along " + axesText(comparison.stationary) + "</p>";
    return html + statisticsTable(comparison, i) + countsTable(comparison, i) + distancesTable(d);
}

}  // namespace

std::string comparisonPage(const Comparison& comparison, const std::vector<ModelPictures>& pictures) {
    std::string title = comparison.reference.name + " and";
    for (const ModelStatistics& other : comparison.others) title += " " + other.name;
    std::string html = kHead + std::string(kViewerStyle) + "</style><title>" + htmlText(title) +
                       "</title></head><body>\n<h1>" + htmlText(title) + "</h1>\n" +
                       modelFigures(comparison, pictures);
    for (std::size_t i = 0; i < comparison.others.size(); ++i) html += otherSection(comparison, i);
    html += yardstickTable(comparison) + "<h2>Curves</h2>\n<div class=\"curves\">";
    for (std::size_t s = 0; s < comparison.reference.statistics.size(); ++s)
        if (comparison.reference.statistics[s].curve) html += charts(comparison, s);
    return html + "</div>\n" + kViewerScript + kScript + "\n</body></html>\n";
}

}  // namespace vdbsynth::cli
