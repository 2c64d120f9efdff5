#include "libvdbsynth/search/block_index_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/output_set.h"

#include <filesystem>
#include <fstream>
#include <type_traits>

namespace vdbsynth {
namespace {

// "UVDBIDX2" as bytes. The last one is the format: it changes with the meaning of the arrays.
constexpr std::uint64_t kFormat = 0x3258444942445655ull;

struct Header {
    std::uint64_t format = kFormat, nodes = 0, members = 0, groups = 0, check = 0;
};

char formatDigit(std::uint64_t format) {
    return char(format >> 56);
}

// Calls each(vector) for everything that is stored, in the file's order.
template <typename Data, typename Each>
void forArrays(Data& data, Each&& each) {
    each(data.nodes);
    each(data.places);
    each(data.memberBegin);
    each(data.members);
    each(data.groups);
}

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return values.size() * sizeof(T);
}

std::uint64_t checkOf(const BlockIndexData& data) {
    std::uint64_t check = kFormat;
    forArrays(data, [&](const auto& values) { check = hash64(values.data(), bytesOf(values), check); });
    return check;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    throw Error(ErrorCode::BadData, path + ": " + why);
}

std::string otherFormat(std::uint64_t format) {
    const char digit = formatDigit(format);
    const bool index = (format ^ kFormat) << 8 == 0 && digit >= '0' && digit <= '9';
    if (!index) return "is no search index";
    return std::string("is a search index of format ") + digit +
           ", of another version of vdb_synth; this one reads format " + formatDigit(kFormat);
}

void read(std::ifstream& file, const std::string& path, void* to, std::size_t bytes) {
    file.read(static_cast<char*>(to), std::streamsize(bytes));
    if (std::size_t(file.gcount()) != bytes) refuse(path, "is truncated");
}

// The invariants of a search, so that no file can lead it out of its arrays.
bool consistent(const BlockIndexData& data) {
    const std::uint64_t positions = std::uint64_t(data.positions.volume());
    std::uint32_t expected = 0;
    for (const BlockGroup& group : data.groups) {
        if (group.first != expected || group.last <= group.first || group.last > data.nodes.size())
            return false;
        expected = group.last;
    }
    if (expected != data.nodes.size() || data.memberBegin.front() != 0 ||
        data.memberBegin.back() != data.members.size())
        return false;
    for (std::size_t i = 0; i < data.nodes.size(); ++i)
        if (data.nodes[i] >= positions || data.memberBegin[i] > data.memberBegin[i + 1] ||
            data.places[i] != placeInCube(data.positionOf(data.nodes[i])))
            return false;
    for (const PositionRun& run : data.members)
        if (run.length == 0 || run.first >= positions || run.length > positions - run.first) return false;
    return true;
}

}  // namespace

std::string blockIndexFileName(const BrickField& exemplar, const BrickField* mask, int block,
                               const RunContext& ctx) {
    const Index3 size = exemplar.box().size();
    const std::size_t planes = std::size_t(size.x), plane = std::size_t(size.y) * std::size_t(size.z);
    std::vector<std::uint64_t> hashes(2 * planes + 5, 0);
    parallelFor(ctx, planes, 4, [&](std::size_t begin, std::size_t end) {
        std::vector<float> samples(plane);
        for (std::size_t x = begin; x < end; ++x) {
            exemplar.readBox({int(x), 0, 0}, {1, size.y, size.z}, samples.data());
            hashes[x] = hash64(samples.data(), plane * sizeof(float));
            if (!mask) continue;
            mask->readBox({int(x), 0, 0}, {1, size.y, size.z}, samples.data());
            hashes[planes + x] = hash64(samples.data(), plane * sizeof(float), 1);
        }
    });
    const std::uint64_t rest[5] = {kFormat, std::uint64_t(block), std::uint64_t(size.x),
                                   std::uint64_t(size.y), std::uint64_t(size.z)};
    std::copy(rest, rest + 5, hashes.end() - 5);
    return contentHash(hashes.data(), hashes.size() * sizeof hashes[0]) + ".blockindex";
}

bool readBlockIndex(const std::string& path, BlockIndexData& data) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return false;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(ErrorCode::Io, path + ": cannot be read");
    Header header;
    read(file, path, &header, sizeof header);
    if (header.format != kFormat) refuse(path, otherFormat(header.format));
    const std::uint64_t size = std::filesystem::file_size(path, ignored), most = size / 2;
    if (ignored) throw Error(ErrorCode::Io, path + ": cannot be read");
    if (header.nodes == 0 || header.nodes > most || header.members > most || header.groups > most)
        refuse(path, "is truncated");
    BlockIndexData in;
    in.positions = data.positions;
    std::uint64_t needed = sizeof header;
    needed += header.nodes * (sizeof in.nodes[0] + sizeof in.places[0] + sizeof in.memberBegin[0]);
    needed +=
        sizeof in.memberBegin[0] + header.members * sizeof(PositionRun) + header.groups * sizeof(BlockGroup);
    if (size != needed)
        refuse(path, "has " + std::to_string(size) + " bytes, not the " + std::to_string(needed) +
                         " of its header");
    in.nodes.resize(std::size_t(header.nodes));
    in.places.resize(std::size_t(header.nodes));
    in.memberBegin.resize(std::size_t(header.nodes) + 1);
    in.members.resize(std::size_t(header.members));
    in.groups.resize(std::size_t(header.groups));
    forArrays(in, [&](auto& values) { read(file, path, values.data(), bytesOf(values)); });
    if (checkOf(in) != header.check || !consistent(in)) refuse(path, "is damaged");
    data.nodes.swap(in.nodes);
    data.places.swap(in.places);
    data.memberBegin.swap(in.memberBegin);
    data.members.swap(in.members);
    data.groups.swap(in.groups);
    return true;
}

void writeBlockIndex(const std::string& path, const BlockIndexData& data) {
    OutputSet outputs;
    std::ofstream file(outputs.add(path), std::ios::binary | std::ios::trunc);
    Header header;
    header.nodes = data.nodes.size();
    header.members = data.members.size();
    header.groups = data.groups.size();
    header.check = checkOf(data);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    forArrays(data, [&](const auto& values) {
        file.write(reinterpret_cast<const char*>(values.data()), std::streamsize(bytesOf(values)));
    });
    file.close();
    if (!file) throw Error(ErrorCode::Io, path + ": writing failed; is the disk full?");
    outputs.commit();
}

}  // namespace vdbsynth
