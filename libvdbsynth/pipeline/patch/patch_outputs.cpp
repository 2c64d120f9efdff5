#include "libvdbsynth/pipeline/patch/patch_outputs.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/patch/patch_field.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kTile = 64;   // voxels along the plane that are measured at once
constexpr int kBeyond = 4;  // voxels beyond the domain

bool insideSheet(const Vec3f& at, const PatchSheet& sheet) {
    return at.x >= 0 && at.y >= 0 && double(at.x) < sheet.width && double(at.y) < sheet.depth;
}

Attribute wholeNumbers(const std::string& name) {
    Attribute attribute;
    attribute.name = name;
    return attribute;
}

// Voxels in the order of the file's axes from columns in that of the plane's.
class VoxelWriter {
public:
    VoxelWriter(PatchPlane plane, const IndexBox& box) : mPlane(plane), mField(box, kFieldReach) {}

    // A tile of columns that begins at a place of plane space's voxels.
    void write(const PatchField& part, const Index3& first) {
        const PatchLattice& l = part.lattice;
        for (int i = 0; i < l.nx; ++i)
            for (int j = 0; j < l.ny; ++j)
                for (int k = 0; k < l.nz; ++k) {
                    const Vec3d at =
                        fromPlane(mPlane, {double(first.x + i), double(first.y + j), double(first.z + k)});
                    const float value = part.distance(i, j, k);
                    mField.writeBox({int(at.x), int(at.y), int(at.z)}, {1, 1, 1}, &value);
                }
    }
    BrickField take() { return std::move(mField); }

private:
    PatchPlane mPlane;
    BrickField mField;
};

// In plane space's voxels: index = place / voxelSize.
struct SheetVoxels {
    Index3 low, high;  // of the domain, inclusive
};

}  // namespace

bool takesPoints(const std::string& path) {
    return extensionOf(path) == "ply";
}

PointCloud sheetCloud(const PatchSource& source, const PatchSheet& sheet) {
    const PatchExemplar& exemplar = source.exemplar;
    const SheetPoints& points = sheet.result.sheet;
    PointCloud cloud;
    std::vector<std::size_t> rows;
    Attribute patch = wholeNumbers("patch"), number = wholeNumbers("source");
    // Near the exemplar's own coordinates floats may be coarse: the corner is the origin there.
    const double far =
        std::max({std::abs(exemplar.corner.x), std::abs(exemplar.corner.y), std::abs(exemplar.corner.z)});
    const bool isFar = far > 64 * std::max({sheet.width, sheet.depth, exemplar.size.z});
    cloud.origin = isFar ? exemplar.corner : Vec3d{};
    const Vec3d shift = isFar ? Vec3d{} : exemplar.corner;
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (!insideSheet(points.points[p], sheet)) continue;
        cloud.points.push_back(
            cast<float>(fromPlane(exemplar.plane, cast<double>(points.points[p])) + shift));
        cloud.normals.push_back(cast<float>(fromPlane(exemplar.plane, cast<double>(points.normals[p]))));
        rows.push_back(exemplar.number[points.source[p]]);
        patch.values.push_back(float(points.patch[p]));
        number.values.push_back(float(rows.back()));
    }
    cloud.attributes = selectRows(source.attributes, rows);
    cloud.attributes.push_back(std::move(patch));
    cloud.attributes.push_back(std::move(number));
    return cloud;
}

LevelSet sheetLevelSet(const PatchSource& source, const PatchSheet& sheet, double voxelSize, double halfWidth,
                       const RunContext& ctx) {
    const PatchExemplar& exemplar = source.exemplar;
    const Vec3d corner = toPlane(exemplar.plane, exemplar.corner);
    const Vec3d size{sheet.width, sheet.depth, exemplar.size.z};
    SheetVoxels voxels;
    for (int axis = 0; axis < 3; ++axis) {
        voxels.low[axis] = int(std::lround(corner[axis] / voxelSize));
        voxels.high[axis] =
            std::max(voxels.low[axis], int(std::lround((corner[axis] + size[axis]) / voxelSize)) - 1);
    }
    requireMemory(ctx,
                  8.0 * double(voxels.high.x - voxels.low.x) * double(voxels.high.y - voxels.low.y) *
                      double(voxels.high.z - voxels.low.z),
                  "a level set of the sheet", "a larger `voxelSize` needs less");
    const PointSetSurface surface(sheet.result.sheet.points, sheet.result.sheet.normals, {}, ctx);
    const auto turned = [&](const Index3& p) {
        const Vec3d at = fromPlane(exemplar.plane, {double(p.x), double(p.y), double(p.z)});
        return Index3{int(at.x), int(at.y), int(at.z)};
    };
    const Index3 beyond{kBeyond, kBeyond, kBeyond};
    const Index3 first = voxels.low - beyond, last = voxels.high + beyond;
    VoxelWriter writer(exemplar.plane, {turned(first), turned(last)});
    RunContext quiet = ctx;
    quiet.onProgress = nullptr;
    const int tiles = (last.x - first.x) / kTile + 1;
    Stage stage(ctx, "distances of the sheet", std::size_t(tiles));
    for (int x = first.x; x <= last.x; x += kTile) {
        for (int y = first.y; y <= last.y; y += kTile) {
            const PatchLattice part{voxelSize, std::min(kTile, last.x - x + 1),
                                    std::min(kTile, last.y - y + 1), last.z - first.z + 1};
            // A lattice's node is half a step from its corner; a voxel's value is that at its index.
            const Vec3d origin = Vec3d{x - 0.5, y - 0.5, first.z - 0.5} * voxelSize - corner;
            writer.write(patchField(surface, part, origin, quiet), {x, y, first.z});
        }
        stage.advance();
    }
    const LevelSet made =
        modelFromField(writer.take(), kFieldReach, false, {turned(voxels.low), turned(voxels.high)},
                       voxelSize, "the sheet", "a larger `size` may hold more", ctx);
    return withHalfWidth(made, halfWidth, ctx);
}

}  // namespace vdbsynth
