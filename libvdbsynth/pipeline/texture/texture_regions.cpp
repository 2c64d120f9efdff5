// Which sample each site takes.
#include "libvdbsynth/pipeline/texture/texture_regions.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/points/site_regions.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/grid_reader.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

bool holdsWholeNumbers(const openvdb::GridBase& grid) {
    return grid.isType<openvdb::Int32Grid>() || grid.isType<openvdb::Int64Grid>();
}

void requireLabel(double label, std::size_t samples, const std::string& where) {
    if (!(label >= 0 && label < double(samples)))
        throw Error(ErrorCode::BadData, "`region`: " + where + " has the value " + roundedText(label, 6) +
                                            "; labels are 0 to " + std::to_string(samples - 1) +
                                            ", one for each sample");
}

void noteRegions(const TextureShape& shape, const SiteRegions& regions, std::size_t samples,
                 const RunContext& ctx) {
    std::vector<std::size_t> sites(regions.labels, 0);
    for (std::int32_t label : regions.label) ++sites[std::size_t(label)];
    std::string shares;
    for (std::size_t count : sites)
        shares += (shares.empty() ? "" : ", ") +
                  roundedText(100 * double(count) / double(regions.label.size()), 3) + " %";
    const std::string found = std::to_string(regions.found) + (regions.found == 1 ? " region" : " regions");
    message(ctx, MessageLevel::Note, shape.name + ": by shape the images take " + shares + " of its points");
    if (regions.labels < samples)
        message(ctx, MessageLevel::Warning,
                shape.name + ": has fewer places than there are images; the last ones are not used");
    if (regions.halved > 0)
        message(ctx, MessageLevel::Warning,
                shape.name + ": creases, curvature and gaps bound " + found + " for " +
                    std::to_string(samples) +
                    " images; the largest ones are halved where nothing bounds them");
    if (regions.found > samples)
        message(ctx, MessageLevel::Note,
                shape.name + ": has " + found + " apart for " + std::to_string(samples) +
                    " images; those of similar size share one");
    if (regions.islands > 0)
        message(ctx, MessageLevel::Note,
                shape.name + ": " + std::to_string(regions.islands) +
                    " points of pieces under 1 % of the largest take the image of the nearest");
}

}  // namespace

std::vector<std::int32_t> labelsOf(const TextureShape& shape, const std::string& attribute,
                                   std::size_t samples) {
    const Attribute* found = findAttribute(shape.attributes, attribute);
    if (!found || found->width != 1) {
        std::string names;
        for (const Attribute& other : shape.attributes)
            if (other.width == 1) names += (names.empty() ? "" : ", ") + other.name;
        throw Error(ErrorCode::Unusable, shape.name + ": has no attribute " + attribute +
                                             " of one number for `regionAttribute`; it has " +
                                             (names.empty() ? "none" : names));
    }
    std::vector<std::int32_t> labels(shape.site.size(), -1);
    for (std::size_t i = 0; i < found->values.size(); ++i) {
        const float value = found->values[i];
        if (!(value >= 0 && value < float(samples) && value == std::floor(value)))
            throw Error(ErrorCode::BadData, shape.name + ": its attribute " + attribute + " has the value " +
                                                roundedText(double(value), 6) + "; labels are 0 to " +
                                                std::to_string(samples - 1) + ", one for each sample");
        std::int32_t& label = labels[shape.siteOf[i]];
        if (label < 0) label = std::int32_t(value);
    }
    return labels;
}

std::vector<std::int32_t> labelsInside(const TextureShape& shape, const LevelSet& model) {
    const GridReader distance = scalarReader(*model.grid, GridSampling::Linear, "region");
    std::vector<std::int32_t> labels;
    for (const Vec3f& p : shape.site)
        labels.push_back(distance(shape.origin + cast<double>(p)).value.z < 0 ? 1 : 0);
    return labels;
}

std::vector<std::int32_t> labelsIn(const TextureShape& shape, const openvdb::GridBase& grid,
                                   std::size_t samples) {
    const bool whole = holdsWholeNumbers(grid), solid = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
    const GridReader reader = scalarReader(grid, GridSampling::Linear, "`region`");
    if (!whole && samples != 2)
        throw Error(ErrorCode::InvalidOption, "`region`: grid \"" + grid.getName() + "\" (" +
                                                  grid.valueType() + ") divides two images; for " +
                                                  std::to_string(samples) + " give whole numbers");
    std::vector<std::int32_t> labels;
    for (const Vec3f& p : shape.site) {
        const Vec3d world = shape.origin + cast<double>(p);
        const double value = reader(world).value.z;
        if (whole)
            requireLabel(value, samples,
                         "grid \"" + grid.getName() + "\" at " + roundedText(world.x, 6) + "," +
                             roundedText(world.y, 6) + "," + roundedText(world.z, 6));
        labels.push_back(whole ? std::int32_t(value) : solid ? value < 0 : value > 0.5);
    }
    return labels;
}

std::vector<std::int32_t> labelsByShape(const TextureShape& shape, std::size_t samples,
                                        const RunContext& ctx) {
    const SurfaceSites sites = sitesAcrossCreases(shape.site, shape.normal, ctx);
    SiteRegions regions = siteRegions(sites, samples, ctx);
    noteRegions(shape, regions, samples, ctx);
    return std::move(regions.label);
}

}  // namespace vdbsynth
