#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/io/Archive.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace vdbsynth {
namespace {

// openvdb::io::File::write does not detect a full disk; writing through our own stream does.
class StreamArchive : public openvdb::io::Archive {
public:
    void writeTo(std::ostream& stream, const openvdb::GridCPtrVec& grids,
                 const openvdb::MetaMap& metadata) const {
        openvdb::io::Archive::write(stream, grids, /* seekable= */ true, metadata);
    }
};

// Where the header keeps its UUID: magic (8), file version (4), library version (8), grid-offsets flag (1).
constexpr std::streamoff kUuidOffset = 21;
constexpr std::size_t kUuidLength = 36;

// Blanks the UUID, hashes the file and writes the hash in a UUID's form.
void replaceUuid(const std::string& path) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const auto put = [&file](const std::string& uuid) {
        file.seekp(kUuidOffset);
        file.write(uuid.data(), std::streamsize(uuid.size()));
        file.flush();
    };
    put(std::string(kUuidLength, '0'));
    const std::string hash = fileHash(path);
    put(hash.substr(0, 8) + '-' + hash.substr(8, 4) + '-' + hash.substr(12, 4) + '-' + hash.substr(16, 4) +
        '-' + hash.substr(20, 12));
    file.close();
    if (!file) throw Error(ErrorCode::Io, path + ": writing failed: " + std::strerror(errno));
}

}  // namespace

void writeVdb(const std::string& path, const std::vector<GridPtr>& grids, const VdbMetadata& metadata) {
    requireGrids(grids);
    openvdb::initialize();
    openvdb::MetaMap map;
    for (const auto& [name, value] : metadata) map.insertMeta(name, openvdb::StringMetadata(value));
    const openvdb::GridCPtrVec constGrids(grids.begin(), grids.end());
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!file) throw Error(ErrorCode::Io, path + ": cannot be written: " + std::strerror(errno));
    behindWall(ErrorCode::Io, path, [&] { StreamArchive().writeTo(file, constGrids, map); });
    file.close();
    if (!file)
        throw Error(ErrorCode::Io, path + ": writing failed: " + std::strerror(errno ? errno : ENOSPC));
    replaceUuid(path);
}

}  // namespace vdbsynth
