#include "libvdbsynth/pipeline/patch/patch_onto_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace vdbsynth {
namespace {

const char* const kLabels = "patch_onto";
const char* const kSites = "patch_onto_sites";
const char* const kPatches = "vdbsynth:patches";
const char* const kRun = "vdbsynth:onto";
constexpr double kMostNodes = 2147483648.0;
constexpr std::size_t kMostPatches = std::size_t(1) << 24;

openvdb::Coord coordOf(std::size_t site, int k) {
    return {int(site >> 6), int(site & 63), k};
}

std::string runText(const PatchSource& source, const PatchedModel& patched, const PatchOntoOptions& options) {
    const PatchExemplar& exemplar = source.exemplar;
    const OntoArrangement& a = patched.result.arrangement;
    const Vec3d high = exemplar.corner + fromPlane(exemplar.plane, exemplar.size), o = patched.origin;
    std::string text = std::to_string(patched.surface.sites.size()) + " " + std::to_string(a.nz) + " ";
    for (const double real :
         {a.step, a.overlap, options.onto.scale, patched.result.zero, o.x, o.y, o.z, exemplar.corner.x,
          exemplar.corner.y, exemplar.corner.z, high.x, high.y, high.z})
        text += exactText(real) + " ";
    for (const int whole : {int(options.onto.warp), int(options.onto.blend), int(exemplar.plane)})
        text += std::to_string(whole) + " ";
    return text;
}

std::string patchesText(const std::vector<OntoPatch>& patches) {
    std::string text;
    for (const OntoPatch& p : patches) {
        text += std::to_string(p.disk.centre) + " ";
        for (const double real : {p.radius, p.from.x, p.from.y, double(p.turn.x), double(p.turn.y), p.cost})
            text += exactText(real) + " ";
        text += "\n";
    }
    return text;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": its map of patches over a model " + what);
}

std::string metaText(const openvdb::GridBase& grid, const char* name) {
    const auto meta = grid.getMetadata<openvdb::StringMetadata>(name);
    return meta ? meta->value() : std::string();
}

// @return the number of sites
std::size_t readRun(const std::string& path, const std::string& text, PatchOntoMapFile& map) {
    std::istringstream in(text);
    std::size_t sites = 0;
    OntoArrangement& a = map.arrangement;
    int warp = 0, blend = 0, plane = 0;
    in >> sites >> a.nz >> a.step >> a.overlap >> map.options.scale >> map.zero >> map.origin.x >>
        map.origin.y >> map.origin.z >> map.box.min.x >> map.box.min.y >> map.box.min.z >> map.box.max.x >>
        map.box.max.y >> map.box.max.z >> warp >> blend >> plane;
    const bool good = in && sites > 0 && a.nz > 0 && double(sites) * double(a.nz) < kMostNodes &&
                      a.step > 0 && a.overlap >= 0 && a.overlap < 64 * a.step && plane >= 0 && plane <= 2;
    if (!good) refuse(path, "is damaged");
    map.options.warp = warp != 0;
    map.options.blend = blend != 0;
    map.plane = PatchPlane(plane);
    validate(map.options);
    return sites;
}

void readPatches(const std::string& path, const std::string& text, std::size_t sites, PatchOntoMapFile& map) {
    std::istringstream in(text);
    OntoPatch p;
    while (in >> p.disk.centre >> p.radius >> p.from.x >> p.from.y >> p.turn.x >> p.turn.y >> p.cost) {
        const double turn = double(p.turn.x) * double(p.turn.x) + double(p.turn.y) * double(p.turn.y);
        const bool good = p.disk.centre < sites && p.radius > 0 && p.radius < 1e4 * map.arrangement.step &&
                          std::abs(turn - 1) < 0.01;
        if (!good || map.arrangement.patches.size() == kMostPatches)
            refuse(path, "has a patch that cannot be");
        map.arrangement.patches.push_back(p);
    }
    if (map.arrangement.patches.empty()) refuse(path, "has no patches");
}

void readSites(const std::string& path, const openvdb::Vec3SGrid& grid, std::size_t sites,
               PatchOntoMapFile& map) {
    const auto accessor = grid.getConstAccessor();
    std::vector<Vec3f>* const lists[3] = {&map.points, &map.normals, &map.tangents};
    for (std::size_t site = 0; site < sites; ++site)
        for (int list = 0; list < 3; ++list) {
            const openvdb::Vec3s value = accessor.getValue(coordOf(site, list));
            const Vec3f vector{value[0], value[1], value[2]};
            const float size = length(vector);
            if (!std::isfinite(size) || (list > 0 && std::abs(size - 1) > 0.01f))
                refuse(path, "has a site that cannot be");
            lists[list]->push_back(vector);
        }
}

}  // namespace

std::vector<GridPtr> patchOntoMapGrids(const PatchSource& source, const PatchedModel& patched,
                                       const PatchOntoOptions& options) {
    const OntoArrangement& a = patched.result.arrangement;
    const OntoSurface& surface = patched.surface;
    auto labels = openvdb::Int32Grid::create(OntoArrangement::kNone);
    auto sites = openvdb::Vec3SGrid::create();
    auto label = labels->getAccessor();
    auto vector = sites->getAccessor();
    const auto vec = [](const Vec3f& v) { return openvdb::Vec3s(v.x, v.y, v.z); };
    for (std::size_t site = 0; site < surface.sites.size(); ++site) {
        for (int k = 0; k < a.nz; ++k) label.setValue(coordOf(site, k), a.column(std::uint32_t(site))[k]);
        vector.setValue(coordOf(site, 0), vec(surface.sites.point[site]));
        vector.setValue(coordOf(site, 1), vec(surface.sites.normal[site]));
        vector.setValue(coordOf(site, 2), vec(surface.tangent[site]));
    }
    labels->setName(kLabels);
    labels->insertMeta(kPatches, openvdb::StringMetadata(patchesText(a.patches)));
    labels->insertMeta(kRun, openvdb::StringMetadata(runText(source, patched, options)));
    sites->setName(kSites);
    return {labels, sites};
}

std::optional<PatchOntoMapFile> patchOntoMapFrom(const std::string& path, const std::vector<GridPtr>& grids) {
    openvdb::Int32Grid::ConstPtr labels;
    openvdb::Vec3SGrid::ConstPtr places;
    for (const GridPtr& grid : grids) {
        if (grid->getName() == kLabels) labels = openvdb::gridConstPtrCast<openvdb::Int32Grid>(grid);
        if (grid->getName() == kSites) places = openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(grid);
    }
    if (!labels) return std::nullopt;
    if (!places) refuse(path, "has no sites");
    PatchOntoMapFile map;
    const std::size_t sites = readRun(path, metaText(*labels, kRun), map);
    if (std::size_t(places->activeVoxelCount()) != 3 * sites) refuse(path, "has another number of sites");
    readPatches(path, metaText(*labels, kPatches), sites, map);
    readSites(path, *places, sites, map);
    const auto accessor = labels->getConstAccessor();
    for (std::size_t site = 0; site < sites; ++site)
        for (int k = 0; k < map.arrangement.nz; ++k) {
            const std::int32_t label = accessor.getValue(coordOf(site, k));
            if (label < OntoArrangement::kNone || label >= std::int32_t(map.arrangement.patches.size()))
                refuse(path, "names a patch that is not there");
            map.arrangement.label.push_back(label);
        }
    return map;
}

PatchedModel repeatPatchOnto(const PatchSource& source, const PatchOntoMapFile& map, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        PatchedModel patched;
        patched.exemplar = scaledExemplar(source.exemplar, map.options.scale);
        patched.surface = ontoSurfaceAlong(map.points, map.normals, map.tangents, ctx);
        patched.origin = map.origin;
        patched.result =
            repeatOnto(patched.exemplar, patched.surface, map.arrangement, map.zero, map.options, ctx);
        return patched;
    });
}

}  // namespace vdbsynth
