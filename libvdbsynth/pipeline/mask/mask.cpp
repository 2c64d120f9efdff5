#include "libvdbsynth/pipeline/mask/mask.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/mask.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::pair<const char*, MaskKind> kKinds[] = {{"box", MaskKind::Box},
                                                       {"ball", MaskKind::Ball},
                                                       {"inside", MaskKind::Inside},
                                                       {"range", MaskKind::Range}};

std::string wordOf(MaskKind kind) {
    for (const auto& [word, meaning] : kKinds)
        if (meaning == kind) return word;
    return "?";
}

double voxelSizeOf(const MaskOptions& options) {
    return options.voxelSize.value_or(1);
}

void requireFields(bool given, MaskKind kind, const std::string& fields) {
    if (!given) throw Error(ErrorCode::InvalidOption, "mask " + wordOf(kind) + ": give " + fields);
}

void requireBall(const MaskOptions& options) {
    requireFields(options.center && options.radius, MaskKind::Ball, "`center` and `radius` (world)");
    const Vec3d c = *options.center;
    const double voxel = voxelSizeOf(options);
    for (int axis = 0; axis < 3; ++axis)
        requireOption(std::abs(c[axis]) / voxel < 1e8, "center",
                      roundedText(c.x, 6) + "," + roundedText(c.y, 6) + "," + roundedText(c.z, 6),
                      "within 100 million voxels of the origin");
    requireOption(*options.radius > 0 && *options.radius < 1e4 * voxel, "radius",
                  roundedText(*options.radius, 6), "above 0 (world) and under ten thousand voxels");
}

// What is given for another kind would be lost in silence.
void sayUnused(const MaskOptions& options, const RunContext& ctx) {
    const bool shape = options.kind == MaskKind::Box || options.kind == MaskKind::Ball;
    const std::pair<const char*, bool> unused[] = {
        {"box", options.box && options.kind != MaskKind::Box},
        {"center", options.center && options.kind != MaskKind::Ball},
        {"radius", options.radius && options.kind != MaskKind::Ball},
        {"range", options.range && options.kind != MaskKind::Range},
        {"voxelSize", options.voxelSize && !shape}};
    for (const auto& [field, is] : unused)
        if (is)
            message(ctx, MessageLevel::Note,
                    std::string("`") + field + "` has no effect on mask " + wordOf(options.kind));
}

void sayNothing(const openvdb::FloatGrid& grid, double low, double high, const RunContext& ctx) {
    float least = std::numeric_limits<float>::max(), most = -least;
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        least = std::min(least, *value);
        most = std::max(most, *value);
    }
    message(ctx, MessageLevel::Warning,
            "the mask is empty: no value lies from " + roundedText(low, 6) + " to " + roundedText(high, 6) +
                (least > most ? ", as the grid has no active voxel"
                              : "; the grid's values go from " + roundedText(double(least), 6) + " to " +
                                    roundedText(double(most), 6)));
}

GridPtr boxOf(const MaskOptions& options, const RunContext& ctx) {
    const Index3 size = options.box->size();
    const Vec3d s{double(size.x), double(size.y), double(size.z)};
    // Leaf nodes along the surface, tiles of 128^3 inside.
    requireMemory(ctx, (s.x * s.y + s.y * s.z + s.z * s.x) / 32 * 128 + s.x * s.y * s.z / 2e6 * 64,
                  "a mask of " + boxText(*options.box), "use a smaller `box`");
    return boxMask(*options.box, voxelSizeOf(options));
}

GridPtr ballOf(const MaskOptions& options, const RunContext& ctx) {
    const double side = 2 * *options.radius / voxelSizeOf(options);
    requireMemory(ctx, side * side * side, "`radius` " + roundedText(*options.radius, 6),
                  "use a smaller radius or a larger `voxelSize`");
    return ballMask(*options.center, *options.radius, voxelSizeOf(options), ctx);
}

}  // namespace

bool parseMaskKind(const std::string& text, MaskKind& kind) {
    for (const auto& [word, meaning] : kKinds)
        if (text == word) {
            kind = meaning;
            return true;
        }
    return false;
}

void validate(const MaskOptions& options) {
    const double voxel = voxelSizeOf(options);
    requireOption(voxel > 0 && voxel < 1e30, "voxelSize", roundedText(voxel, 6), "above 0 (world)");
    if (options.kind == MaskKind::Box) {
        requireFields(options.box.has_value(), options.kind, "`box`, the first and the last voxel");
        requireBox(*options.box, "box");
    } else if (options.kind == MaskKind::Ball) {
        requireBall(options);
    } else if (options.kind == MaskKind::Range) {
        requireFields(options.range.has_value(), options.kind, "`range`, the lowest and the highest value");
        const auto [low, high] = *options.range;
        requireOption(low <= high, "range", roundedText(low, 6) + "," + roundedText(high, 6),
                      "two numbers, the lower one first");
    }
}

GridPtr makeMask(const MaskOptions& options, const FloatGridConstPtr& grid, const RunContext& ctx) {
    validate(options);
    const bool wanted = options.kind == MaskKind::Inside || options.kind == MaskKind::Range;
    if (wanted != (grid != nullptr))
        throw Error(ErrorCode::InvalidOption, "mask " + wordOf(options.kind) +
                                                  (wanted ? ": give a model or a grid" : ": takes no model"));
    sayUnused(options, ctx);
    if (options.kind == MaskKind::Box) return boxOf(options, ctx);
    if (options.kind == MaskKind::Ball) return ballOf(options, ctx);
    if (options.kind == MaskKind::Inside) return insideMask(*grid, ctx);
    const auto [low, high] = *options.range;
    const GridPtr made = rangeMask(*grid, low, high, ctx);
    if (made->empty()) sayNothing(*grid, low, high, ctx);
    return made;
}

}  // namespace vdbsynth
