// A VDB file's grid as a level set.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/convert/far_grid.h"
#include "libvdbsynth/vdb/convert/surface_kept.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/read/field_kind.h"
#include "libvdbsynth/vdb/read/level_set_repair.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "libvdbsynth/vdb/wall.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// OpenVDB refuses to scale by voxels of less volume.
constexpr double kLeastVoxel = 3e-15;

void refuseUnusable(const std::string& path, const openvdb::FloatGrid& grid) {
    if (!grid.transform().isLinear())
        throw Error(ErrorCode::BadData, path + ": grid \"" + grid.getName() +
                                            "\" has a frustum transform; resample it to uniform voxels");
    if (grid.activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput, path + ": grid \"" + grid.getName() + "\" has no active voxels");
    if (!rangeOf(grid).finite)
        throw Error(ErrorCode::BadData,
                    path + ": grid \"" + grid.getName() + "\" holds NaN or infinite values");
    const openvdb::Vec3d size = grid.voxelSize();
    const double volume = size[0] * size[1] * size[2];
    if (volume > 0 && volume < kLeastVoxel)
        throw Error(ErrorCode::BadData, path + ": grid \"" + grid.getName() + "\" has voxels of " +
                                            roundedText(size[0], 3) +
                                            ", and OpenVDB works with none under about 0.000015; scale its "
                                            "transform by 1000 where it was made");
    // OpenVDB throws for some singular transforms.
    const openvdb::Mat4d m =
        behindWall(ErrorCode::BadData, path + ": grid \"" + grid.getName() + "\" has a bad transform",
                   [&] { return grid.transform().baseMap()->getAffineMap()->getMat4(); });
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(m.asPointer()[i]))
            throw Error(ErrorCode::BadData, path + ": grid \"" + grid.getName() +
                                                "\" has a transform with NaN or infinite values");
    if (std::abs(m.det()) < 1e-300)
        throw Error(ErrorCode::BadData, path + ": grid \"" + grid.getName() + "\" has a singular transform");
}

// Rotation, reflection and uniform scale keep distances; nothing else does.
bool keepsDistances(const openvdb::FloatGrid& grid) {
    const openvdb::Mat4d m = grid.transform().baseMap()->getAffineMap()->getMat4();
    const openvdb::Mat3d linear = m.getMat3();
    const openvdb::Mat3d product = linear * linear.transpose();
    const double s = product(0, 0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(product(i, j) - (i == j ? s : 0)) > 1e-6 * s) return false;
    return true;
}

// The zero level in the voxels of another transform.
openvdb::FloatGrid::Ptr rebuiltBy(const openvdb::FloatGrid& grid, const openvdb::math::Transform& transform,
                                  const std::string& what, const RunContext& ctx) {
    const openvdb::FloatGrid::Ptr lattice = openvdb::FloatGrid::create();
    lattice->setTransform(transform.copy());
    return resampleLevelSet(grid, *lattice, kHalfWidth, what, ctx);
}

// Negative where a fog is denser than `iso`.
openvdb::FloatGrid::Ptr insideOut(const openvdb::FloatGrid& fog, double iso) {
    openvdb::FloatGrid::Ptr field = fog.deepCopy();
    for (auto it = field->beginValueAll(); it; ++it) it.setValue(float(iso) - *it);
    field->tree().root().setBackground(float(iso) - fog.background(), /* updateChildNodes= */ false);
    return field;
}

openvdb::FloatGrid::Ptr fogToLevelSet(const std::string& path, const openvdb::FloatGrid& fog, double iso,
                                      const RunContext& ctx) {
    const ValueRange range = rangeOf(fog);
    if (iso <= std::min(range.minimum, double(fog.background())) || iso >= range.maximum)
        throw Error(ErrorCode::Unusable,
                    "`iso` " + std::to_string(iso) + ": no surface there; the values of \"" + fog.getName() +
                        "\" in " + path + " range from " +
                        std::to_string(std::min(range.minimum, double(fog.background()))) + " to " +
                        std::to_string(range.maximum));
    return rebuildLevelSet(*insideOut(fog, iso), kHalfWidth, path + ": `iso`", ctx);
}

// What lies beyond a fog's voxels is not solid, whatever its background says.
openvdb::FloatGrid::Ptr emptyAround(const std::string& path, const openvdb::FloatGrid::Ptr& fog, double iso,
                                    const RunContext& ctx) {
    const ValueRange range = rangeOf(*fog);
    if (!(double(fog->background()) > iso) || !(range.minimum < iso)) return fog;
    message(ctx, MessageLevel::Note,
            path + ": grid \"" + fog->getName() + "\": its background of " +
                roundedText(double(fog->background()), 4) +
                " would be solid; what lies beyond its voxels is taken as outside");
    openvdb::FloatGrid::Ptr field = fog->deepCopy();
    for (auto it = field->beginValueOff(); it; ++it)
        if (*it == fog->background()) it.setValue(float(range.minimum));
    field->tree().root().setBackground(float(range.minimum), /* updateChildNodes= */ false);
    return field;
}

// A field of distances whose surface lies at `iso`; a level set as it is.
openvdb::FloatGrid::Ptr atDistance(const std::string& path, const openvdb::FloatGrid::Ptr& grid,
                                   FieldKind kind, const std::optional<double>& iso, const RunContext& ctx) {
    const std::string named = path + ": grid \"" + grid->getName() + "\"";
    if (kind == FieldKind::LevelSet) {
        if (iso)
            message(ctx, MessageLevel::Note,
                    named + " is a level set, whose surface is known; `iso` is ignored");
        return grid;
    }
    message(ctx, MessageLevel::Note,
            named + " has no class, but its values are distances to a surface; read as a level set" +
                (iso ? ", with the surface at `iso`" : ""));
    if (!iso || *iso == 0) return grid;
    openvdb::FloatGrid::Ptr field = grid->deepCopy();
    for (auto it = field->beginValueOn(); it; ++it) it.setValue(*it - float(*iso));
    return field;
}

GridPtr picked(const std::string& path, const std::vector<GridPtr>& grids, const VdbReadOptions& options,
               const RunContext& ctx) {
    std::string note;
    GridPtr grid = pickedGrid(path, grids, options, &note);
    if (!note.empty()) message(ctx, MessageLevel::Note, note);
    return grid;
}

// A solid that a clip cut is part of a larger one: its domain ends at the cuts, and at the other sides, where
// none is known, with air beyond the band.
void endAtCuts(const CutFaces& cut, const std::string& path, LevelSet& model) {
    if (std::none_of(cut.begin(), cut.end(), [](bool face) { return face; })) return;
    const IndexBox solid = solidBox(*model.grid, path);
    const int air = int(std::ceil(halfWidthOf(*model.grid))) + 1;
    for (std::size_t face = 0; face < 6; ++face) {
        const bool high = face % 2;
        const int axis = int(face / 2), end = high ? solid.max[axis] : solid.min[axis];
        int& domain = high ? model.domain.max[axis] : model.domain.min[axis];
        if (cut[face])
            domain = high ? std::min(domain, end) : std::max(domain, end);
        else if (!model.domainRecorded)
            domain = end + (high ? air : -air);
    }
    model.domainRecorded = true;
}

}  // namespace

void validate(const VdbReadOptions& options) {
    requireOption(!options.iso || std::isfinite(*options.iso), "iso",
                  options.iso ? exactText(*options.iso) : "", "a number");
}

FloatGridPtr readVdbFloatGrid(const std::string& path, const std::string& name, const RunContext& ctx) {
    VdbReadOptions options;
    options.gridName = name;
    const openvdb::FloatGrid::Ptr grid = asFloat(picked(path, readVdbGrids(path, ctx), options, ctx));
    refuseUnusable(path, *grid);
    return grid;
}

LevelSet readVdbModel(const std::string& path, const VdbReadOptions& options, const RunContext& ctx) {
    return modelFromGrids(path, readVdbGrids(path, ctx), options, ctx);
}

LevelSet modelFromGrids(const std::string& path, const std::vector<GridPtr>& grids,
                        const VdbReadOptions& options, const RunContext& ctx) {
    validate(options);
    for (const GridPtr& grid : grids)
        if (!grid) throw Error(ErrorCode::InvalidOption, path + ": one of the `grids` is null");
    const openvdb::FloatGrid::Ptr given = asFloat(picked(path, grids, options, ctx));
    refuseUnusable(path, *given);
    // A separate name, metadata and transform; the tree is the caller's and does not change.
    openvdb::FloatGrid::Ptr grid = nearZero(given->copy());
    LevelSet model;
    std::string domainText;
    if (const auto meta = grid->getMetadata<openvdb::StringMetadata>(kDomainKey)) domainText = meta->value();
    model.domainRecorded = parseBox(domainText, model.domain);
    if (!domainText.empty() && !model.domainRecorded)
        message(ctx, MessageLevel::Warning,
                path + ": metadata " + kDomainKey + " \"" + domainText + "\" is not i,j,k,I,J,K; ignored");
    const openvdb::Vec3d zero = grid->worldToIndex(given->indexToWorld(openvdb::Coord(0)));
    const Index3 moved = fromCoord(openvdb::Coord::round(zero));
    model.domain = {model.domain.min + moved, model.domain.max + moved};
    const FieldKind kind = kindOf(*grid, ctx);
    const bool asFog = kind == FieldKind::Density;
    if (asFog && !options.iso)
        throw Error(
            ErrorCode::Unusable,
            path + ": grid \"" + grid->getName() + "\" is a " +
                (grid->getGridClass() == openvdb::GRID_FOG_VOLUME ? "fog volume" : "plain scalar grid") +
                ", not a level set; set the value of its surface with `iso` VALUE (its values range from " +
                std::to_string(rangeOf(*grid).minimum) + " to " + std::to_string(rangeOf(*grid).maximum) +
                ")");
    RepairedField sound;
    sound.field =
        asFog ? emptyAround(path, grid, *options.iso, ctx) : atDistance(path, grid, kind, options.iso, ctx);
    if (!asFog) {
        sound = repairedField(sound.field, ctx);
        for (const std::string& text : sound.said)
            message(ctx, MessageLevel::Note, path + ": grid \"" + grid->getName() + "\": " + text);
    }
    grid = sound.field;
    if (!keepsDistances(*grid)) {
        const Vec3d size = fromVec(grid->voxelSize());
        const double smallest = std::min({size.x, size.y, size.z});
        message(ctx, MessageLevel::Note,
                path + ": voxels are not cubes; resampled to " + std::to_string(smallest));
        const auto transform = openvdb::math::Transform::createLinearTransform(smallest);
        const Vec3d middle = fromVec(grid->indexToWorld(grid->evalActiveVoxelBoundingBox().getCenter()));
        if (std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) > kFarVoxels * smallest)
            transform->postTranslate(toVec(wholeVoxels(middle, smallest).voxels * smallest));
        if (asFog) grid = insideOut(*grid, *options.iso);
        grid = rebuiltBy(*grid, *transform, path, ctx);
        model.domainRecorded = false;
        sound.cut = {};  // of the sides of other voxels
    } else if (asFog) {
        grid = fogToLevelSet(path, *grid, *options.iso, ctx);
    } else if (sound.measureAnew) {
        grid = rebuildLevelSet(*grid, sound.halfWidth, path, ctx);
    }
    model.grid = grid;
    if (!model.domainRecorded) model.domain = solidBox(*grid, path);
    endAtCuts(sound.cut, path, model);
    stampLevelSet(model);
    return model;
}

namespace {

// Of the model's surface, in the voxels of what it was resampled to.
void requireResampledKept(const LevelSet& model, openvdb::FloatGrid& grid, const std::string& name,
                          const RunContext& ctx) {
    const double ratio = voxelSizeOf(*model.grid) / voxelSizeOf(grid);
    if (ratio >= 1) return;  // finer voxels keep everything
    Mesh mesh = zeroLevelInIndexSpace(*model.grid, 0, ctx);
    for (Vec3f& p : mesh.points) p = p * float(ratio);
    requireKept(mesh, grid, name, ctx);
}

}  // namespace

LevelSet resampled(const LevelSet& model, double voxelSize, const RunContext& ctx, const std::string& name) {
    requireModel(&model, "the model", ctx);
    requireOption(voxelSize > 0 && voxelSize < 1e30, "voxelSize", roundedText(voxelSize, 6),
                  "above 0 (world)");
    const double ratio = voxelSizeOf(*model.grid) / voxelSize;
    requireOption(ratio < 1e4 && ratio > 1e-6, "voxelSize", roundedText(voxelSize, 6),
                  "from 1/10000 to 1000000 times the model's voxel size");
    requireMemory(ctx, double(model.grid->activeVoxelCount()) * ratio * ratio * 40,
                  "voxels of " + std::to_string(voxelSize), "use larger ones");
    Stage stage(ctx, "resampling", 1);
    LevelSet result;
    // Scaled in index space: the transform keeps its rotation and origin.
    const openvdb::math::Transform::Ptr transform = model.grid->transform().copy();
    transform->preScale(1 / ratio);
    result.grid =
        rebuiltBy(*model.grid, *transform, name + ": in voxels of " + roundedText(voxelSize, 4) + " it", ctx);
    throwIfCancelled(ctx);
    requireResampledKept(model, *result.grid, name, ctx);
    result.domain = solidBox(*result.grid, "the model in voxels of " + std::to_string(voxelSize));
    if (model.domainRecorded) {
        for (int axis = 0; axis < 3; ++axis) {
            result.domain.min[axis] = int(std::lround((model.domain.min[axis] - 0.5) * ratio + 0.5));
            result.domain.max[axis] = std::max(
                result.domain.min[axis], int(std::lround((model.domain.max[axis] + 0.5) * ratio - 0.5)));
        }
        result.domainRecorded = true;
    }
    stampLevelSet(result);
    stage.advance();
    return result;
}

}  // namespace vdbsynth
