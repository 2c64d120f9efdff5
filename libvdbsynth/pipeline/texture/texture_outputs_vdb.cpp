// Textured points and surfaces as grids.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/pipeline/texture/texture_output_steps.h"
#include "libvdbsynth/points/surface_sites.h"
#include "libvdbsynth/vdb/convert/band_grids.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/convert/point_grid.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr double kPointVoxels = 2;  // [texels] a voxel of OpenVDB points, for a few points in each

GridPtr pointsOf(const TextureShape& shape, const TextureResult& result,
                 const std::vector<TextureSample>& samples, const TextureOutputOptions& options,
                 const RunContext& ctx) {
    PointCloud cloud;
    cloud.points = shape.points;
    cloud.origin = shape.origin;
    cloud.normals = elementNormals(shape);
    cloud.attributes = textureAttributes(shape, result, samples);
    for (const Attribute& own : shape.attributes)
        if (own.name != "Alpha" && own.name != "N" && own.name != "P" &&
            !findAttribute(cloud.attributes, own.name))
            cloud.attributes.push_back(own);
    const double voxel = options.model.voxelSize > 0 ? options.model.voxelSize : kPointVoxels * result.texel;
    return pointGrid(cloud, voxel, ctx);
}

Mesh movedMesh(const TextureShape& shape) {
    Mesh mesh;
    mesh.points = shape.points;
    mesh.origin = shape.origin;
    mesh.triangles = shape.triangles;
    return mesh;
}

// The surface to write: the target's own, or that of the mesh.
LevelSet surfaceOf(const TextureShape& shape, const TextureOutputOptions& options, const RunContext& ctx) {
    LevelSet model = shape.model;
    if (!model.grid) {
        ModelOptions of = options.model;
        of.carry = true;
        model = loadModel(shape.name, of, ctx);
    }
    if (shape.moved.empty()) return model;
    LevelSet moved;
    moved.grid = meshToSolid(movedMesh(shape), voxelSizeOf(*model.grid), options.model.halfWidth, shape.name,
                             options.model.solid, ctx);
    moved.domain = solidBox(*moved.grid, shape.name);
    stampLevelSet(moved);
    if (!model.attributes.empty())
        message(ctx, MessageLevel::Note, shape.name + ": its other grids are left out, as it is displaced");
    return moved;
}

// What a place near the surface has: the values that its nearest site's chart gives there.
class NearestChart {
public:
    NearestChart(const TextureShape& shape, const TextureResult& result,
                 const std::vector<SampleImage>& images)
        : mShape(shape),
          mResult(result),
          mImages(images),
          mSurface{shape.placed(), shape.normal, result.sites, images, result.texel},
          mNearest(shape.placed()) {}

    // All channels, then u, v and the exemplar.
    void read(const Vec3d& world, float* out) const {
        const std::size_t channels = std::size_t(mImages.front().channels);
        const Vec3f at = cast<float>(world - mShape.origin);
        std::uint32_t site = 0;
        float squared = 0;
        mNearest.nearest(at, 1, &site, &squared);
        const Vec3f& n = mShape.normal[site];
        const Vec3f onPlane = at - n * dot(n, at - mShape.placed()[site]);
        const std::int32_t sample = mResult.sites.sample[site];
        const Vec2f coordinate = extendedCoordinate(mSurface, site, onPlane);
        if (sample < 0 || mResult.sites.blended[site])
            std::copy_n(&mResult.sites.values[site * channels], channels, out);
        else
            readCubic(mImages[std::size_t(sample)], coordinate, out);
        out[channels] = coordinate.x;
        out[channels + 1] = coordinate.y;
        out[channels + 2] = float(sample);
    }

private:
    const TextureShape& mShape;
    const TextureResult& mResult;
    const std::vector<SampleImage>& mImages;
    TexturedSurface mSurface;
    PointNeighbours mNearest;
};

}  // namespace

void writeTexturedVdb(const TextureShape& shape, const TextureResult& result,
                      const std::vector<TextureSample>& samples, const std::string& temporary,
                      const TextureOutputOptions& options, const RunContext& ctx) {
    if (shape.kind == TargetKind::Points)
        return writeVdb(temporary, {pointsOf(shape, result, samples, options, ctx)}, options.metadata);
    const LevelSet model = surfaceOf(shape, options, ctx);
    const std::vector<SampleImage> images = imagesOf(samples);
    const NearestChart chart(shape, result, images);
    std::vector<BandValue> values;
    for (const SampleMap& map : samples.front().maps) values.push_back({map.name, std::size_t(map.channels)});
    for (const char* name : {"source_u", "source_v", "source_exemplar"}) values.push_back({name, 1});
    std::vector<GridPtr> grids{model.grid};
    for (GridPtr& grid : bandGrids(
             *model.grid, values, [&](const Vec3d&world, float*out) { chart.read(world, out); }, ctx))
        grids.push_back(grid);
    for (const GridPtr& other : model.attributes) {
        const bool replaced = std::any_of(grids.begin(), grids.end(),
                                          [&](const GridPtr& g) { return g->getName() == other->getName(); });
        if (!replaced) grids.push_back(other);
    }
    writeVdb(temporary, grids, options.metadata);
}

}  // namespace vdbsynth
