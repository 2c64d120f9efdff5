#include "libvdbsynth/pipeline/patch/patch_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cstdio>
#include <sstream>

namespace vdbsynth {
namespace {

const char* const kLabels = "patch_label";
const char* const kPatches = "vdbsynth:patches";
const char* const kSheet = "vdbsynth:sheet";
constexpr std::size_t kMostPatches = std::size_t(1) << 26;

std::string patchesText(const std::vector<LaidPatch>& patches) {
    std::string text;
    for (const LaidPatch& p : patches) {
        for (const int whole : {p.from.i, p.from.j, p.at.i, p.at.j, p.nx, p.ny})
            text += std::to_string(whole) + " ";
        for (const double real : {p.fine.x, p.fine.y, p.fine.z, p.cost}) text += exactText(real) + " ";
        text += "\n";
    }
    return text;
}

std::string sheetText(const PatchSource& source, const PatchSheet& sheet, const PatchOptions& options) {
    const PatchExemplar& exemplar = source.exemplar;
    const PatchLattice& l = sheet.result.arrangement.lattice;
    const Vec3d high = exemplar.corner + fromPlane(exemplar.plane, exemplar.size);
    std::string text;
    for (const double real :
         {sheet.width, sheet.depth, sheet.border, options.overlap, l.step, exemplar.corner.x,
          exemplar.corner.y, exemplar.corner.z, high.x, high.y, high.z})
        text += exactText(real) + " ";
    for (const int whole : {l.nx, l.ny, l.nz, sheet.result.arrangement.overlap, int(options.tile),
                            int(options.warp), int(options.blend), int(exemplar.plane)})
        text += std::to_string(whole) + " ";
    return text;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": its map of patches " + what);
}

std::string metaText(const openvdb::GridBase& grid, const char* name) {
    const auto meta = grid.getMetadata<openvdb::StringMetadata>(name);
    return meta ? meta->value() : std::string();
}

void readSheet(const std::string& path, const std::string& text, PatchMapFile& map) {
    std::istringstream in(text);
    PatchLattice& l = map.arrangement.lattice;
    int tile = 0, warp = 0, blend = 0, plane = 0;
    in >> map.options.width >> map.options.depth >> map.options.border >> map.options.overlap >> l.step >>
        map.box.min.x >> map.box.min.y >> map.box.min.z >> map.box.max.x >> map.box.max.y >> map.box.max.z >>
        l.nx >> l.ny >> l.nz >> map.arrangement.overlap >> tile >> warp >> blend >> plane;
    const bool good = in && l.nx > 0 && l.ny > 0 && l.nz > 0 && l.step > 0 && map.arrangement.overlap > 0 &&
                      map.arrangement.overlap < 64 && plane >= 0 && plane <= 2 &&
                      double(l.nx) * double(l.ny) * double(l.nz) < 2147483648.0;
    if (!good) refuse(path, "is damaged");
    map.arrangement.tile = map.options.tile = tile != 0;
    map.options.warp = warp != 0;
    map.options.blend = blend != 0;
    map.plane = PatchPlane(plane);
    validate(map.options);
}

void readPatches(const std::string& path, const std::string& text, PatchMapFile& map) {
    std::istringstream in(text);
    LaidPatch p;
    while (in >> p.from.i >> p.from.j >> p.at.i >> p.at.j >> p.nx >> p.ny >> p.fine.x >> p.fine.y >>
           p.fine.z >> p.cost) {
        const bool good = p.nx > 0 && p.ny > 0 && p.from.i >= 0 && p.from.j >= 0 && dot(p.fine, p.fine) <= 16;
        if (!good || map.arrangement.patches.size() == kMostPatches)
            refuse(path, "has a patch that cannot be");
        map.arrangement.patches.push_back(p);
    }
    if (map.arrangement.patches.empty()) refuse(path, "has no patches");
}

// Only nodes of a patch's own box may be its.
bool isWithin(const PatchArrangement& a, const LaidPatch& patch, int i, int j) {
    const PatchPlace source = sourceColumn(a, patch, i, j);
    return source.i >= patch.from.i && source.j >= patch.from.j && source.i < patch.from.i + patch.nx &&
           source.j < patch.from.j + patch.ny;
}

}  // namespace

GridPtr patchMapGrid(const PatchSource& source, const PatchSheet& sheet, const PatchOptions& options) {
    const PatchArrangement& a = sheet.result.arrangement;
    if (a.patches.empty())
        throw Error(ErrorCode::Unusable,
                    "`sourceMap`: a sheet of the paper's method has none; its points' `source` says where "
                    "each is from");
    auto grid = openvdb::Int32Grid::create(PatchArrangement::kNone);
    auto accessor = grid->getAccessor();
    for (int i = 0; i < a.lattice.nx; ++i)
        for (int j = 0; j < a.lattice.ny; ++j)
            for (int k = 0; k < a.lattice.nz; ++k)
                accessor.setValue(
                    {i, j, k}, a.label[a.lattice.column(i, j) * std::size_t(a.lattice.nz) + std::size_t(k)]);
    grid->setName(kLabels);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(a.lattice.step));
    grid->insertMeta(kPatches, openvdb::StringMetadata(patchesText(a.patches)));
    grid->insertMeta(kSheet, openvdb::StringMetadata(sheetText(source, sheet, options)));
    return grid;
}

std::optional<PatchMapFile> patchMapFrom(const std::string& path, const std::vector<GridPtr>& grids) {
    openvdb::Int32Grid::ConstPtr labels;
    for (const GridPtr& grid : grids)
        if (grid->getName() == kLabels) labels = openvdb::gridConstPtrCast<openvdb::Int32Grid>(grid);
    if (!labels) return std::nullopt;
    PatchMapFile map;
    readSheet(path, metaText(*labels, kSheet), map);
    readPatches(path, metaText(*labels, kPatches), map);
    PatchArrangement& a = map.arrangement;
    a.label.reserve(a.lattice.nodes());
    const auto accessor = labels->getConstAccessor();
    for (int i = 0; i < a.lattice.nx; ++i)
        for (int j = 0; j < a.lattice.ny; ++j)
            for (int k = 0; k < a.lattice.nz; ++k) {
                const std::int32_t label = accessor.getValue({i, j, k});
                if (label < 0 || std::size_t(label) >= a.patches.size() ||
                    !isWithin(a, a.patches[std::size_t(label)], i, j))
                    refuse(path, "names a patch at a place that it does not reach");
                a.label.push_back(label);
            }
    return map;
}

PatchSheet repeatPatchSheet(const PatchSource& source, const PatchMapFile& map, const RunContext& ctx) {
    PatchSheet sheet;
    sheet.width = map.options.width;
    sheet.depth = map.options.depth;
    sheet.border = map.options.border;
    SheetResult made =
        withThreads(ctx, [&] { return repeatPatches(source.exemplar, map.arrangement, map.options, ctx); });
    sheet.result.sheet = std::move(made.sheet);
    sheet.result.borders = made.borders;
    sheet.result.arrangement = map.arrangement;
    sheet.result.patches = map.arrangement.patches.size();
    sheet.result.patch = map.arrangement.patches.front().nx * map.arrangement.lattice.step;
    sheet.result.step = map.arrangement.lattice.step;
    return sheet;
}

}  // namespace vdbsynth
