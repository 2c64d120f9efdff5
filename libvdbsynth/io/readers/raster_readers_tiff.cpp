#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/orientation.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/tiff/tiff_contents.h"
#include "libvdbsynth/io/readers/tiff/tiff_geography.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using Kind = StackDescription::Kind;

// The place of the choice to read. Where channels or frames have others of their kind, "channel2" is that of
// the first frame.
std::size_t chosen(const std::string& path, TiffContents& contents, const RasterReadOptions& options,
                   const RunContext& ctx) {
    std::vector<std::string> names;
    for (const TiffChoice& choice : contents.choices)
        if (!choice.name.empty()) names.push_back(choice.name);
    if (names.empty()) return 0;
    RasterReadOptions wanted = options;
    if (!wanted.array.empty() && std::find(names.begin(), names.end(), wanted.array) == names.end())
        for (const std::string& whole : {wanted.array + "-frame1", "channel1-" + wanted.array})
            if (std::find(names.begin(), names.end(), whole) != names.end()) wanted.array = whole;
    // Other pages have been told of.
    if (wanted.array.empty() && contents.described < 2) return 0;
    return chosenArray(path, names, 0, wanted, ctx);
}

// ImageJ takes a resolution of 72 per inch for none.
void imageJSpacing(const StackDescription& description, const TiffPage& page, Raster& raster) {
    constexpr double kScreen = 72;
    constexpr std::uint16_t kInch = 2, kCentimetre = 3;
    const bool screen =
        description.unit.empty() && page.resolutionUnit == kInch && page.resolution[0] == kScreen;
    for (int axis = 0; axis < 2 && !screen; ++axis) {
        const double size = 1 / page.resolution[axis];
        if (size > 1e-30 && size < 1e30) raster.spacing[axis] = size;
    }
    if (description.spacing[2] > 0) raster.spacing.z = description.spacing[2];
    // libtiff gives resolutions as floats; where they say the same as the distance of slices, it is exact.
    for (int axis = 0; axis < 2; ++axis)
        if (std::abs(raster.spacing[axis] - raster.spacing.z) < 1e-6 * raster.spacing.z)
            raster.spacing[axis] = raster.spacing.z;
    for (int axis = 0; axis < 3; ++axis)
        if (description.origin[axis] != 0)
            raster.origin[axis] = -description.origin[axis] * raster.spacing[axis];
    raster.unit = description.unit;
    if (raster.unit.empty() && !screen)
        raster.unit = page.resolutionUnit == kInch ? "in" : page.resolutionUnit == kCentimetre ? "cm" : "";
}

void omeSpacing(const StackDescription& description, Raster& raster) {
    const double first = description.spacing[0] > 0 ? description.spacing[0] : 1;
    for (int axis = 0; axis < 3; ++axis)
        raster.spacing[axis] = description.spacing[axis] > 0 ? description.spacing[axis] : first;
    raster.unit = description.unit;
}

// The size of cells by the description, with a note: it is not a cube of 1.
void readSpacing(const std::string& path, const StackDescription& description, const TiffPage& page,
                 Raster& raster, const RunContext& ctx) {
    if (description.kind == Kind::ImageJ)
        imageJSpacing(description, page, raster);
    else if (description.kind == Kind::Ome)
        omeSpacing(description, raster);
    else
        return;
    const Vec3d& s = raster.spacing;
    const bool moved = length(Vec3d{description.origin[0], description.origin[1], description.origin[2]}) > 0;
    if (s.x == 1 && s.y == 1 && s.z == 1 && raster.unit.empty() && !moved) return;
    raster.knownSpacing = true;
    const bool guessed = raster.size.z > 1 && description.spacing[2] <= 0;
    const bool ome = description.kind == Kind::Ome;
    message(ctx, MessageLevel::Note,
            path + ": cells of " + roundedText(s.x, 6) + " x " + roundedText(s.y, 6) +
                (raster.size.z > 1 ? " x " + roundedText(s.z, 6) : "") +
                (raster.unit.empty() ? "" : " " + raster.unit) + " by its " + nameOf(description.kind) +
                (!guessed ? ""
                 : ome    ? ", which has no distance of slices: that of columns is taken"
                          : ", which has no distance of slices: 1 is taken, as ImageJ does") +
                "; `pixelSize` sets them" + (moved ? "; its description places it" : ""));
}

// The opacity of a single image in a page of its own, as GDAL writes it.
void applyMask(const std::string& path, TiffFile& file, const TiffContents& contents, const TiffPage& page,
               Raster& raster, const RunContext& ctx) {
    if (contents.masks.empty()) return;
    const std::size_t number = contents.masks.front();
    const TiffPage& mask = file.pages()[number];
    const bool fits = raster.size.z == 1 && contents.masks.size() == 1 && mask.width == page.width &&
                      mask.height == page.height && mask.samples == 1 && isStored(mask, true);
    if (!fits) {
        message(ctx, MessageLevel::Note, path + ": its mask pages are not applied");
        return;
    }
    std::vector<float> opaque(raster.sampleCount());
    file.select(number);
    readTiffPage(path, file, mask, {0, 1}, true, ctx, opaque.data());
    const std::size_t channels = std::size_t(raster.channels);
    for (std::size_t i = 0; i < opaque.size(); ++i)
        if (opaque[i] == 0)
            std::fill_n(raster.values.begin() + std::ptrdiff_t(i * channels), channels, std::nanf(""));
}

// Stored values as those that are meant.
void readMeaning(const std::string& path, const StackDescription& description, const TiffPage& page,
                 Raster& raster, const RunContext& ctx) {
    if (page.colour == TiffColour::WhiteIsZero && description.kind == Kind::ImageJ) {
        message(ctx, MessageLevel::Note,
                path +
                    ": its stored values are read; ImageJ's inverting table (white is zero) changes only how "
                    "they look");
    } else if (page.colour == TiffColour::WhiteIsZero && isStored(page, true)) {
        if (raster.white > 0)
            for (float& value : raster.values) value = float(raster.white) - value;
        else
            message(ctx, MessageLevel::Note,
                    path + ": says that white is zero, which is not applied to its kind of numbers");
    }
    if (!description.calibrated) return;
    for (float& value : raster.values)
        value = float(description.calibrationOffset + description.calibrationFactor * double(value));
    raster.white = 0;
    message(ctx, MessageLevel::Note,
            path + ": values are " + roundedText(description.calibrationOffset, 9) + " + " +
                roundedText(description.calibrationFactor, 9) +
                " times the stored ones by its ImageJ description");
}

// @throw Error BadData (the file is too small for what its tags claim)
void checkSize(const std::string& path, const TiffPage& page, const TiffContents& contents,
               const TiffChoice& choice, std::size_t fileSize) {
    const double bytes = double(page.width) * page.height * page.bits / 8 * (page.planes ? 1 : page.samples) *
                         double(choice.pages.size());
    // The strongest TIFF compression gives a thousandth.
    const double most = contents.raw ? double(fileSize) : 4000.0 * double(fileSize) + 1e6;
    if (bytes > most) throw Error(ErrorCode::BadData, path + ": truncated");
}

void readSlices(const std::string& path, const std::string& content, TiffFile& file,
                const TiffContents& contents, const TiffChoice& choice, const TiffPage& page,
                const RunContext& ctx, Raster& raster) {
    const std::size_t channels = std::size_t(raster.channels);
    const std::size_t slice = std::size_t(page.width) * page.height * channels;
    const std::size_t bytes = std::size_t(page.width) * page.height * page.samples * (page.bits / 8u);
    for (std::size_t i = 0; i < choice.pages.size(); ++i) {
        throwIfCancelled(ctx);
        float* out = raster.values.data() + slice * i;
        if (contents.raw) {
            readRawPage(path, file, page, choice.samples, content, page.dataOffset + choice.pages[i] * bytes,
                        out);
        } else {
            file.select(choice.pages[i]);
            readTiffPage(path, file, page, choice.samples, raster.stack, ctx, out);
        }
    }
}

}  // namespace

Raster readTiff(const std::string& path, const std::string& content, const RasterReadOptions& options,
                const RunContext& ctx) {
    TiffFile file(path, content);
    TiffContents contents = contentsOf(path, file, options, ctx);
    const std::size_t number = chosen(path, contents, options, ctx);
    const TiffChoice& choice = contents.choices[number];
    if (number >= contents.described) contents.description = StackDescription();
    const std::size_t head = contents.raw ? 0 : choice.pages.front();
    const TiffPage& page = file.pages()[head];
    checkSize(path, page, contents, choice, content.size());
    Raster raster = makeRaster(path, page.width, page.height, std::int64_t(choice.pages.size()),
                               choice.samples.channels, ctx);
    raster.stack = choice.pages.size() > 1;
    raster.rowsFromTop = !raster.stack;
    raster.white = whiteOf(page, raster.stack);
    for (const TiffChoice& each : contents.choices)
        if (!each.name.empty()) raster.arrays.push_back(each.name);
    readSlices(path, content, file, contents, choice, page, ctx, raster);
    file.select(head);
    dropNoData(file, raster);
    readGeography(path, file, raster, ctx);
    readSpacing(path, contents.description, page, raster, ctx);
    readMeaning(path, contents.description, page, raster, ctx);
    applyMask(path, file, contents, page, raster, ctx);
    turnUpright(path, raster, page.orientation, "orientation tag", ctx);
    return raster;
}

}  // namespace vdbsynth
