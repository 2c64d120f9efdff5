#include "libvdbsynth/pipeline/patch/patch_outputs.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/patch/patch_field.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "libvdbsynth/vdb/convert/attribute_grids.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kTile = 64;   // voxels along the plane that are measured at once
constexpr float kNear = 1;  // voxels from the points that are measured: only the zero level is meant
constexpr const char *kPatchName = "patch", *kSourceName = "source";
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
    VoxelWriter(PatchPlane plane, const Index3& first, const Index3& last)
        : mPlane(plane), mField({turned(first), turned(last)}, kFieldReach) {}

    // A tile of columns that begins at a place of plane space's voxels.
    void write(const PatchField& part, const Index3& first) {
        const PatchLattice& l = part.lattice;
        const Index3 size = turned({l.nx, l.ny, l.nz});
        std::vector<float> values(l.nodes());
        for (int i = 0; i < l.nx; ++i)
            for (int j = 0; j < l.ny; ++j)
                for (int k = 0; k < l.nz; ++k)
                    values[latticeIndex(turned({i, j, k}), size)] = part.distance(i, j, k);
        mField.writeBox(turned(first), size, values.data());
    }
    Index3 turned(const Index3& p) const {
        const Vec3d at = fromPlane(mPlane, {double(p.x), double(p.y), double(p.z)});
        return {int(at.x), int(at.y), int(at.z)};
    }
    BrickField take() { return std::move(mField); }

private:
    PatchPlane mPlane;
    BrickField mField;
};

// The domain in plane space's voxels, inclusive: index = place / voxelSize.
struct SheetVoxels {
    Index3 low, high;
};

SheetVoxels voxelsOf(const PatchSheet& sheet, const Vec3d& corner, double height, double voxelSize) {
    const Vec3d size{sheet.width, sheet.depth, height};
    SheetVoxels voxels;
    for (int axis = 0; axis < 3; ++axis) {
        voxels.low[axis] = int(std::lround(corner[axis] / voxelSize));
        voxels.high[axis] =
            std::max(voxels.low[axis], int(std::lround((corner[axis] + size[axis]) / voxelSize)) - 1);
    }
    return voxels;
}

// The sheet's points by the tiles that they may be near to.
class PointTiles {
public:
    PointTiles(const std::vector<Vec3f>& points, const Vec3d& origin, double side, double reach, int nx,
               int ny)
        : mNy(ny), mTiles(std::size_t(nx) * std::size_t(ny)) {
        const auto at = [&](double x, int count) {
            return std::clamp(int(std::floor(x / side)), 0, count - 1);
        };
        for (const Vec3f& point : points) {
            const double x = double(point.x) - origin.x, y = double(point.y) - origin.y;
            for (int i = at(x - reach, nx); i <= at(x + reach, nx); ++i)
                for (int j = at(y - reach, ny); j <= at(y + reach, ny); ++j)
                    mTiles[std::size_t(i) * std::size_t(ny) + std::size_t(j)].push_back(point);
        }
    }
    const std::vector<Vec3f>& at(int i, int j) const {
        return mTiles[std::size_t(i) * std::size_t(mNy) + std::size_t(j)];
    }

private:
    int mNy;
    std::vector<std::vector<Vec3f>> mTiles;
};

// Distances over the voxels from `first` to `last` of plane space.
BrickField sheetField(const PatchSheet& sheet, double kernel, const VoxelWriter& like, const Vec3d& corner,
                      double voxelSize, const Index3& first, const Index3& last, const RunContext& ctx) {
    VoxelWriter writer = like;
    const std::vector<Vec3f>& points = sheet.result.sheet.points;
    PointSetSurfaceOptions options;
    options.kernel = kernel;
    const PointSetSurface surface(points, sheet.result.sheet.normals, options, ctx);
    const int nx = (last.x - first.x) / kTile + 1, ny = (last.y - first.y) / kTile + 1;
    // A lattice's node is half a step from its corner; a voxel's value is that at its index.
    const auto originOf = [&](int x, int y) {
        return Vec3d{x - 0.5, y - 0.5, first.z - 0.5} * voxelSize - corner;
    };
    const PointTiles tiles(points, originOf(first.x, first.y), kTile * voxelSize, 4 * voxelSize, nx, ny);
    RunContext quiet = ctx;
    quiet.onProgress = nullptr;
    Stage stage(ctx, "distances of the sheet", std::size_t(nx) * std::size_t(ny));
    for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j) {
            const int x = first.x + i * kTile, y = first.y + j * kTile;
            const PatchLattice part{voxelSize, std::min(kTile, last.x - x + 1),
                                    std::min(kTile, last.y - y + 1), last.z - first.z + 1};
            writer.write(patchField(surface, tiles.at(i, j), part, originOf(x, y), kNear, quiet),
                         {x, y, first.z});
            stage.advance();
        }
    return writer.take();
}

}  // namespace

void carryAttributes(const PointCloud& cloud, LevelSet& model, const RunContext& ctx) {
    PointCloud carried = cloud;
    carried.attributes.erase(
        std::remove_if(carried.attributes.begin(), carried.attributes.end(),
                       [](const Attribute& a) { return a.name == kPatchName || a.name == kSourceName; }),
        carried.attributes.end());
    if (carried.attributes.empty()) return;
    std::vector<GridPtr> grids =
        withThreads(ctx, [&] { return attributesToGrids(carried, *model.grid, ctx); });
    model.attributes.insert(model.attributes.end(), grids.begin(), grids.end());
}

bool takesPoints(const std::string& path) {
    return extensionOf(path) == "ply";
}

PointCloud sheetCloud(const PatchSource& source, const PatchSheet& sheet) {
    const PatchExemplar& exemplar = source.exemplar;
    const SheetPoints& points = sheet.result.sheet;
    PointCloud cloud;
    std::vector<std::size_t> rows;
    Attribute patch = wholeNumbers(kPatchName), number = wholeNumbers(kSourceName);
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
    const SheetVoxels voxels = voxelsOf(sheet, corner, exemplar.size.z, voxelSize);
    const Index3 beyond{kBeyond, kBeyond, kBeyond};
    const Index3 first = voxels.low - beyond, last = voxels.high + beyond, count = last - first;
    requireMemory(ctx, 5.0 * double(count.x) * double(count.y) * double(count.z), "a level set of the sheet",
                  "a larger `voxelSize` needs less");
    const VoxelWriter writer(exemplar.plane, first, last);
    const LevelSet made =
        modelFromField(sheetField(sheet, exemplar.kernel, writer, corner, voxelSize, first, last, ctx),
                       kFieldReach, false, 0, {writer.turned(voxels.low), writer.turned(voxels.high)},
                       voxelSize, "the sheet", "a larger `size` may hold more", ctx);
    return withHalfWidth(made, halfWidth, ctx);
}

}  // namespace vdbsynth
