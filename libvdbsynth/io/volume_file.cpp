#include "libvdbsynth/io/volume_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/gzip.h"
#include "libvdbsynth/io/writers/volume_writers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>

namespace vdbsynth {
namespace {

constexpr std::size_t kSlabBytes = std::size_t(64) << 20;

[[noreturn]] void failFull(const std::string& shown) {
    throw Error(ErrorCode::Io, shown + ": writing failed; the disk may be full");
}

// A file, packed or not, that is written from begin to end.
class Sink {
public:
    Sink(const std::string& path, const std::string& shown, bool packed)
        : mFile(path, std::ios::binary), mShown(shown), mPacked(packed) {
        if (!mFile) throw Error(ErrorCode::Io, shown + ": cannot be written");
        // No name and no time, so that equal volumes give equal files.
        if (mPacked) put(std::string("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10));
    }
    void write(std::string_view bytes) {
        if (!mPacked) return put(bytes);
        for (std::size_t at = 0; at < bytes.size(); at += kSlabBytes) {
            const std::string_view piece = bytes.substr(at, kSlabBytes);
            put(deflatePiece(piece, false));
            mSum = joinedCrc32(mSum, crc32Of(piece), piece.size());
            mSize += piece.size();
        }
    }
    void close() {
        if (mPacked) {
            std::string end = deflatePiece({}, true);
            appendLittle(end, mSum, 4);
            appendLittle(end, mSize & 0xffffffff, 4);
            put(end);
        }
        mFile.close();
        if (!mFile) failFull(mShown);
    }

private:
    void put(std::string_view bytes) {
        mFile.write(bytes.data(), std::streamsize(bytes.size()));
        if (!mFile) failFull(mShown);
    }

    std::ofstream mFile;
    std::string mShown;
    bool mPacked;
    std::uint32_t mSum = crc32Of({});
    std::uint64_t mSize = 0;
};

bool isLittleEndian() {
    const std::uint16_t one = 1;
    return *reinterpret_cast<const unsigned char*>(&one) == 1;
}

VolumeFrame frameOf(VolumeFormat format, const VolumeHead& head) {
    switch (format) {
        case VolumeFormat::Npy:
            return npyFrame(head);
        case VolumeFormat::Tiff:
            return tiffFrame(head);
        case VolumeFormat::Vti:
            return vtiFrame(head);
        default:
            return niftiFrame(head);
    }
}

bool isNifti(VolumeFormat format) {
    return format == VolumeFormat::Nifti || format == VolumeFormat::NiftiGz;
}

std::string sizeText(const Index3& size) {
    return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
}

// What all readers of this program take.
void requireWritable(const std::string& shown, VolumeFormat format, const VolumeHead& head) {
    const int most = isNifti(format) ? 32767 : 1 << 24;
    for (int axis = 0; axis < 3; ++axis)
        if (head.size[axis] < 1 || head.size[axis] > most)
            throw Error(ErrorCode::InvalidOption,
                        shown + ": a volume of " + sizeText(head.size) + " samples; sides are from 1 to " +
                            std::to_string(most) + (isNifti(format) ? " in .nii; write .vti or .npy" : ""));
    constexpr double kMost = 256e9;
    const double bytes =
        double(head.size.x) * double(head.size.y) * double(head.size.z) * (head.bytes ? 1.0 : 4.0);
    if (bytes > kMost)
        throw Error(ErrorCode::Unusable, shown + ": a volume of " + sizeText(head.size) + " samples takes " +
                                             roundedText(bytes / 1e9, 3) +
                                             " GB, over 256 GB; crop the model, use larger voxels, or write "
                                             ".vdb, which stores only the band");
}

}  // namespace

const char* const kVolumeOutputs = ".npy, .tif, .vti, .nii, .nii.gz";

bool volumeFormatOf(const std::string& path, VolumeFormat& format) {
    const std::string extension = extensionOf(path);
    if (extension == "gz" && readExtensionOf(path) == "nii")
        format = VolumeFormat::NiftiGz;
    else if (extension == "nii")
        format = VolumeFormat::Nifti;
    else if (extension == "npy")
        format = VolumeFormat::Npy;
    else if (extension == "tif" || extension == "tiff")
        format = VolumeFormat::Tiff;
    else if (extension == "vti")
        format = VolumeFormat::Vti;
    else
        return false;
    return true;
}

double cellOf(const VolumeHead& head) {
    return length(Vec3d{head.toWorld[0], head.toWorld[1], head.toWorld[2]});
}

std::string lostInVolume(VolumeFormat format, const VolumeHead& head) {
    std::string lost;
    const auto lose = [&](const std::string& what) { lost += (lost.empty() ? "" : ", ") + what; };
    const bool turned = !runsAlongWorld(head);
    const bool moved = head.toWorld[12] != 0 || head.toWorld[13] != 0 || head.toWorld[14] != 0;
    const bool places = format == VolumeFormat::Vti || isNifti(format);
    if (turned && !places) lose("the rotation of its axes");
    if (moved && !places && (turned || format == VolumeFormat::Npy)) lose("its origin");
    if (format == VolumeFormat::Npy && cellOf(head) != 1) lose("the side of its voxels");
    const bool unit = format == VolumeFormat::Tiff || (isNifti(format) && niftiUnit(head.unit) != 0);
    if (!head.unit.empty() && !unit) lose("its unit (" + head.unit + ")");
    if (!lost.empty()) lost = "no place for " + lost;
    constexpr double kMostMoved = 0.01;
    if (isNifti(format) && niftiError(head) > kMostMoved)
        lost += (lost.empty() ? "" : ", and ") + ("only floats for its place, which move it by up to " +
                                                  roundedText(niftiError(head), 2) + " voxels");
    return lost;
}

void writeVolume(const std::string& path, const std::string& shown, VolumeFormat format,
                 const VolumeHead& head, const SliceSource& slices, const RunContext& ctx) {
    requireWritable(shown, format, head);
    const std::size_t slice = std::size_t(sampleBytes(head) / std::uint64_t(head.size.z));
    // The source works on floats beside what it returns.
    const double perSample = head.bytes ? 5 : 8;
    requireMemory(ctx, double(head.size.x) * double(head.size.y) * perSample, shown + ": one slice",
                  "crop the model or use larger voxels");
    double room = double(kSlabBytes);
    if (ctx.maxMemory > 0) room = std::min(room, double(ctx.maxMemory) / 8);
    const int slab = std::clamp(int(room / double(slice)), 1, head.size.z);
    const VolumeFrame frame = frameOf(format, head);
    Sink sink(path, shown, format == VolumeFormat::NiftiGz);
    sink.write(frame.head);
    std::string bytes;
    for (int first = 0; first < head.size.z; first += slab) {
        throwIfCancelled(ctx);
        const int count = std::min(slab, head.size.z - first);
        bytes.resize(slice * std::size_t(count));
        slices(first, count, bytes.data());
        if (!head.bytes && !isLittleEndian())
            for (std::size_t at = 0; at < bytes.size(); at += 4)
                std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + 4));
        sink.write(bytes);
    }
    sink.write(frame.tail);
    sink.close();
}

}  // namespace vdbsynth
