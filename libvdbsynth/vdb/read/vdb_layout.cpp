#include "libvdbsynth/vdb/read/vdb_layout.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/printable_text.h"

#include <openvdb/version.h>

#include <algorithm>

namespace vdbsynth {
namespace {

// Since these versions of the format: ids as text, metadata and compression per grid, half precision.
constexpr std::uint32_t kUsualValue = 1 << 16;  // [bytes] of one item of metadata
constexpr std::uint32_t kOldest = 222, kNewest = openvdb::OPENVDB_FILE_VERSION, kReadable = 200;
constexpr std::uint64_t kUuid = 36, kShortestMetadata = 12, kShortestGrid = 36;

class Walker {
public:
    Walker(const std::string& path, std::istream& bytes, std::uint64_t size)
        : mPath(path), mBytes(bytes), mSize(size) {}

    std::vector<VdbEntry> walk() {
        const auto magic = number<std::uint64_t>();
        if ((magic & 0xFFFFFFFFu) != 0x56444220u) refuse("not a VDB file");
        const auto version = number<std::uint32_t>();
        if (version < kReadable || version > kNewest)
            refuse("is of version " + std::to_string(version) + " of the VDB format; versions " +
                   std::to_string(kReadable) + " to " + std::to_string(kNewest) +
                   " are read: save it with an older OpenVDB, or the file is corrupt");
        // Of older files only what reading itself meets is checked.
        if (version < kOldest) return {};
        skip(2 * sizeof(std::uint32_t));
        const bool positions = number<char>() != 0;
        skip(kUuid);
        metadata();
        const auto count = number<std::int32_t>();
        if (count < 0 || std::uint64_t(count) > left() / kShortestGrid)
            refuse("its list names " + std::to_string(count) + " grids, more than the file has room for");
        std::vector<VdbEntry> entries;
        for (int i = 0; positions && i < count; ++i) entries.push_back(entry());
        return entries;
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(ErrorCode::BadData, mPath + ": " + what);
    }
    [[noreturn]] void cutOff() const {
        refuse("truncated: it ends at byte " + std::to_string(mSize) + ", in " + mPlace +
               "; copy or write it again");
    }
    [[noreturn]] void damaged() const { refuse("corrupt: the lengths of " + mPlace + " are damaged"); }

    std::uint64_t left() const { return mSize - mAt; }

    void skip(std::uint64_t count) {
        if (count > left()) cutOff();
        mAt += count;
        mBytes.seekg(std::streamoff(mAt));
    }

    template <typename T>
    T number() {
        if (sizeof(T) > left()) cutOff();
        T value{};
        mBytes.read(reinterpret_cast<char*>(&value), sizeof value);
        if (!mBytes) cutOff();
        mAt += sizeof value;
        return value;
    }

    std::string text() {
        const auto length = number<std::uint32_t>();
        if (length > left()) cutOff();
        std::string value(length, '\0');
        mBytes.read(value.data(), std::streamsize(length));
        if (!mBytes) cutOff();
        mAt += length;
        return value;
    }

    void metadata() {
        const auto count = number<std::uint32_t>();
        if (count > left() / kShortestMetadata) damaged();
        for (std::uint32_t i = 0; i < count; ++i) {
            (void)text();
            (void)text();
            const auto length = number<std::uint32_t>();
            // A value of a usual length is cut off; no value is as long as a damaged length says.
            if (length > left() && length > kUsualValue) damaged();
            skip(length);
        }
    }

    VdbEntry entry() {
        mPlace = "its list of grids";
        VdbEntry entry;
        entry.name = text();
        entry.type = text();
        const std::string instance = text();
        const auto grid = number<std::int64_t>(), blocks = number<std::int64_t>(),
                   end = number<std::int64_t>();
        mPlace = "grid \"" + printableText(entry.name.substr(0, entry.name.find('\x1e')), 80) + "\"";
        if (grid < 0 || std::uint64_t(grid) != mAt || blocks < grid || end < blocks) damaged();
        if (std::uint64_t(end) > mSize) cutOff();
        (void)number<std::uint32_t>();  // compression
        metadata();
        (void)text();  // kind of transform
        if (mAt > std::uint64_t(end)) damaged();
        mAt = std::uint64_t(end);
        mBytes.seekg(std::streamoff(mAt));
        return entry;
    }

    const std::string& mPath;
    std::istream& mBytes;
    const std::uint64_t mSize;
    std::uint64_t mAt = 0;
    std::string mPlace = "its head";
};

}  // namespace

std::vector<VdbEntry> vdbLayout(const std::string& path, std::istream& bytes, std::uint64_t size) {
    return Walker(path, bytes, size).walk();
}

}  // namespace vdbsynth
