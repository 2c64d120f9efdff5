#pragma once
#include "tests/support/raster_files.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

// TIFF files of any tags, byte by byte, for tests.
namespace vdbsynth::test {

/// A tag with its values in the file's byte order.
struct TiffField {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string bytes;
};

struct TiffMaker {
    bool bigEndian = false;
    bool tagsFirst = false;  ///< the tags before the pixels, as ImageJ writes them
    std::string bytes{};

    struct Page {
        int width = 1, height = 1, bits = 8;
        std::string pixels;  ///< in the file's byte order, one strip
        std::vector<TiffField> fields{};
        int samples = 1, format = 1, photometric = 1;
    };

    std::string number(std::uint64_t value, std::size_t size) const {
        std::string text;
        for (std::size_t i = 0; i < size; ++i)
            text += char(value >> (8 * (bigEndian ? size - 1 - i : i)) & 255);
        return text;
    }
    TiffField shorts(std::uint16_t tag, const std::vector<int>& values) const {
        TiffField field{tag, 3, std::uint32_t(values.size()), ""};
        for (int value : values) field.bytes += number(std::uint64_t(value), 2);
        return field;
    }
    TiffField longs(std::uint16_t tag, const std::vector<std::uint32_t>& values) const {
        TiffField field{tag, 4, std::uint32_t(values.size()), ""};
        for (std::uint32_t value : values) field.bytes += number(value, 4);
        return field;
    }
    TiffField doubles(std::uint16_t tag, const std::vector<double>& values) const {
        TiffField field{tag, 12, std::uint32_t(values.size()), ""};
        for (double value : values) {
            std::uint64_t bits = 0;
            std::memcpy(&bits, &value, 8);
            field.bytes += number(bits, 8);
        }
        return field;
    }
    TiffField rational(std::uint16_t tag, std::uint32_t above, std::uint32_t below) const {
        return {tag, 5, 1, number(above, 4) + number(below, 4)};
    }
    static TiffField text(std::uint16_t tag, const std::string& words) {
        return {tag, 2, std::uint32_t(words.size() + 1), words + std::string(1, '\0')};
    }

    /// The whole file.
    std::string file(const std::vector<Page>& pages) {
        bytes = bigEndian ? "MM" : "II";
        bytes += number(42, 2) + number(0, 4);
        std::size_t link = 4;
        for (const Page& page : pages) link = append(page, link);
        return bytes;
    }

private:
    std::size_t append(const Page& page, std::size_t link) {
        std::vector<TiffField> fields = page.fields;
        const auto add = [&](const TiffField& field) {
            const auto same = [&](const TiffField& f) { return f.tag == field.tag; };
            if (std::none_of(fields.begin(), fields.end(), same)) fields.push_back(field);
        };
        add(longs(256, {std::uint32_t(page.width)}));
        add(longs(257, {std::uint32_t(page.height)}));
        add(shorts(258, std::vector<int>(std::size_t(page.samples), page.bits)));
        add(shorts(259, {1}));
        add(shorts(262, {page.photometric}));
        add(longs(273, {0}));
        add(shorts(277, {page.samples}));
        add(longs(278, {std::uint32_t(page.height)}));
        add(longs(279, {std::uint32_t(page.pixels.size())}));
        add(shorts(339, std::vector<int>(std::size_t(page.samples), page.format)));
        std::sort(fields.begin(), fields.end(), [](const auto& a, const auto& b) { return a.tag < b.tag; });
        if (bytes.size() % 2) bytes += '\0';
        std::size_t beside = fields.size() * 12 + 6;  // the directory
        for (const TiffField& field : fields) beside += field.bytes.size() > 4 ? field.bytes.size() : 0;
        const std::size_t data = bytes.size() + (tagsFirst ? beside : 0);
        if (!tagsFirst) bytes += page.pixels;
        std::string directory = number(fields.size(), 2), values;
        const std::size_t start = bytes.size(), after = start + fields.size() * 12 + 6;
        bytes.replace(link, 4, number(start, 4));
        for (const TiffField& field : fields) {
            directory += number(field.tag, 2) + number(field.type, 2) + number(field.count, 4);
            std::string value = field.tag == 273 && field.count == 1 ? number(data, 4) : field.bytes;
            if (value.size() > 4) {
                const std::size_t at = after + values.size();
                values += value;
                value = number(at, 4);
            }
            value.resize(4, '\0');
            directory += value;
        }
        bytes += directory + number(0, 4) + values;
        if (tagsFirst) bytes += page.pixels;
        return start + directory.size();
    }
};

}  // namespace vdbsynth::test
