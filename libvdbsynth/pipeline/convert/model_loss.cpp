// What images and volumes lose on the way to a level set.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/pipeline/convert/model_steps.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Solids of a closed mesh: its connected pieces whose faces look outward.
std::size_t solidPieces(const Mesh& mesh) {
    DisjointSets sets(mesh.points.size());
    const std::vector<Triangle> triangles = triangulated(mesh);
    for (const Triangle& t : triangles) {
        sets.join(t[0], t[1]);
        sets.join(t[0], t[2]);
    }
    std::vector<double> volume(mesh.points.size());
    for (const Triangle& t : triangles) {
        const Vec3d a = cast<double>(mesh.points[t[0]]), b = cast<double>(mesh.points[t[1]]);
        volume[sets.root(t[0])] += dot(a, cross(b, cast<double>(mesh.points[t[2]])));
    }
    return std::size_t(std::count_if(volume.begin(), volume.end(), [](double v) { return v > 0; }));
}

// Parts of the solid samples, which hang together by faces, edges and corners.
std::size_t partsOf(const RasterField& field, const RunContext& ctx) {
    BrickField samples = field.field;
    const Index3 corner = samples.box().min;
    samples.translate(Index3{0, 0, 0} - corner);
    const Occupancy solid = Occupancy::fromField(samples, ctx);
    return findComponents(solid.window({field.domain.min - corner, field.domain.max - corner}),
                          Neighbours::All)
        .sizes.size();
}

}  // namespace

void sayLostHeights(const std::string& path, const Raster& raster, const RasterField& field,
                    const RunContext& ctx) {
    if (field.lostShare < 0.001) return;
    const std::string text =
        path + ": " + roundedText(100 * field.lostShare, 2) +
        " % of its pixels lie farther than a voxel from the surface, as their details are smaller; "
        "`resolution` " +
        std::to_string(std::max(raster.size.x, raster.size.y)) + " keeps them";
    if (field.lostShare > 0.5) throw Error(ErrorCode::Unusable, text);
    message(ctx, MessageLevel::Warning, text);
}

void sayBrokenParts(const std::string& path, std::size_t before, std::size_t after, const RunContext& ctx) {
    constexpr double kSaid = 1.1, kWarned = 2;
    if (double(after) <= kSaid * double(before)) return;
    message(ctx, double(after) < kWarned * double(before) ? MessageLevel::Note : MessageLevel::Warning,
            path + ": its " + std::to_string(before) + (before == 1 ? " part" : " parts") + " became " +
                std::to_string(after) +
                " in the level set, as samples that touch by an edge or corner alone come apart; to keep "
                "them whole, resample it to samples of half the size by linear interpolation and give "
                "`threshold` a fifth of the way from outside to solid");
}

void sayLostSamples(const std::string& path, const RasterField& field, const openvdb::FloatGrid& grid,
                    const RunContext& ctx) {
    constexpr double kSaid = 0.01, kWarned = 0.05;
    if (!(field.solidVolume > 0)) return;
    const Mesh mesh = zeroLevelInIndexSpace(grid, 0, ctx);
    sayBrokenParts(path, partsOf(field, ctx), solidPieces(mesh), ctx);
    const double volume = summarize(mesh).signedVolume;
    const double change = volume / field.solidVolume - 1;
    if (std::abs(change) < kSaid) return;
    message(ctx, std::abs(change) < kWarned ? MessageLevel::Note : MessageLevel::Warning,
            path + ": " + std::to_string(std::min(99L, std::lround(100 * std::abs(change)))) +
                " % of the volume of its solid samples is " + (change < 0 ? "lost" : "added") +
                " by smoothing, as its " + (change < 0 ? "parts" : "voids") + " are few samples thick; " +
                field.keepsMore + "samples of half the size would keep more");
}

}  // namespace vdbsynth
