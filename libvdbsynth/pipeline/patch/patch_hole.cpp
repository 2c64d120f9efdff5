#include "libvdbsynth/pipeline/patch/patch_hole.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

namespace vdbsynth {
namespace {

// Points of the hole's columns that are not in the hole.
void warnOfHeight(const PatchExemplar& sheet, const PatchLattice& l, const std::vector<std::uint8_t>& hole,
                  const std::function<bool(const Vec3d& world)>& inside, const RunContext& ctx) {
    std::size_t beyond = 0;
    for (const Vec3f& point : sheet.points) {
        const double i = std::floor(double(point.x) / l.step), j = std::floor(double(point.y) / l.step);
        if (i < 0 || j < 0 || i >= l.nx || j >= l.ny || !hole[l.column(int(i), int(j))]) continue;
        const Vec3d place = cast<double>(point);
        // Beside the hole by less than a column is only its width.
        const Vec3d middle{(i + 0.5) * l.step, (j + 0.5) * l.step, place.z};
        if (!inside(sheet.toWorld(place)) && !inside(sheet.toWorld(middle))) ++beyond;
    }
    if (beyond > 0)
        message(ctx, MessageLevel::Warning,
                std::to_string(beyond) +
                    " points above, below or less than a step beside the hole are replaced too: it goes "
                    "through the whole height of the sheet");
}

[[noreturn]] void refuseBeside(const PatchExemplar& sheet) {
    const Vec3d high = sheet.toWorld(sheet.size);
    const auto text = [](const Vec3d& at) {
        return roundedText(at.x, 5) + "," + roundedText(at.y, 5) + "," + roundedText(at.z, 5);
    };
    throw Error(ErrorCode::Unusable, "`hole`: lies outside the sheet, whose box is " + text(sheet.corner) +
                                         "," + text(high) + " (world)");
}

bool any(const std::vector<std::uint8_t>& columns) {
    return std::any_of(columns.begin(), columns.end(), [](std::uint8_t c) { return c != 0; });
}

// From the attributes of both, those of the sheet: of the exemplar's points where it has them.
Attributes joinedAttributes(const PatchSource& sheet, const PatchSource* other, const RunContext& ctx) {
    Attributes joined;
    const auto warn = [&](const std::string& text) { message(ctx, MessageLevel::Warning, text); };
    const auto isNumber = [](const Attribute& a) { return a.name == "patch" || a.name == "source"; };
    for (const Attribute& attribute : sheet.attributes) {
        if (isNumber(attribute)) continue;
        joined.push_back(attribute);
        if (!other) continue;
        const Attribute* same = findAttribute(other->attributes, attribute.name);
        if (same && same->width == attribute.width) {
            joined.back().values.insert(joined.back().values.end(), same->values.begin(), same->values.end());
            continue;
        }
        warn("the exemplar has no " + attribute.name + "; it is 0 on what is copied from it");
        joined.back().values.resize(joined.back().values.size() +
                                    attribute.width * other->exemplar.number.size());
    }
    if (other)
        for (const Attribute& attribute : other->attributes)
            if (!isNumber(attribute) && !findAttribute(sheet.attributes, attribute.name))
                warn("the sheet has no " + attribute.name + " of the exemplar; it is left out");
    return joined;
}

PointCloud cloudOf(const PatchSource& sheet, const PatchSource* other, const RepairResult& repair,
                   const RunContext& ctx) {
    const PatchExemplar& exemplar = sheet.exemplar;
    PointCloud cloud;
    cloud.origin = sheet.cloud.origin;
    std::vector<std::size_t> rows;
    Attribute patch{"patch", 1, {}}, number{"source", 1, {}};
    const auto note = [&](std::size_t row, std::int32_t of) {
        rows.push_back(row);
        patch.values.push_back(float(of));
        number.values.push_back(float(row));
    };
    for (const std::uint32_t kept : repair.kept) {
        cloud.points.push_back(sheet.cloud.points[kept]);
        cloud.normals.push_back(sheet.cloud.normals[kept]);
        note(kept, 0);
    }
    const SheetPoints& made = repair.made;
    for (std::size_t p = 0; p < made.size(); ++p) {
        cloud.points.push_back(cast<float>(exemplar.toWorld(cast<double>(made.points[p])) - cloud.origin));
        cloud.normals.push_back(cast<float>(fromPlane(exemplar.plane, cast<double>(made.normals[p]))));
        note(made.source[p], made.patch[p]);
    }
    cloud.attributes = selectRows(joinedAttributes(sheet, other, ctx), rows);
    cloud.attributes.push_back(std::move(patch));
    cloud.attributes.push_back(std::move(number));
    return cloud;
}

PatchSheet sheetOf(const PatchExemplar& exemplar, const RepairResult& repair) {
    PatchSheet sheet;
    sheet.width = exemplar.size.x;
    sheet.depth = exemplar.size.y;
    SheetPoints& points = sheet.result.sheet;
    points.points = repair.made.points;
    points.normals = repair.made.normals;
    std::vector<std::uint32_t> place(repair.first, 0);
    for (std::size_t p = 0; p < exemplar.number.size(); ++p) place[exemplar.number[p]] = std::uint32_t(p);
    for (const std::uint32_t kept : repair.kept) {
        points.points.push_back(exemplar.points[place[kept]]);
        points.normals.push_back(exemplar.normals[place[kept]]);
    }
    return sheet;
}

}  // namespace

std::vector<std::uint8_t> holeColumns(const PatchSource& sheet, const PatchBox& box, double step,
                                      const RunContext& ctx) {
    const PatchExemplar& exemplar = sheet.exemplar;
    const PatchLattice l = latticeOf(exemplar.size, step);
    const Vec3d low = toPlane(exemplar.plane, box.min - exemplar.corner),
                high = toPlane(exemplar.plane, box.max - exemplar.corner);
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
        throw Error(ErrorCode::InvalidOption, "`hole`: a box's minimum must be below its maximum");
    std::vector<std::uint8_t> columns(l.columns(), 0);
    if (high.z < 0 || low.z > exemplar.size.z) refuseBeside(exemplar);
    for (int i = 0; i < l.nx; ++i)
        for (int j = 0; j < l.ny; ++j)
            columns[l.column(i, j)] =
                (i + 1) * step > low.x && i * step < high.x && (j + 1) * step > low.y && j * step < high.y;
    if (!any(columns)) refuseBeside(exemplar);
    warnOfHeight(
        exemplar, l, columns,
        [&](const Vec3d& world) {
            bool inside = true;
            for (int axis = 0; axis < 3; ++axis)
                inside = inside && world[axis] >= box.min[axis] - step && world[axis] <= box.max[axis] + step;
            return inside;
        },
        ctx);
    return columns;
}

std::vector<std::uint8_t> holeColumns(const PatchSource& sheet, const LevelSet& hole, double step,
                                      const RunContext& ctx) {
    requireModel(&hole, "the hole", ctx);
    const PatchExemplar& exemplar = sheet.exemplar;
    const PatchLattice l = latticeOf(exemplar.size, step);
    std::vector<std::uint8_t> columns(l.columns(), 0);
    const auto insideOf = [&](const auto& sampler, const Vec3d& world) {
        return sampler.wsSample(openvdb::Vec3d(world.x, world.y, world.z)) < 0;
    };
    parallelFor(ctx, std::size_t(l.nx), 4, [&](std::size_t begin, std::size_t end) {
        auto accessor = hole.grid->getConstAccessor();
        const openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler>
            sampler(accessor, hole.grid->transform());
        for (std::size_t i = begin; i < end; ++i)
            for (int j = 0; j < l.ny; ++j)
                for (int k = 0; k < l.nz && !columns[l.column(int(i), j)]; ++k)
                    columns[l.column(int(i), j)] = insideOf(sampler, exemplar.toWorld(l.place(int(i), j, k)));
    });
    if (!any(columns)) refuseBeside(exemplar);
    auto accessor = hole.grid->getConstAccessor();
    const openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler> sampler(
        accessor, hole.grid->transform());
    warnOfHeight(
        exemplar, l, columns, [&](const Vec3d& world) { return insideOf(sampler, world); }, ctx);
    return columns;
}

RepairedSheet repairSheet(const PatchSource& sheet, const std::vector<std::uint8_t>& hole,
                          const PatchSource* exemplar, const PatchOptions& options, const RunContext& ctx) {
    if (sheet.cloud.points.size() != sheet.exemplar.points.size())
        throw Error(ErrorCode::ShapeMismatch, "a sheet to be repaired must be loaded whole");
    if (exemplar && exemplar->exemplar.spacing > 1.5 * sheet.exemplar.spacing)
        message(ctx, MessageLevel::Warning,
                "the exemplar's points are " +
                    roundedText(exemplar->exemplar.spacing / sheet.exemplar.spacing, 3) +
                    " times as far apart as the sheet's; what is copied has fewer");
    RepairedSheet repaired;
    repaired.repair = withThreads(ctx, [&] {
        return repairPatches(sheet.exemplar, hole, exemplar ? &exemplar->exemplar : nullptr, options, ctx);
    });
    repaired.cloud = cloudOf(sheet, exemplar, repaired.repair, ctx);
    repaired.sheet = sheetOf(sheet.exemplar, repaired.repair);
    return repaired;
}

}  // namespace vdbsynth
