#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetRebuild.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include <sys/stat.h>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

// Opens after the checks whose messages OpenVDB's own would not give.
std::unique_ptr<openvdb::io::File> openVdb(const std::string& path) {
    openvdb::initialize();
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) throw Error(ErrorCode::Io, path + ": no such file");
    if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::Io, path + ": is a directory; name a file");
    if (!S_ISREG(status.st_mode)) throw Error(ErrorCode::Io, path + ": is not a regular file");
    char magic[8] = {};
    std::ifstream probe(path, std::ios::binary);
    if (!probe) throw Error(ErrorCode::Io, path + ": cannot be read");
    probe.read(magic, sizeof magic);
    if (probe.gcount() == 0) throw Error(ErrorCode::BadData, path + ": the file is empty");
    if (std::string(magic, 4) != " BDV") throw Error(ErrorCode::BadData, path + ": not a VDB file");
    auto file = std::make_unique<openvdb::io::File>(path);
    behindWall(ErrorCode::BadData, path + ": truncated or corrupt",
               [&] { file->open(/* delayLoad= */ false); });
    return file;
}

struct ValueRange {
    double minimum = 0, maximum = 0;
    bool finite = true;
};

ValueRange rangeOf(const openvdb::FloatGrid& grid) {
    ValueRange range;
    range.finite = std::isfinite(grid.background());
    bool first = true;
    const auto add = [&](float value) {
        if (!std::isfinite(value)) {
            range.finite = false;
            return;
        }
        range.minimum = first ? double(value) : std::min(range.minimum, double(value));
        range.maximum = first ? double(value) : std::max(range.maximum, double(value));
        first = false;
    };
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    for (const Leaf* leaf : leaves)
        for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
            const float value = leaf->getValue(n);
            if (leaf->isValueOn(n))
                add(value);
            else if (!std::isfinite(value))
                range.finite = false;
        }
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (tile.isValueOn())
            add(*tile);
        else if (!std::isfinite(*tile))
            range.finite = false;
    }
    return range;
}

openvdb::FloatGrid::Ptr asFloat(const GridPtr& grid) {
    if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return floats;
    const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
    if (!doubles) return nullptr;
    auto copy = openvdb::FloatGrid::create(*doubles);  // metadata and transform
    copy->setTree(std::make_shared<openvdb::FloatTree>(doubles->tree()));
    return copy;
}

bool isLevelSet(const openvdb::FloatGrid& grid) {
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return true;
    if (grid.getGridClass() != openvdb::GRID_UNKNOWN || grid.background() <= 0) return false;
    const ValueRange range = rangeOf(grid);
    return range.minimum < 0 && range.maximum > 0;
}

openvdb::FloatGrid::Ptr pickGrid(const std::string& path, const std::vector<GridPtr>& grids,
                                 const VdbReadOptions& options) {
    std::string names;
    openvdb::FloatGrid::Ptr levelSet, fog;
    for (const GridPtr& grid : grids) {
        names += (names.empty() ? "" : ", ") + grid->getName() + " (" + grid->valueType() + ")";
        const openvdb::FloatGrid::Ptr floats = asFloat(grid);
        if (!options.gridName.empty() && grid->getName() == options.gridName) {
            if (!floats)
                throw Error(ErrorCode::BadData, path + ": grid \"" + options.gridName + "\" holds " +
                                                    grid->valueType() + "; a float or double grid is needed");
            return floats;
        }
        if (!floats) continue;
        if (isLevelSet(*floats)) {
            if (!levelSet || (floats->getName() == kSurfaceName && levelSet->getName() != kSurfaceName))
                levelSet = floats;
        } else if (!fog) {
            fog = floats;
        }
    }
    if (!options.gridName.empty())
        throw Error(ErrorCode::BadData, "--grid " + options.gridName + ": not in " + path + ", which has " +
                                            (names.empty() ? "no grids" : names));
    if (options.iso && fog) return fog;
    if (levelSet) return levelSet;
    if (fog) return fog;
    throw Error(ErrorCode::BadData, path + ": no usable grid; a float or double grid is needed, it has " +
                                        (names.empty() ? "no grids" : names));
}

void refuseUnusable(const std::string& path, const openvdb::FloatGrid& grid) {
    if (!grid.transform().isLinear())
        throw Error(ErrorCode::BadData, path + ": grid \"" + grid.getName() +
                                            "\" has a frustum transform; resample it to uniform voxels");
    if (grid.activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput, path + ": grid \"" + grid.getName() + "\" has no active voxels");
    if (!rangeOf(grid).finite)
        throw Error(ErrorCode::BadData,
                    path + ": grid \"" + grid.getName() + "\" holds NaN or infinite values");
    const openvdb::Mat4d m = grid.transform().baseMap()->getAffineMap()->getMat4();
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(m.asPointer()[i]))
            throw Error(ErrorCode::BadData, path + ": grid \"" + grid.getName() +
                                                "\" has a transform with NaN or infinite values");
    if (std::abs(m.det()) < 1e-300)
        throw Error(ErrorCode::BadData,
                    path + ": grid \"" + grid.getName() + "\" has a transform that flattens space");
}

// Rotation, mirror and uniform scale keep distances; anything else does not.
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

openvdb::FloatGrid::Ptr fogToLevelSet(const std::string& path, const openvdb::FloatGrid& fog, double iso,
                                      const RunContext& ctx) {
    const ValueRange range = rangeOf(fog);
    if (iso <= std::min(range.minimum, double(fog.background())) || iso >= range.maximum)
        throw Error(ErrorCode::Unusable,
                    "--iso " + std::to_string(iso) + ": no surface there; the values of \"" + fog.getName() +
                        "\" in " + path + " run from " +
                        std::to_string(std::min(range.minimum, double(fog.background()))) + " to " +
                        std::to_string(range.maximum));
    openvdb::FloatGrid::Ptr field = fog.deepCopy();
    for (auto it = field->beginValueAll(); it; ++it) it.setValue(float(iso) - *it);
    field->tree().root().setBackground(float(iso) - fog.background(), /* updateChildNodes= */ false);
    return rebuildLevelSet(*field, kHalfWidth, path + ": --iso", ctx);
}

}  // namespace

std::vector<GridPtr> readVdbGrids(const std::string& path, const RunContext& ctx) {
    Stage stage(ctx, "reading " + path, 1, /* reading= */ true);
    const auto file = openVdb(path);
    std::vector<GridPtr> grids;
    behindWall(ErrorCode::BadData, path + ": truncated or corrupt", [&] {
        const openvdb::GridPtrVecPtr all = file->getGrids();
        grids.assign(all->begin(), all->end());
    });
    stage.advance();
    return grids;
}

GridPtr readVdbGrid(const std::string& path, const std::string& name, const RunContext& ctx) {
    std::string names;
    for (const GridPtr& grid : readVdbGrids(path, ctx)) {
        if (grid->getName() == name) return grid;
        names += (names.empty() ? "" : ", ") + grid->getName();
    }
    throw Error(ErrorCode::BadData,
                path + ": no grid \"" + name + "\"; it has " + (names.empty() ? "no grids" : names));
}

FloatGridPtr readVdbFloatGrid(const std::string& path, const std::string& name, const RunContext& ctx) {
    VdbReadOptions options;
    options.gridName = name;
    const openvdb::FloatGrid::Ptr grid = pickGrid(path, readVdbGrids(path, ctx), options);
    refuseUnusable(path, *grid);
    return grid;
}

std::vector<GridSummary> summarizeVdb(const std::string& path, const RunContext& ctx) {
    std::vector<GridSummary> summaries;
    for (const GridPtr& grid : readVdbGrids(path, ctx)) {
        GridSummary summary;
        summary.name = grid->getName();
        summary.type = grid->valueType();
        summary.gridClass = openvdb::GridBase::gridClassToString(grid->getGridClass());
        summary.voxelSize = fromVec(grid->voxelSize());
        summary.linear = grid->transform().isLinear();
        summary.halfPrecision = grid->saveFloatAsHalf();
        summary.activeVoxels = grid->activeVoxelCount();
        summary.activeBox = fromBBox(grid->evalActiveVoxelBoundingBox());
        if (const auto floats = asFloat(grid)) {
            const ValueRange range = rangeOf(*floats);
            summary.isFloat = true;
            summary.background = double(floats->background());
            summary.minimum = range.minimum;
            summary.maximum = range.maximum;
            summary.finite = range.finite;
        }
        for (auto it = grid->beginMeta(); it != grid->endMeta(); ++it)
            summary.metadata.emplace_back(it->first, it->second->str());
        summaries.push_back(summary);
    }
    return summaries;
}

LevelSet readVdbModel(const std::string& path, const VdbReadOptions& options, const RunContext& ctx) {
    const std::vector<GridPtr> grids = readVdbGrids(path, ctx);
    openvdb::FloatGrid::Ptr grid = pickGrid(path, grids, options);
    refuseUnusable(path, *grid);
    LevelSet model;
    std::string domainText;
    if (const auto meta = grid->getMetadata<openvdb::StringMetadata>(kDomainKey)) domainText = meta->value();
    model.domainRecorded = parseBox(domainText, model.domain);
    if (!domainText.empty() && !model.domainRecorded)
        message(ctx, MessageLevel::Warning,
                path + ": metadata " + kDomainKey + " \"" + domainText + "\" is not i,j,k,I,J,K; ignored");
    const bool asFog =
        !isLevelSet(*grid) || (options.iso && grid->getGridClass() == openvdb::GRID_FOG_VOLUME);
    if (asFog && !options.iso)
        throw Error(
            ErrorCode::Unusable,
            path + ": grid \"" + grid->getName() + "\" is a " +
                (grid->getGridClass() == openvdb::GRID_FOG_VOLUME ? "fog volume" : "plain scalar grid") +
                ", not a level set; say where its surface is with --iso VALUE (its values run from " +
                std::to_string(rangeOf(*grid).minimum) + " to " + std::to_string(rangeOf(*grid).maximum) +
                ")");
    if (!keepsDistances(*grid)) {
        const Vec3d size = fromVec(grid->voxelSize());
        const double smallest = std::min({size.x, size.y, size.z});
        message(ctx, MessageLevel::Note,
                path + ": voxels are not cubes; resampled to " + std::to_string(smallest));
        const auto transform = openvdb::math::Transform::createLinearTransform(smallest);
        if (asFog) {
            for (auto it = grid->beginValueAll(); it; ++it) it.setValue(float(*options.iso) - *it);
            grid->tree().root().setBackground(float(*options.iso) - grid->background(), false);
        }
        grid = behindWall(ErrorCode::Unusable, path, [&] {
            return openvdb::tools::levelSetRebuild(*grid, 0.f, kHalfWidth, kHalfWidth, transform.get());
        });
        model.domainRecorded = false;
    } else if (asFog) {
        grid = fogToLevelSet(path, *grid, *options.iso, ctx);
    }
    const double halfWidth = halfWidthOf(*grid);
    if (!(halfWidth >= 1.5))
        throw Error(ErrorCode::Unusable,
                    path + ": its band of " + std::to_string(halfWidth) +
                        " voxels a side is under 1.5; rebuild the level set with a wider band");
    model.grid = grid;
    if (!model.domainRecorded) model.domain = solidBox(*grid, path);
    stampLevelSet(model);
    return model;
}

}  // namespace vdbsynth
