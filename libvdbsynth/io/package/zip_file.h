#pragma once
#include "libvdbsynth/base/run_context.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vdbsynth {

/// An archive in memory, as PKWARE's APPNOTE 6.3 describes it, with the 64 bit sizes. Stored and deflated
/// entries are read. Hostile: every offset and size is checked, and no memory is taken for a claimed size.
class ZipFile {
public:
    struct Entry {
        std::string name;  ///< as stored, without a slash at its beginning
        std::uint64_t packed = 0, size = 0, offset = 0;
        std::uint32_t crc = 0;
        std::uint16_t method = 0, flags = 0;
    };

    /// Reads the directory at the archive's end. Both are borrowed. @param path  for messages
    /// @throw Error BadData (no archive, truncated, several disks, entries that overlap or
    ///              have one name)
    ZipFile(const std::string& path, std::string_view content);

    const std::vector<Entry>& entries() const { return mEntries; }
    /// The entry of that name in any case, as packages name their parts; null if there is none.
    const Entry* find(std::string_view name) const;
    /// Bytes of an entry, whose checksum is right.
    /// @throw Error BadData (encrypted, another method, truncated, corrupt), Memory (over ctx.maxMemory)
    std::string read(const Entry& entry, const RunContext& ctx) const;

private:
    void readDirectory(std::uint64_t offset, std::uint64_t count);

    const std::string& mPath;
    std::string_view mContent;
    std::vector<Entry> mEntries;
    std::map<std::string, std::size_t> mByName;  // in small letters
};

/// Builds an archive of deflated entries, all of one date, so that equal entries give equal bytes.
class ZipWriter {
public:
    /// Adds an entry whose text comes in pieces, which are made and packed in parallel, each held only until
    /// it is packed. @param piece  text of a piece, at most 1 GB; called by any thread
    /// @throw Error Unusable (over 4 GB in all)
    void add(const std::string& name, std::size_t pieces,
             const std::function<std::string(std::size_t)>& piece);
    void add(const std::string& name, const std::string& text);
    /// The archive; the writer is then empty.
    std::string finish();

private:
    std::string mBytes, mDirectory;
    std::size_t mCount = 0;
};

}  // namespace vdbsynth
