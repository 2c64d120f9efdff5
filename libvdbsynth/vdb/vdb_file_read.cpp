#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <sys/stat.h>

namespace vdbsynth {
namespace {

constexpr std::uintmax_t kSmallFile = 1 << 20;

// Converts OpenVDB's exceptions into BadData. A small file that requests more memory than
// exists has a corrupt length.
template <typename Work>
void whileParsing(const std::string& path, Work&& work) {
    try {
        behindWall(ErrorCode::BadData, path + ": truncated or corrupt", work);
    } catch (const Error& error) {
        std::error_code ignored;
        if (error.code() != ErrorCode::Memory || std::filesystem::file_size(path, ignored) > kSmallFile)
            throw;
        throw Error(ErrorCode::BadData,
                    path + ": truncated or corrupt: it asks for more memory than there is");
    }
}

// OpenVDB's table of grid types, which only grids may change.
struct Kinds : openvdb::GridBase {
    using GridBase::registerGrid;
    using GridBase::unregisterGrid;
};

// OpenVDB refuses a whole file if one grid is of an unregistered type. With that type's name registered the
// file opens, and only reading that grid fails.
// @return number of unregistered types
std::size_t openWithUnsupported(openvdb::io::File& file) {
    std::vector<std::string> unsupported;
    const auto forget = [&unsupported] {
        for (const std::string& type : unsupported) Kinds::unregisterGrid(type);
    };
    for (;;) try {
            file.open(/* delayLoad= */ false);
            forget();
            return unsupported.size();
        } catch (const openvdb::LookupError& error) {
            const std::string text = error.what(), before = "Grid type ", after = " is not registered";
            const std::size_t begin = text.find(before), end = text.find(after);
            const bool known = begin != std::string::npos && end != std::string::npos && end > begin;
            const std::string type =
                known ? text.substr(begin + before.size(), end - begin - before.size()) : "";
            // All grid types have such names; any other name is the rest of a truncated file.
            if (type.compare(0, 5, "Tree_") != 0 || unsupported.size() == 64) {
                forget();
                throw;
            }
            unsupported.push_back(type);
            Kinds::registerGrid(unsupported.back(), [] { return openvdb::GridBase::Ptr(); });
        } catch (...) {
            forget();
            throw;
        }
}

// Opens after checks that give better messages than OpenVDB's own. Null for a gzip file.
std::unique_ptr<openvdb::io::File> openVdb(const std::string& path, std::size_t& unsupported) {
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
    if (probe.gcount() > 2 && isGzip(std::string(magic, 3))) return nullptr;
    if (std::string(magic, 4) != " BDV") throw Error(ErrorCode::BadData, path + ": not a VDB file");
    auto file = std::make_unique<openvdb::io::File>(path);
    whileParsing(path, [&] { unsupported = openWithUnsupported(*file); });
    return file;
}

VdbMetadata textOf(const openvdb::MetaMap& map) {
    VdbMetadata metadata;
    for (auto it = map.beginMeta(); it != map.endMeta(); ++it)
        metadata.emplace_back(it->first, it->second->str());
    return metadata;
}

VdbContents readPackedVdb(const std::string& path) {
    const std::string content = readWholeFile(path);
    if (content.compare(0, 4, " BDV") != 0)
        throw Error(ErrorCode::BadData, path + ": its content is not a VDB file");
    VdbContents contents;
    whileParsing(path, [&] {
        std::istringstream bytes(content);
        openvdb::io::Stream stream(bytes, /* delayLoad= */ false);
        contents.metadata = textOf(*stream.getMetadata());
        const openvdb::GridPtrVecPtr grids = stream.getGrids();
        contents.grids.assign(grids->begin(), grids->end());
    });
    return contents;
}

}  // namespace

VdbContents readVdb(const std::string& path, const RunContext& ctx) {
    Stage stage(ctx, "reading " + path, 1, /* reading= */ true);
    std::size_t unsupported = 0;
    const auto file = openVdb(path, unsupported);
    VdbContents contents;
    if (!file) {
        contents = readPackedVdb(path);
        stage.advance();
        return contents;
    }
    whileParsing(path, [&] {
        contents.metadata = textOf(*file->getMetadata());
        for (auto name = file->beginName(); name != file->endName(); ++name) try {
                contents.grids.push_back(file->readGrid(*name));
            } catch (const openvdb::KeyError&) {
                // If all types are registered, a grid that is not found lies beyond the file's end.
                if (unsupported == 0) throw Error(ErrorCode::BadData, path + ": truncated or corrupt");
                message(ctx, MessageLevel::Warning,
                        path + ": grid \"" + *name + "\" has a type that OpenVDB does not support; left out");
            }
    });
    stage.advance();
    return contents;
}

std::string nameOf(const openvdb::GridBase& grid) {
    return grid.getName();
}

std::vector<GridPtr> readVdbGrids(const std::string& path, const RunContext& ctx) {
    return readVdb(path, ctx).grids;
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

void requireGrids(const std::vector<GridPtr>& grids) {
    for (const GridPtr& grid : grids)
        if (!grid) throw Error(ErrorCode::InvalidOption, "`grids`: one of them is null");
}

std::vector<GridSummary> summarizeGrids(const std::vector<GridPtr>& grids) {
    requireGrids(grids);
    std::vector<GridSummary> summaries;
    for (const GridPtr& grid : grids) {
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

}  // namespace vdbsynth
