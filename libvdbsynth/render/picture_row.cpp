#include "libvdbsynth/render/picture_row.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/render/drawn_text.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr PictureColour kDark{38, 42, 48}, kLight{232, 234, 238}, kBetween{128, 132, 138};

// Readable on what is there: of a clear picture that may be anything.
PictureColour inkOn(const Picture& picture, int top) {
    if (picture.channels == 4) return kBetween;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = std::size_t(top) * std::size_t(picture.width) * 3; i < picture.pixels.size();
         ++i, ++count)
        sum += picture.pixels[i];
    return sum > 110.0 * double(count) ? kDark : kLight;
}

std::string fitting(const std::string& label, int size, int width) {
    if (textWidth(label, size) <= width) return label;
    for (std::size_t keep = label.size() / 2; keep > 1; --keep) {
        const std::string shorter = label.substr(0, keep) + "..." + label.substr(label.size() - keep);
        if (textWidth(shorter, size) <= width) return shorter;
    }
    return "";
}

}  // namespace

void labelPicture(Picture& picture, const std::string& label, bool boxed) {
    const int size = std::max(7, int(picture.height * kLabelShare * 0.30));
    const std::string text = fitting(label, size, picture.width - size);
    const int base = picture.height - int(picture.height * kLabelShare * 0.36);
    const int width = textWidth(text, size), left = (picture.width - width) / 2;
    if (boxed && width > 0)
        blendRectangle(picture, left - size / 2, base - size * 3 / 2, left + width + size / 2,
                       base + size * 2 / 3, {255, 255, 255}, 0.82);
    drawText(picture, text, left, base, size, boxed ? kDark : inkOn(picture, std::max(0, base - size)));
}

Picture pictureRow(const std::vector<Picture>& pictures) {
    if (pictures.empty()) throw Error(ErrorCode::InvalidOption, "a row of pictures needs one at least");
    Picture row{0, pictures.front().height, {}, pictures.front().channels};
    for (const Picture& picture : pictures) {
        if (picture.height != row.height || picture.channels != row.channels)
            throw Error(ErrorCode::InvalidOption, "pictures of one row need one height and kind");
        row.width += picture.width;
    }
    if (row.width > 65535)
        throw Error(ErrorCode::InvalidOption, "`size`: the row would be " + std::to_string(row.width) +
                                                  " pixels wide; at most 65535 are possible, draw fewer "
                                                  "models or smaller ones");
    const std::size_t channels = std::size_t(row.channels);
    row.pixels.reserve(std::size_t(row.width) * std::size_t(row.height) * channels);
    for (std::size_t y = 0; y < std::size_t(row.height); ++y)
        for (const Picture& picture : pictures) {
            const std::size_t bytes = std::size_t(picture.width) * channels;
            const auto begin = picture.pixels.begin() + std::ptrdiff_t(y * bytes);
            row.pixels.insert(row.pixels.end(), begin, begin + std::ptrdiff_t(bytes));
        }
    return row;
}

Picture pictureRows(const std::vector<Picture>& pictures, std::size_t columns) {
    requireOption(columns >= 1, "columns", std::to_string(columns), "at least 1");
    if (pictures.size() <= columns) return pictureRow(pictures);
    Picture blank = pictures.front();
    const std::size_t channels = std::size_t(blank.channels), width = std::size_t(blank.width);
    for (std::size_t i = 0; i < blank.pixels.size(); ++i)
        blank.pixels[i] = pictures.front().pixels[i / (width * channels) * width * channels + i % channels];
    Picture all;
    for (std::size_t first = 0; first < pictures.size(); first += columns) {
        const auto begin = pictures.begin() + std::ptrdiff_t(first);
        std::vector<Picture> some(begin, begin + std::ptrdiff_t(std::min(columns, pictures.size() - first)));
        some.resize(columns, blank);
        const Picture row = pictureRow(some);
        if (all.height == 0) all = Picture{row.width, 0, {}, row.channels};
        if (row.width != all.width || all.height + row.height > 65535)
            throw Error(ErrorCode::InvalidOption,
                        "`size`: the rows are of different widths, or over 65535 pixels high together");
        all.height += row.height;
        all.pixels.insert(all.pixels.end(), row.pixels.begin(), row.pixels.end());
    }
    return all;
}

}  // namespace vdbsynth
