#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/read/grid_names.h"
#include "libvdbsynth/vdb/read/metadata_format.h"
#include "libvdbsynth/vdb/read/vdb_layout.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <sys/stat.h>

namespace vdbsynth {
namespace {

constexpr std::uintmax_t kSmallFile = 1 << 20;

// Converts OpenVDB's exceptions into BadData, without what they quote of the file. A small file that requests
// more memory than exists has a corrupt length.
template <typename Work>
void whileParsing(const std::string& path, std::uint64_t size, Work&& work) {
    const std::string damaged = path + ": truncated or corrupt";
    try {
        behindWall(ErrorCode::BadData, damaged, work);
    } catch (const Error& error) {
        const std::string said = error.what();
        if (said.compare(0, damaged.size(), damaged) != 0) throw;
        if (error.code() == ErrorCode::Memory) {
            if (size > kSmallFile) throw;
            throw Error(ErrorCode::BadData, damaged + ": it asks for more memory than there is");
        }
        // What a stream says of its end is a phrase of the C++ library.
        const bool ended = said.find("iostream error") != std::string::npos;
        throw Error(error.code(),
                    damaged + ": " +
                        (ended ? "it ends amid its voxels"
                               : printableText(said.substr(std::min(said.size(), damaged.size() + 2)), 80)) +
                        "; copy or write it again");
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

VdbMetadata textOf(const openvdb::MetaMap& map) {
    VdbMetadata metadata;
    for (auto it = map.beginMeta(); it != map.endMeta(); ++it)
        metadata.emplace_back(it->first, it->second->str());
    return metadata;
}

// @throw Error that the path is no file to read
void requireFile(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) throw Error(ErrorCode::Io, path + ": no such file");
    if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::Io, path + ": is a directory; name a file");
    if (!S_ISREG(status.st_mode)) throw Error(ErrorCode::Io, path + ": is not a regular file");
}

// OpenVDB throws when it is to set its own entries where a damaged file has them as of another type.
void dropDamagedEntries(VdbContents& contents) {
    for (const GridPtr& grid : contents.grids)
        for (const char* entry : {openvdb::GridBase::META_GRID_CLASS, openvdb::GridBase::META_GRID_NAME}) {
            const openvdb::Metadata::Ptr value = (*grid)[entry];
            if (value && value->typeName() != "string") grid->removeMeta(entry);
        }
}

// The beginning of a file, after checks that give better messages than OpenVDB's own.
std::string beginningOf(const std::string& path, std::istream& file) {
    char magic[8] = {};
    file.read(magic, sizeof magic);
    if (file.gcount() == 0) throw Error(ErrorCode::BadData, path + ": the file is empty");
    return std::string(magic, std::size_t(file.gcount()));
}

bool isSupported(const VdbEntry& entry) {
    return openvdb::GridBase::isRegistered(entry.type);
}

// All of a file whose grids are of known types, in one pass. The stream throws at its end: OpenVDB goes on
// reading zeros, for minutes where a count is damaged.
VdbContents readWhole(const std::string& path, std::istream& bytes, std::uint64_t size) {
    VdbContents contents;
    whileParsing(path, size, [&] {
        bytes.clear();
        bytes.seekg(0);
        bytes.exceptions(std::ios::failbit | std::ios::badbit);
        openvdb::io::Stream stream(bytes, /* delayLoad= */ false);
        contents.metadata = textOf(*stream.getMetadata());
        const openvdb::GridPtrVecPtr grids = stream.getGrids();
        contents.grids.assign(grids->begin(), grids->end());
    });
    return contents;
}

// Those grids of a file that are of known types, by their positions in it.
VdbContents readSupported(const std::string& path, std::uint64_t size, const RunContext& ctx) {
    VdbContents contents;
    whileParsing(path, size, [&] {
        openvdb::io::File file(path);
        const std::size_t unsupported = openWithUnsupported(file);
        contents.metadata = textOf(*file.getMetadata());
        for (auto name = file.beginName(); name != file.endName(); ++name) try {
                contents.grids.push_back(file.readGrid(*name));
            } catch (const openvdb::KeyError&) {
                // If all types are registered, a grid that is not found lies beyond the file's end.
                if (unsupported == 0) throw Error(ErrorCode::BadData, path + ": truncated or corrupt");
                message(ctx, MessageLevel::Warning,
                        path + ": grid \"" + printableText(*name, 80) +
                            "\" has a type that OpenVDB does not support; left out");
            }
    });
    return contents;
}

VdbContents readUnpacked(const std::string& path, std::istream& bytes, std::uint64_t size,
                         const RunContext& ctx) {
    const std::vector<VdbEntry> entries = vdbLayout(path, bytes, size);
    if (std::all_of(entries.begin(), entries.end(), isSupported)) return readWhole(path, bytes, size);
    return readSupported(path, size, ctx);
}

}  // namespace

VdbContents readVdb(const std::string& path, const RunContext& ctx) {
    Stage stage(ctx, "reading " + path, 1, /* reading= */ true);
    openvdb::initialize();
    requireFile(path);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(ErrorCode::Io, path + ": cannot be read");
    const std::string beginning = beginningOf(path, file);
    VdbContents contents;
    if (isGzip(beginning)) {
        std::istringstream bytes(readWholeFile(path));
        const std::uint64_t size = bytes.str().size();
        if (bytes.str().compare(0, 4, " BDV") != 0)
            throw Error(ErrorCode::BadData, path + ": its content is not a VDB file");
        (void)vdbLayout(path, bytes, size);
        contents = readWhole(path, bytes, size);
    } else {
        if (beginning.compare(0, 4, " BDV") != 0) throw Error(ErrorCode::BadData, path + ": not a VDB file");
        file.seekg(0);
        contents = readUnpacked(path, file, std::filesystem::file_size(path), ctx);
    }
    dropDamagedEntries(contents);
    const std::string unknown = unknownMetadata(contents.metadata);
    if (!unknown.empty()) message(ctx, MessageLevel::Warning, path + ": " + unknown);
    // By name, and grids of one name as the file has them.
    std::stable_sort(contents.grids.begin(), contents.grids.end(),
                     [](const GridPtr& a, const GridPtr& b) { return a->getName() < b->getName(); });
    stage.advance();
    return contents;
}

std::string nameOf(const openvdb::GridBase& grid) {
    return grid.getName();
}

std::vector<GridPtr> readVdbGrids(const std::string& path, const RunContext& ctx) {
    return readVdb(path, ctx).grids;
}

void requireGrids(const std::vector<GridPtr>& grids) {
    for (const GridPtr& grid : grids)
        if (!grid) throw Error(ErrorCode::InvalidOption, "`grids`: one of them is null");
}

std::vector<GridSummary> summarizeGrids(const std::vector<GridPtr>& grids) {
    requireGrids(grids);
    std::vector<GridSummary> summaries;
    const std::vector<std::string> names = uniqueNamesOf(grids);
    for (const GridPtr& grid : grids) {
        GridSummary summary;
        summary.name = names[summaries.size()];
        summary.type = grid->valueType();
        summary.gridClass = openvdb::GridBase::gridClassToString(grid->getGridClass());
        summary.voxelSize = fromVec(grid->voxelSize());
        summary.linear = grid->transform().isLinear();
        if (summary.linear) {
            const openvdb::Mat4R matrix = grid->transform().baseMap()->getAffineMap()->getMat4();
            // OpenVDB multiplies rows from the left, so its rows are our columns.
            for (int i = 0; i < 16; ++i) summary.transform[std::size_t(i)] = matrix(i / 4, i % 4);
        }
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
