// A comparison in JSON.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/measure/patch_distribution.h"
#include "libvdbsynth/measure/verdict.h"
#include "tools/vdb_synth/compare_report.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Index3& p) {
    return Json::array({p.x, p.y, p.z});
}

Json boxJson(const IndexBox& box) {
    return Json{{"min", triple(box.min)}, {"max", triple(box.max)}};
}

Json partsJson(const Components& parts) {
    constexpr std::size_t kMost = 100;
    const std::size_t count = std::min(kMost, parts.sizes.size());
    return Json{{"count", parts.sizes.size()},
                {"off_the_faces", parts.interior.size()},
                {"largest_voxels", std::vector<std::uint64_t>(parts.sizes.begin(),
                                                              parts.sizes.begin() + std::ptrdiff_t(count))}};
}

Json reliefJson(const ReliefStatistics& relief, double voxel) {
    Json octaves = Json::array();
    for (const ReliefOctave& octave : relief.octaves)
        octaves.push_back({{"shortest_wave", octave.shortest * voxel},
                           {"longest_wave", octave.longest * voxel},
                           {"deviation", octave.deviation * voxel}});
    return Json{{"Sa", relief.sa * voxel},
                {"Sq", relief.sq * voxel},
                {"Ssk", relief.ssk},
                {"Sku", relief.sku},
                {"octaves", octaves}};
}

Json modelJson(const ModelStatistics& model) {
    Json statistics = Json::array();
    for (const Statistic& statistic : model.statistics) {
        Json entry{{"name", statistic.name}};
        if (!statistic.measured()) {
            entry[statistic.curve ? "curve" : "voxels"] = nullptr;
            if (!statistic.curve) entry["world"] = nullptr;
        } else if (statistic.curve) {
            entry["curve"] = statistic.values;
        } else {
            std::vector<double> world;
            for (double value : statistic.values)
                world.push_back(value * std::pow(model.voxelSize, statistic.power));
            entry["voxels"] = statistic.values;
            entry["world"] = world;
        }
        statistics.push_back(entry);
    }
    Json json{{"name", model.name},
              {"kind", model.domainRecorded ? "texture" : "object"},
              {"domain", boxJson(model.domain)},
              {"voxel_size", model.voxelSize},
              {"statistics", statistics},
              {"solid", partsJson(model.topology.solid)},
              {"void", partsJson(model.topology.empty)},
              {"enclosed_voids", model.topology.enclosed},
              {"euler_characteristic", model.topology.eulerCharacteristic},
              {"tunnels", model.domainRecorded ? Json(nullptr) : Json(model.topology.tunnels)},
              {"crumbs", model.islands},
              {"gradient_error_mean", model.gradient.mean},
              {"gradient_error_p99", model.gradient.percentile99},
              {"band_completeness", model.bandCompleteness},
              {"thickness_sample_voxels", model.thicknessCoarsening}};
    if (model.relief) json["relief"] = reliefJson(*model.relief, model.voxelSize);
    return json;
}

Json noveltyJson(const ModelDistances& d) {
    const char* kind = d.sourceKind == SourceKind::Map        ? "map"
                       : d.sourceKind == SourceKind::Matching ? "matching"
                                                              : "none";
    Json json{{"sources", kind}, {"map_verified_share", d.verified}};
    if (d.sourceKind == SourceKind::Matching) json["box_looked_at"] = boxJson(d.looked);
    if (d.sourceKind == SourceKind::None) return json;
    json["verbatim_share"] = d.novelty.verbatimShare;
    json["mean_run_voxels"] = d.novelty.meanRun;
    json["largest_run_voxels"] = d.novelty.largestRun;
    json["largest_run_share"] = d.novelty.largestShare;
    json["reference_used"] = d.novelty.exemplarUsed;
    json["seam_ratio"] = d.novelty.seamRatio;
    json["seam_share"] = d.novelty.seamShare;
    return json;
}

Json distancesJson(const ModelDistances& d) {
    Json scales = Json::array(), verdicts = Json::array();
    for (std::size_t s = 0; s < d.scales.size(); ++s)
        scales.push_back({{"patch_voxels", kPatchSide << s},
                          {"sliced_wasserstein", d.scales[s].wasserstein},
                          {"coherence", d.scales[s].coherence},
                          {"completeness", d.scales[s].completeness}});
    for (const Verdict& v : d.verdicts)
        verdicts.push_back({{"name", v.name},
                            {"mean", v.mean},
                            {"sigma", v.sigma},
                            {"distance", v.distance},
                            {"sigmas_away", v.away()},
                            {"quartile", v.quartile},
                            {"passes", v.passes()}});
    return Json{{"patches", scales},
                {"lp_iou", d.localPatches.shareIoU},
                {"lp_f", d.localPatches.shareScore},
                {"lp_mean_iou", d.localPatches.meanIoU},
                {"surface", d.surface ? Json{{"mean", d.surface->mean},
                                             {"rms", d.surface->rootMean},
                                             {"hausdorff", d.surface->hausdorff}}
                                      : Json(nullptr)},
                {"novelty", noveltyJson(d)},
                {"verdicts", verdicts},
                {"passes", d.verdicts.empty() ? Json(nullptr) : Json(allPass(d))}};
}

}  // namespace

nlohmann::ordered_json comparisonJson(const Comparison& comparison) {
    Json others = Json::array(), yardsticks = Json::array();
    for (std::size_t i = 0; i < comparison.others.size(); ++i) {
        Json other = modelJson(comparison.others[i]);
        other["distances"] = distancesJson(comparison.distances[i]);
        others.push_back(other);
    }
    for (const Yardstick& y : comparison.yardsticks)
        yardsticks.push_back({{"name", y.name},
                              {"results", y.results},
                              {"fresh", y.fresh},
                              {"shifted", y.shifted},
                              {"ratio", y.ratio()}});
    return Json{{"reference", modelJson(comparison.reference)},
                {"others", others},
                {"stationary", axesText(comparison.stationary)},
                {"sub_volumes", comparison.parts},
                {"crumb_limit_voxels", comparison.islandLimit},
                {"curve_reach_voxels", comparison.reach},
                {"yardstick", yardsticks}};
}

}  // namespace vdbsynth::cli
