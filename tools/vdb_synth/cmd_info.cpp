#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/raster/raster_alignment.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "tools/vdb_synth/surface_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace vdbsynth::cli {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}
Json triple(const Index3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json meshInfo(const std::string& path, const Run& run) {
    Mesh mesh = readMesh(path, run.context);
    // Vertices that a texture seam splits are one point of the surface.
    if (findAttribute(mesh.attributes, "uv")) weldVertices(mesh);
    const MeshSummary s = summarize(mesh);
    Json json{{"file", run.withoutTemporaries(path)},
              {"kind", "mesh"},
              {"vertices", s.vertices},
              {"faces", s.faces}};
    json.update(surfaceJson(mesh, run.context));
    json.update(Json{{"open_edges", s.openEdges},
                     {"non_manifold_edges", s.nonManifoldEdges},
                     {"misoriented_edges", s.misorientedEdges},
                     {"closed_manifold", s.closedManifold()}});
    return json;
}

Json pointsInfo(const std::string& path, const Run& run) {
    const PointFile file = readPoints(path, run.context);
    const Vec3d& origin = file.cloud.origin;
    Vec3f low = file.cloud.points.front(), high = low;
    for (const Vec3f& p : file.cloud.points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    return Json{{"file", run.withoutTemporaries(path)},
                {"kind", "points"},
                {"points", file.cloud.points.size()},
                {"invalid_points", file.invalid},
                {"normals", !file.cloud.normals.empty()},
                {"bounds_min", triple(origin + cast<double>(low))},
                {"bounds_max", triple(origin + cast<double>(high))}};
}

Json rasterInfo(const std::string& path, const Run& run) {
    const Raster raster = readRaster(path, {run.arguments.text("grid")}, run.context);
    const RasterRange range = rangeOf(raster);
    Json info{{"file", run.withoutTemporaries(path)},
              {"kind", raster.stack || raster.size.z > 1 ? "volume" : "image"},
              {"size", triple(raster.size)},
              {"channels", raster.channels},
              {"minimum", range.minimum},
              {"maximum", range.maximum},
              {"white", raster.white > 0 ? Json(raster.white) : Json(nullptr)},
              {"whole_numbers", range.whole},
              {"distinct_values", range.distinct.empty() ? Json("over 256") : Json(range.distinct.size())},
              {"samples_without_data", range.missing},
              {"infinite_samples", range.infinite}};
    if (raster.arrays.size() > 1) info["arrays"] = raster.arrays;
    if (raster.knownSpacing) {
        info["spacing"] = triple(raster.spacing);
        info["origin"] = triple(raster.origin);
        if (!runAlongWorld(raster.axes))
            info["axes"] =
                Json::array({triple(raster.axes[0]), triple(raster.axes[1]), triple(raster.axes[2])});
        info["unit"] = raster.unit.empty() ? Json(nullptr) : Json(raster.unit);
    }
    return info;
}

// A point p of index space is at rows 0 to 2 of the matrix times (p, 1).
Json rowsOf(const Affine& m) {
    Json rows = Json::array();
    for (std::size_t r = 0; r < 4; ++r) rows.push_back(Json::array({m[r], m[4 + r], m[8 + r], m[12 + r]}));
    return rows;
}

// The box in the world around all active voxels' cubes.
void placeInWorld(const GridSummary& s, Json& grid) {
    Vec3d low, high;
    for (int corner = 0; corner < 8; ++corner) {
        Vec3d at;
        for (int axis = 0; axis < 3; ++axis)
            at[axis] = corner >> axis & 1 ? s.activeBox.max[axis] + 0.5 : s.activeBox.min[axis] - 0.5;
        const Vec3d world = transformed(s.transform, at);
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = corner ? std::min(low[axis], world[axis]) : world[axis];
            high[axis] = corner ? std::max(high[axis], world[axis]) : world[axis];
        }
    }
    grid["world_min"] = triple(low);
    grid["world_max"] = triple(high);
}

Json gridInfo(const GridSummary& s) {
    Json grid{{"name", s.name},
              {"type", s.type},
              {"class", s.gridClass},
              {"voxel_size", triple(s.voxelSize)},
              {"linear", s.linear},
              {"half_precision", s.halfPrecision},
              {"active_voxels", s.activeVoxels}};
    if (s.activeVoxels > 0) {
        grid["active_min"] = triple(s.activeBox.min);
        grid["active_max"] = triple(s.activeBox.max);
        if (s.linear) placeInWorld(s, grid);
    }
    if (s.linear) grid["index_to_world"] = rowsOf(s.transform);
    if (s.isFloat) {
        grid["background"] = s.background;
        grid["minimum"] = s.minimum;
        grid["maximum"] = s.maximum;
        grid["finite"] = s.finite;
    }
    Json metadata = Json::object();
    for (const auto& [name, value] : s.metadata) metadata[name] = value;
    grid["metadata"] = metadata;
    return grid;
}

// Why a level set is no valid narrow band, each with what helps.
std::vector<std::string> faultsOf(const BandQuality& quality) {
    constexpr double kMostError = 0.15;
    std::vector<std::string> faults;
    if (!quality.finite) faults.push_back("it has values that are no finite numbers");
    if (!(quality.gradientErrorMean < kMostError))
        faults.push_back("its values are no distances: | |grad| - 1 | is " +
                         roundedText(quality.gradientErrorMean, 3) + " in the mean, under " +
                         roundedText(kMostError, 3) + " is good; convert IN.vdb -o OUT.vdb rebuilds them");
    if (quality.missingNeighbours > 0)
        faults.push_back(std::to_string(quality.missingNeighbours) +
                         " voxels next to the surface have inactive neighbours; convert IN.vdb -o OUT.vdb "
                         "rebuilds the band");
    return faults;
}

Json vdbInfo(const std::string& path, Run& run) {
    Json info{{"file", run.withoutTemporaries(path)}, {"kind", "vdb"}};
    Json grids = Json::array();
    const VdbContents contents = readVdb(path, run.context);
    Json metadata = Json::object();
    for (const auto& [name, value] : contents.metadata) metadata[name] = value;
    info["metadata"] = metadata;
    for (const GridSummary& summary : summarizeGrids(contents.grids)) grids.push_back(gridInfo(summary));
    info["grids"] = grids;
    try {
        VdbReadOptions read;
        read.gridName = run.arguments.text("grid");
        if (run.arguments.has("iso")) read.iso = run.arguments.real("iso");
        const LevelSet model = modelFromGrids(path, contents.grids, read, run.context);
        const BandQuality quality = measureBand(*model.grid, run.context);
        info["model"] = surfaceJson(levelSetToMesh(*model.grid, {}, run.context), run.context);
        info["model"].update(Json{{"voxel_size", voxelSizeOf(*model.grid)},
                                  {"half_width", halfWidthOf(*model.grid)},
                                  {"domain", boxText(model.domain)},
                                  {"domain_recorded", model.domainRecorded},
                                  {"solid_voxels", solidVoxels(*model.grid)},
                                  {"active_voxels", activeVoxels(*model.grid)},
                                  {"gradient_error_mean", quality.gradientErrorMean},
                                  {"gradient_error_p99", quality.gradientErrorP99},
                                  {"band_gaps", quality.missingNeighbours},
                                  {"valid", faultsOf(quality).empty()}});
        if (!faultsOf(quality).empty()) info["model"]["not_valid_because"] = faultsOf(quality);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::Cancelled) throw;
        info["model"] = nullptr;
        info["not_a_model"] = run.inWords(error.what());
    }
    return info;
}

void printText(const Json& json, const std::string& indent) {
    for (const auto& [key, value] : json.items()) {
        if (value.is_object()) {
            if (value.empty()) continue;
            printLine(indent + key + ":");
            printText(value, indent + "  ");
        } else if (value.is_array() && !value.empty() && value[0].is_object()) {
            for (const Json& item : value) {
                printLine(indent + key + ":");
                printText(item, indent + "  ");
            }
        } else {
            printLine(indent + key + ": " +
                      (value.is_string() ? value.get<std::string>()
                                         : value.dump(-1, ' ', false, Json::error_handler_t::replace)));
        }
    }
}

void info(Run& run) {
    run.requireInputs(1, 1);
    const std::string path = run.arguments.inputs[0];
    requireModelPath(path);
    run.reserveOutputs();
    const Json json = isPointPath(path) || holdsPoints(path) ? pointsInfo(path, run)
                      : isMeshPath(path)                     ? meshInfo(path, run)
                      : isRasterPath(path)                   ? rasterInfo(path, run)
                                                             : vdbInfo(path, run);
    if (run.arguments.has("json") || run.arguments.has("output"))
        run.answer(json.dump(2, ' ', false, Json::error_handler_t::replace));
    else
        printText(json, "");
    run.noteInput(path);
    run.finish();
}

}  // namespace

const Command kInfo{"info", "info IN [--json] [-o OUT.json]",
                    "Print what is in a file: grids or faces, sizes, ranges, validity",
                    "vdb_synth info grid.vdb", info};

}  // namespace vdbsynth::cli
