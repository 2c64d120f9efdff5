#include "libvdbsynth/raster/height_field.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/crossing_field.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Heights at the voxels' centres, rows from the bottom; NaN where there is no data.
struct HeightMap {
    int columns = 0, rows = 0;
    std::vector<float> values;
    float at(int x, int y) const {
        return values[std::size_t(std::clamp(y, 0, rows - 1)) * std::size_t(columns) +
                      std::size_t(std::clamp(x, 0, columns - 1))];
    }
};

HeightMap fromRaster(const Raster& raster) {
    HeightMap map{raster.size.x, raster.size.y, raster.values};
    if (raster.rowsFromTop)
        for (int y = 0; y < map.rows / 2; ++y)
            std::swap_ranges(map.values.begin() + std::ptrdiff_t(y) * map.columns,
                             map.values.begin() + std::ptrdiff_t(y + 1) * map.columns,
                             map.values.begin() + std::ptrdiff_t(map.rows - 1 - y) * map.columns);
    return map;
}

// Weight of a sample at a distance [samples]: a tent of a voxel's width for voxels larger than samples, else
// the Catmull-Rom spline.
double kernel(double distance, double ratio) {
    const double t = std::abs(distance);
    if (ratio > 1) return std::max(0.0, 1 - t / ratio);
    if (t < 1) return 1 + t * t * (1.5 * t - 2.5);
    return t < 2 ? 2 + t * (-4 + t * (2.5 - 0.5 * t)) : 0;
}

// One row of samples, `step` apart, resampled: `ratio` samples per new one.
void resampleRow(const float* from, int count, std::size_t step, float* out, int made, std::size_t outStep,
                 double ratio) {
    const double reach = ratio > 1 ? ratio : 2;
    for (int i = 0; i < made; ++i) {
        const double centre = (i + 0.5) * ratio - 0.5;
        const int nearest = std::clamp(int(std::lround(centre)), 0, count - 1);
        double sum = 0, weights = 0;
        for (int k = int(std::ceil(centre - reach)); k <= int(std::floor(centre + reach)); ++k) {
            const float value = from[std::size_t(std::clamp(k, 0, count - 1)) * step];
            const double weight = kernel(k - centre, ratio);
            if (std::isnan(value) || weight == 0) continue;
            sum += weight * double(value);
            weights += weight;
        }
        const float own = from[std::size_t(nearest) * step];  // a new sample has no data where this has none
        out[std::size_t(i) * outStep] = std::isnan(own) || weights < 0.1 ? own : float(sum / weights);
    }
}

HeightMap resampled(const HeightMap& map, double ratioX, double ratioY, const RunContext& ctx) {
    HeightMap result = map;
    if (std::abs(ratioX - 1) > 1e-9) {
        HeightMap wide{std::max(1, int(std::lround(map.columns / ratioX))), map.rows, {}};
        wide.values.resize(std::size_t(wide.columns) * std::size_t(wide.rows));
        parallelFor(ctx, std::size_t(map.rows), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y)
                resampleRow(&map.values[y * std::size_t(map.columns)], map.columns, 1,
                            &wide.values[y * std::size_t(wide.columns)], wide.columns, 1, ratioX);
        });
        result = std::move(wide);
    }
    if (std::abs(ratioY - 1) > 1e-9) {
        const std::size_t columns = std::size_t(result.columns);
        HeightMap high{result.columns, std::max(1, int(std::lround(map.rows / ratioY))), {}};
        high.values.resize(columns * std::size_t(high.rows));
        parallelFor(ctx, columns, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t x = begin; x < end; ++x)
                resampleRow(&result.values[x], result.rows, columns, &high.values[x], high.rows, columns,
                            ratioY);
        });
        result = std::move(high);
    }
    return result;
}

// Sizes [world] of an image's slab.
struct Slab {
    double pixelX, pixelY, voxel, scale, offset, low, high, base;  // height = value * scale + offset
};

// Share of pixels with data that lie over a voxel above or below all samples around their place.
double lostShare(const HeightMap& map, const HeightMap& samples, const Slab& slab) {
    const double unit = slab.scale / slab.voxel;
    std::size_t lost = 0, all = 0;
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.columns; ++x) {
            const float value = map.at(x, y);
            if (std::isnan(value)) continue;
            const int column = int((x + 0.5) * samples.columns / map.columns),
                      row = int((y + 0.5) * samples.rows / map.rows);
            float low = 1e30f, high = -1e30f;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const float around = samples.at(column + i, row + j);
                    if (std::isnan(around)) continue;
                    low = std::min(low, around);
                    high = std::max(high, around);
                }
            ++all;
            lost += double(value - high) * unit > 1 || double(low - value) * unit > 1 ? 1 : 0;
        }
    return all > 0 ? double(lost) / double(all) : 0;
}

// Signed distances [voxels, up to 4] in the plane to the edge of the data: negative where there is data.
std::vector<float> edgeDistances(const HeightMap& map) {
    constexpr int kReach = 4;
    std::vector<float> distances(map.values.size());
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.columns; ++x) {
            const bool missing = std::isnan(map.at(x, y));
            int nearest = kReach * kReach + 1;
            for (int j = -kReach; j <= kReach; ++j)
                for (int i = -kReach; i <= kReach; ++i)
                    if (i * i + j * j < nearest && std::isnan(map.at(x + i, y + j)) != missing)
                        nearest = i * i + j * j;
            const float distance = std::min(float(std::sqrt(double(nearest))) - 0.5f, float(kReach));
            distances[std::size_t(y) * std::size_t(map.columns) + std::size_t(x)] =
                missing ? distance : -distance;
        }
    return distances;
}

std::string rounded(double value) {
    return roundedText(value, 6);
}

bool asksPixelSize(const HeightOptions& options) {
    return options.pixelSize > 0 || options.pixelSides.x > 0;
}

Slab planSlab(const std::string& name, const Raster& raster, const RasterRange& range,
              const HeightOptions& options) {
    Slab slab{};
    const Vec3d pixel = cellSides(name, raster, /* image= */ true, options.pixelSize, options.pixelSides);
    slab.pixelX = pixel.x;
    slab.pixelY = pixel.y;
    const double side = std::max(raster.size.x * slab.pixelX, raster.size.y * slab.pixelY);
    slab.voxel = options.voxelSize > 0    ? options.voxelSize
                 : options.resolution > 0 ? side / options.resolution
                                          : std::min(slab.pixelX, slab.pixelY);
    slab.base = options.base > 0 ? options.base : side / 20;
    if (raster.white > 0) {
        slab.scale = (options.height > 0 ? options.height : side / 10) / raster.white;
        slab.offset = slab.low = 0;
        slab.high = range.maximum * slab.scale;
        return slab;
    }
    slab.scale = options.height > 0 && range.maximum > range.minimum
                     ? options.height / (range.maximum - range.minimum)
                     : 1;
    slab.offset = options.height > 0 ? -range.minimum * slab.scale : 0;
    slab.low = range.minimum * slab.scale + slab.offset;
    slab.high = range.maximum * slab.scale + slab.offset;
    return slab;
}

// The axes of columns, rows and height.
struct Axes {
    int column, row, height;
};

Axes axesOf(HeightPlane plane) {
    return plane == HeightPlane::XY   ? Axes{0, 1, 2}
           : plane == HeightPlane::YZ ? Axes{1, 2, 0}
                                      : Axes{2, 0, 1};
}

}  // namespace

void validate(const HeightOptions& options) {
    const auto length = [](double value, const char* field) {
        requireOption(value >= 0 && value < 1e30, field, roundedText(value, 6),
                      "above 0 (world), or 0 for the default");
    };
    length(options.voxelSize, "voxelSize");
    requirePixelSize(options.pixelSize, options.pixelSides);
    length(options.height, "height");
    length(options.base, "base");
    requireOption(options.resolution == 0 || (options.resolution >= 2 && options.resolution <= 100000),
                  "resolution", std::to_string(options.resolution), "a whole number from 2 to 100000");
}

RasterField heightField(const std::string& name, const Raster& given, const HeightOptions& options,
                        const RunContext& ctx) {
    validate(options);
    const Raster raster = luminance(given);
    const RasterRange range = rangeOf(raster);
    if (raster.size.z != 1)
        throw Error(ErrorCode::InvalidOption, name + ": is a volume of " + std::to_string(raster.size.z) +
                                                  " slices, not a height field");
    if (range.infinite > 0)
        throw Error(ErrorCode::BadData,
                    name + ": " + std::to_string(range.infinite) + " values are infinite");
    if (range.missing == raster.values.size())
        throw Error(ErrorCode::EmptyInput, name + ": no pixel has data");
    const Slab slab = planSlab(name, raster, range, options);
    const double columns = raster.size.x * slab.pixelX / slab.voxel,
                 rows = raster.size.y * slab.pixelY / slab.voxel,
                 tall = (slab.high - slab.low + slab.base) / slab.voxel;
    if (!(columns < 1e6 && rows < 1e6 && tall < 1e6 && std::abs(slab.low / slab.voxel) < 1e8 &&
          std::abs(slab.high / slab.voxel) < 1e8))
        throw Error(ErrorCode::Unusable, name + ": heights from " + rounded(slab.low) + " to " +
                                             rounded(slab.high) + " in voxels of " + rounded(slab.voxel) +
                                             " need over a million a side; use larger ones, or `height`");
    requireMemory(ctx, columns * rows * 8 * (60 + 0.016 * tall) + 2 * (columns + rows) * tall * 800,
                  name + " in voxels of " + rounded(slab.voxel),
                  "use a larger `voxelSize` or a smaller `resolution`");
    Stage stage(ctx, "heights to field", 1);
    const HeightMap pixels = fromRaster(raster),
                    map = resampled(pixels, slab.voxel / slab.pixelX, slab.voxel / slab.pixelY, ctx);
    const Axes axes = axesOf(options.plane);
    RasterField result;
    result.voxelSize = slab.voxel;
    if (map.columns < pixels.columns || map.rows < pixels.rows)
        result.lostShare = lostShare(pixels, map, slab);
    result.domain.min[axes.column] = result.domain.min[axes.row] = 0;
    result.domain.max[axes.column] = map.columns - 1;
    result.domain.max[axes.row] = map.rows - 1;
    // Heights are of surfaces, voxels of centres: the bottom is half a voxel below the domain.
    result.domain.min[axes.height] = int(std::lround((slab.low - slab.base) / slab.voxel + 0.5));
    result.domain.max[axes.height] =
        std::max(result.domain.min[axes.height], int(std::ceil(slab.high / slab.voxel)) + 3);
    const std::vector<float> edges = range.missing > 0 ? edgeDistances(map) : std::vector<float>();
    const double scale = slab.scale / slab.voxel, offset = slab.offset / slab.voxel;
    const double most = double(result.domain.size()[axes.height]) + 2 * kRasterFieldMargin + 4;
    const float unit = float(double(kRasterFieldLimit) / most);
    result.field = crossingField(
        result.domain.expanded(kRasterFieldMargin), kRasterFieldLimit, ctx,
        [&](const Index3& corner, const Index3& size, float* out) {
            forEachVoxel({corner, corner + size - Index3{1, 1, 1}}, [&](const Index3& p) {
                const int column = std::clamp(p[axes.column], 0, map.columns - 1),
                          row = std::clamp(p[axes.row], 0, map.rows - 1);
                const float height = map.at(column, row);
                const float edge =
                    edges.empty() ? -float(most)
                                  : edges[std::size_t(row) * std::size_t(map.columns) + std::size_t(column)];
                const float above =
                    std::isnan(height) ? edge : float(p[axes.height] - (double(height) * scale + offset));
                *out++ = std::max(above, edge) * unit;
            });
        });
    result.description = "heights from " + rounded(slab.low) + " to " + rounded(slab.high) + ", pixels of " +
                         rounded(slab.pixelX) +
                         (slab.pixelX == slab.pixelY ? "" : " x " + rounded(slab.pixelY)) + ", voxels of " +
                         rounded(slab.voxel) + " (world" +
                         (raster.unit.empty() || asksPixelSize(options) ? "" : ", in " + raster.unit) + ")" +
                         (options.height > 0 ? "" : "; `height` sets how tall it is");
    if (range.missing > 0)
        result.description += "; " + std::to_string(range.missing) + " pixels without data are holes";
    stage.advance();
    return result;
}

HeightImage topHeights(const BrickField& field, HeightPlane plane, const RunContext& ctx) {
    const IndexBox& domain = field.box();
    const Axes axes = axesOf(plane);
    const Index3 size = domain.size();
    HeightImage image{size[axes.column], size[axes.row], {}};
    image.heights.assign(std::size_t(image.columns) * std::size_t(image.rows), std::nanf(""));
    parallelFor(ctx, std::size_t(image.rows), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (int column = 0; column < image.columns; ++column) {
                Index3 p = domain.min;
                p[axes.column] += column;
                p[axes.row] += image.rows - 1 - int(row);  // the first row is the top one
                float above = -1;
                for (p[axes.height] = domain.max[axes.height]; p[axes.height] >= domain.min[axes.height];
                     --p[axes.height]) {
                    const float here = field.at(p);
                    if (here < 0) {
                        const float t = above >= 0 ? here / (here - above) : 0.5f;
                        image.heights[row * std::size_t(image.columns) + std::size_t(column)] =
                            float(p[axes.height]) + t;
                        break;
                    }
                    above = here;
                }
            }
    });
    return image;
}

}  // namespace vdbsynth
