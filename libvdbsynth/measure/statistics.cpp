#include "libvdbsynth/measure/statistics.h"

#include "libvdbsynth/grid/components.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/measure/correlation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

Statistic number(const char* name, int power, double value) {
    return {name, power, false, {value}};
}

// A density; 0 if a box is too thin to contain any of its units.
double per(double total, double volume) {
    return volume > 0 ? total / volume : 0;
}

void append(std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

// Running sums: distributions are compared cumulatively, so that a peak one voxel aside is close.
void appendSums(std::vector<double>& to, const std::vector<double>& shares) {
    double sum = 0;
    for (double share : shares) to.push_back(sum += share);
}

// True if the outermost voxels of the counted box are all void: what is inside is whole, whatever continues
// beyond.
bool isClear(const MeasuredModel& model) {
    const IndexBox& box = model.counted;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool low : {true, false}) {
            IndexBox layer = box;
            (low ? layer.max : layer.min)[axis] = (low ? box.min : box.max)[axis];
            if (model.solid.window(layer).count() > 0) return false;
        }
    return true;
}

bool isWholeModel(const MeasuredModel& model) {
    return model.beyond == Beyond::Void || isClear(model);
}

// A whole object is counted in full; its sub-volumes like those of a texture.
bool isWhole(const MeasuredModel& model, const IndexBox& box) {
    return box == model.counted && isWholeModel(model);
}

void addSurface(const MeasuredModel& model, const IndexBox& box, std::vector<Statistic>& all) {
    const bool whole = isWhole(model, box);
    // Within a voxel of a domain's face caps distort the surface; the caps themselves lie beyond it.
    IndexBox inner = box;
    for (int axis = 0; axis < 3; ++axis) {
        inner.min[axis] += whole ? -8 : box.min[axis] == model.counted.min[axis] ? 1 : 0;
        inner.max[axis] -= whole ? -8 : box.max[axis] == model.counted.max[axis] ? 1 : 0;
    }
    const SurfaceFunctionals surface = surfaceFunctionals(model.elements, inner);
    const double volume = whole ? double(box.volume()) : double(inner.volume());
    all.push_back(number("surface area per volume", -1, per(surface.area, volume)));
    all.push_back(number("mean curvature per volume", -2, per(surface.meanCurvature, volume)));
}

// Along x, y and z, for solid and void.
using LinesByAxis = std::array<LineStatistics, 6>;

LinesByAxis measureLines(const Occupancy& solid, int reach, const RunContext& ctx) {
    const Occupancy empty = solid.complement();
    LinesByAxis lines;
    parallelFor(ctx, lines.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            lines[i] = lineStatistics(i < 3 ? solid : empty, int(i % 3), reach);
    });
    return lines;
}

void addChords(const LinesByAxis& lines, std::size_t first, const std::string& of,
               std::vector<Statistic>& all) {
    Statistic mean{"mean chord" + of, 1, false, {}}, chords{"chord lengths" + of, 0, true, {}};
    for (std::size_t i = first; i < first + 3; ++i) {
        mean.values.push_back(lines[i].meanChord);
        appendSums(chords.values, lines[i].chords);
    }
    all.push_back(mean);
    all.push_back(chords);
}

void addThickness(const Thickness& thickness, const IndexBox& box, int reach, const std::string& name,
                  std::vector<Statistic>& all) {
    if (thickness.diameter.empty()) {
        for (const char* what : {" mean", " deviation"}) all.push_back({name + what, 1, false, {}});
        all.push_back({name + " distribution", 0, true, {}});
        return;
    }
    const ThicknessSummary summary = summarize(thickness, box, reach);
    all.push_back({name + " mean", 1, false, {summary.mean}});
    all.push_back({name + " deviation", 1, false, {summary.deviation}});
    Statistic curve{name + " distribution", 0, true, {}};
    appendSums(curve.values, summary.share);
    all.push_back(curve);
}

}  // namespace

void prepare(MeasuredModel& model, int coarsening, const RunContext& ctx) {
    model.elements = surfaceElements(model.surface, ctx);
    model.solid = Occupancy::fromField(*model.field, ctx);
    const Distances distances = distancesToSurface(*model.field, model.band, coarsening, ctx);
    model.thickness = localThickness(distances, coarsening, Phase::Solid, ctx);
    if (model.beyond == Beyond::Unknown)
        model.pores = localThickness(distances, coarsening, Phase::Void, ctx);
}

std::vector<Statistic> measureStatistics(const MeasuredModel& model, const IndexBox& box, int reach,
                                         const RunContext& ctx) {
    const bool whole = isWhole(model, box);
    const Occupancy solid = model.solid.window(box);
    std::vector<Statistic> all;
    all.push_back(number("volume fraction", 0, double(solid.count()) / solid.volume()));
    addSurface(model, box, all);
    const double corners = whole ? double(box.volume()) : eulerVolume(box.size(), Beyond::Unknown);
    const double euler = eulerCharacteristic(model.beyond == Beyond::Void && whole ? model.solid : solid,
                                             whole ? Beyond::Void : Beyond::Unknown);
    all.push_back(number("Euler characteristic per volume", -3, per(euler, corners)));
    addThickness(model.thickness, box, reach, "local thickness", all);
    addThickness(model.pores, box, reach, "pore size", all);
    const LinesByAxis lines = measureLines(solid, reach, ctx);
    addChords(lines, 0, "", all);
    addChords(lines, 3, " of void", all);
    Statistic path{"lineal path", 0, true, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) append(path.values, lines[axis].linealPath);
    all.push_back(path);
    const TwoPointCorrelation correlation = twoPointCorrelation(solid, reach, ctx);
    all.push_back({"two-point correlation", 0, true, correlation.radial});
    Statistic axes{"two-point correlation by axis", 0, true, {}};
    for (const std::vector<double>& curve : correlation.axis) append(axes.values, curve);
    all.push_back(axes);
    return all;
}

Topology measureTopology(const MeasuredModel& model, const RunContext& ctx) {
    const bool whole = isWholeModel(model);
    const Occupancy solid = model.beyond == Beyond::Void ? model.solid : model.solid.window(model.counted);
    Topology topology;
    parallelFor(ctx, 2, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (i == 0)
                topology.solid = findComponents(solid, Neighbours::All);
            else
                topology.empty = findComponents(solid.complement(), Neighbours::Faces);
    });
    topology.enclosed = double(topology.empty.interior.size());
    const double euler = eulerCharacteristic(solid, whole ? Beyond::Void : Beyond::Unknown);
    topology.eulerCharacteristic =
        whole ? euler : per(euler, eulerVolume(solid.size(), Beyond::Unknown)) * solid.volume();
    if (whole) topology.tunnels = double(topology.solid.sizes.size()) + topology.enclosed - euler;
    return topology;
}

GradientError measureGradient(const MeasuredModel& model, const RunContext& ctx) {
    const BrickField& field = *model.field;
    const IndexBox box = model.counted.expanded(model.beyond == Beyond::Void ? 1 : -2);
    if (box.empty()) return {};
    std::vector<std::vector<float>> planes(std::size_t(box.size().x));
    parallelFor(ctx, planes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t plane = begin; plane < end; ++plane)
            for (int y = box.min.y; y <= box.max.y; ++y)
                for (int z = box.min.z; z <= box.max.z; ++z) {
                    const Index3 p{box.min.x + int(plane), y, z};
                    const float value = field.inside(p), sign = value < 0 ? -1.f : 1.f;
                    if (std::abs(value) >= 1) continue;
                    float central = 0, upwind = 0;
                    for (int axis = 0; axis < 3; ++axis) {
                        Index3 low = p, high = p;
                        --low[axis];
                        ++high[axis];
                        const float before = field.at(low), after = field.at(high);
                        const float drop = std::max({0.f, sign * (value - before), sign * (value - after)});
                        central += (after - before) * (after - before) / 4;
                        upwind += drop * drop;
                    }
                    planes[plane].push_back(
                        std::min(std::abs(std::sqrt(central) - 1), std::abs(std::sqrt(upwind) - 1)));
                }
    });
    std::vector<float> all;
    for (const std::vector<float>& plane : planes) all.insert(all.end(), plane.begin(), plane.end());
    GradientError error;
    if (all.empty()) return error;
    for (float value : all) error.mean += double(value) / double(all.size());
    const auto p99 = all.begin() + std::ptrdiff_t((all.size() - 1) * 99 / 100);
    std::nth_element(all.begin(), p99, all.end());
    error.percentile99 = double(*p99);
    return error;
}

double statisticDistance(const Statistic& a, const Statistic& b) {
    const std::size_t n = std::min(a.values.size(), b.values.size());
    double squares = 0;
    for (std::size_t i = 0; i < n; ++i) squares += (a.values[i] - b.values[i]) * (a.values[i] - b.values[i]);
    return n == 0 ? 0 : std::sqrt(squares / double(n));
}

}  // namespace vdbsynth
