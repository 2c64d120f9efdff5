// VTK ImageData in XML.
#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/raster_readers_vti_steps.h"
#include "libvdbsynth/raster/raster_alignment.h"

#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": " + what);
}

// Numbers of an attribute; none if one of them is not finite.
std::vector<double> numbersOf(std::string_view text) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while ((at = text.find_first_not_of(" \t\n\r", at)) != std::string_view::npos) {
        const std::size_t end = std::min(text.find_first_of(" \t\n\r", at), text.size());
        double value = 0;
        if (!parseReal(text.substr(at, end - at), value)) return {};
        numbers.push_back(value);
        at = end;
    }
    return numbers;
}

// First and last point along each axis.
struct Extent {
    std::array<std::int64_t, 3> first{}, last{};

    std::int64_t side(std::size_t axis, bool cells) const {
        const std::int64_t points = last[axis] - first[axis] + 1;
        // A flat image has one layer of cells.
        return cells && points > 1 ? points - 1 : points;
    }
    std::int64_t count(bool cells) const {
        return checkedProduct({side(0, cells), side(1, cells), side(2, cells)}).value_or(-1);
    }
};

Extent extentOf(const std::string& path, const char* text) {
    const std::vector<double> numbers = numbersOf(text);
    if (numbers.size() != 6) refuse(path, "its Extent is not six numbers");
    Extent extent;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.first[axis] = std::int64_t(std::clamp(numbers[2 * axis], -1e15, 1e15));
        extent.last[axis] = std::int64_t(std::clamp(numbers[2 * axis + 1], -1e15, 1e15));
        if (extent.last[axis] < extent.first[axis]) refuse(path, "its Extent is empty");
    }
    return extent;
}

std::vector<VtkArray> arraysOf(const std::string& path, const pugi::xml_node& piece) {
    constexpr std::size_t kMostArrays = 1000;
    std::vector<VtkArray> arrays;
    for (const char* kind : {"PointData", "CellData"})
        for (const pugi::xml_node& node : piece.child(kind).children("DataArray")) {
            VtkArray array;
            array.name = printableText(node.attribute("Name").as_string(), 200);
            if (array.name.empty()) array.name = "array" + std::to_string(arrays.size() + 1);
            array.type = node.attribute("type").as_string();
            array.format = node.attribute("format").as_string("ascii");
            array.text = array.format == "appended" ? "" : node.text().as_string();
            array.components = node.attribute("NumberOfComponents").as_int(1);
            array.offset = std::size_t(node.attribute("offset").as_ullong(0));
            array.cells = std::string(kind) == "CellData";
            const bool taken = std::any_of(arrays.begin(), arrays.end(),
                                           [&](const VtkArray& other) { return other.name == array.name; });
            if (taken && array.cells) array.name = "cells:" + array.name;
            if (array.components < 1 || array.components > 1000)
                refuse(path, "its array " + array.name + " has " + std::to_string(array.components) +
                                 " components; 1 to 1000 are read");
            arrays.push_back(array);
            if (arrays.size() > kMostArrays)
                refuse(path, "has over " + std::to_string(kMostArrays) + " arrays");
        }
    return arrays;
}

// The scalars that the file marks, else its first; of the points, else of the cells.
std::size_t standardArray(const pugi::xml_node& piece, const std::vector<VtkArray>& arrays) {
    for (const bool cells : {false, true}) {
        const std::string marked =
            piece.child(cells ? "CellData" : "PointData").attribute("Scalars").as_string();
        std::size_t first = arrays.size();
        for (std::size_t i = 0; i < arrays.size(); ++i) {
            const VtkArray& array = arrays[i];
            if (array.cells != cells || array.components != 1 || array.type == "Bit") continue;
            if (!marked.empty() && array.name == printableText(marked, 200)) return i;
            const bool ghosts = array.name == "vtkGhostType" || array.name == "vtkGhostLevels";
            if (first == arrays.size() && !ghosts) first = i;
        }
        if (first < arrays.size()) return first;
    }
    return arrays.size();
}

std::size_t choose(const std::string& path, const pugi::xml_node& piece, const std::vector<VtkArray>& arrays,
                   std::vector<std::string>& names, const RasterReadOptions& options, const RunContext& ctx) {
    for (const VtkArray& array : arrays) names.push_back(array.name);
    if (arrays.empty()) refuse(path, "has no data array");
    const std::size_t standard = standardArray(piece, arrays);
    if (standard == arrays.size() && options.array.empty())
        refuse(path, "holds no scalars but vectors (" + names.front() +
                         (names.size() > 1 ? " and more" : "") + "); `grid` " + names.front() +
                         " reads their lengths");
    const std::size_t chosen = chosenArray(path, names, standard, options, ctx);
    const VtkArray& array = arrays[chosen];
    if (array.components > 1)
        message(ctx, MessageLevel::Note,
                path + ": " + array.name + " holds vectors of " + std::to_string(array.components) +
                    " components; their lengths are read");
    if (array.cells)
        message(ctx, MessageLevel::Note,
                path + ": " + array.name + " holds values of cells, which lie at the cells' centres");
    return chosen;
}

// The pieces of the image, whose union is `whole`.
struct Piece {
    Extent extent;
    VtkArray array;
};

void copyPiece(const Piece& piece, const std::vector<float>& values, const Extent& whole, bool cells,
               Raster& raster, std::vector<bool>& covered) {
    std::size_t from = 0;
    const auto begin = [&](std::size_t axis) { return int(piece.extent.first[axis] - whole.first[axis]); };
    const auto end = [&](std::size_t axis) { return begin(axis) + int(piece.extent.side(axis, cells)); };
    for (int z = begin(2); z < end(2); ++z)
        for (int y = begin(1); y < end(1); ++y)
            for (int x = begin(0); x < end(0); ++x) {
                raster.values[raster.index(x, y, z)] = values[from++];
                covered[raster.index(x, y, z)] = true;
            }
}

// A flat piece of cells at the far side of thicker ones has no cell of the whole.
void requireInside(const std::string& path, const std::vector<Piece>& pieces, const Extent& whole,
                   bool cells) {
    for (const Piece& piece : pieces)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (piece.extent.first[axis] - whole.first[axis] + piece.extent.side(axis, cells) >
                whole.side(axis, cells))
                refuse(path, "one of its pieces is flat beside others that are not; write it as one piece");
}

void readPieces(const std::string& path, const std::vector<Piece>& pieces, const Extent& whole,
                const VtkEncoding& encoding, Raster& raster, const RunContext& ctx) {
    const bool cells = pieces.front().array.cells;
    requireInside(path, pieces, whole, cells);
    if (pieces.size() == 1) {
        raster.values = readVtkArray(path, pieces.front().array, encoding, raster.values.size(), ctx);
        return;
    }
    std::fill(raster.values.begin(), raster.values.end(), std::nanf(""));
    std::vector<bool> covered(raster.values.size(), false);
    for (const Piece& piece : pieces)
        copyPiece(piece,
                  readVtkArray(path, piece.array, encoding, std::size_t(piece.extent.count(cells)), ctx),
                  whole, cells, raster, covered);
    const auto missing = std::count(covered.begin(), covered.end(), false);
    if (missing > 0)
        message(ctx, MessageLevel::Warning,
                path + ": its pieces leave " + std::to_string(missing) + " samples without data");
}

Extent unionOf(const std::vector<Piece>& pieces) {
    Extent whole = pieces.front().extent;
    for (const Piece& piece : pieces)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            whole.first[axis] = std::min(whole.first[axis], piece.extent.first[axis]);
            whole.last[axis] = std::max(whole.last[axis], piece.extent.last[axis]);
        }
    return whole;
}

// Text or bytes of a sample; zlib reduces these to a thousandth at best.
void requireFits(const std::string& path, const std::vector<Piece>& pieces, const Extent& whole,
                 std::uint64_t content) {
    const VtkArray& array = pieces.front().array;
    if (!productFits({whole.side(0, array.cells), whole.side(1, array.cells), whole.side(2, array.cells),
                      array.components},
                     content))
        refuse(path, "truncated: its Extent claims more samples than the file can hold");
    // Pieces share the points of their faces.
    double sum = 0;
    for (const Piece& piece : pieces) sum += double(piece.extent.count(array.cells));
    if (sum > 8.0 * double(whole.count(array.cells))) refuse(path, "its pieces overlap");
}

void readEncoding(const std::string& path, const pugi::xml_node& root, VtkEncoding& encoding) {
    const std::string compressor = root.attribute("compressor").as_string();
    encoding.compressed = !compressor.empty();
    if (encoding.compressed && compressor != "vtkZLibDataCompressor")
        refuse(path, "is compressed with " + printableText(compressor, 60) +
                         "; only zlib is supported: write it with vtkZLibDataCompressor or without one");
    encoding.swap = std::string(root.attribute("byte_order").as_string()) == "BigEndian";
    encoding.wideHeader = std::string(root.attribute("header_type").as_string()) == "UInt64";
}

// From columns, rows and slices of the samples to the world.
Affine placeOf(const std::string& path, const pugi::xml_node& image, const Extent& whole, bool cells) {
    std::vector<double> spacing = numbersOf(image.attribute("Spacing").as_string("1 1 1")),
                        origin = numbersOf(image.attribute("Origin").as_string("0 0 0")),
                        direction = numbersOf(image.attribute("Direction").as_string("1 0 0 0 1 0 0 0 1"));
    if (spacing.size() != 3 || origin.size() != 3)
        refuse(path, "its Spacing and Origin must be three numbers each");
    if (direction.size() != 9) refuse(path, "its Direction must be nine numbers");
    double thinnest = 0;
    for (const double step : spacing)
        if (step > 0 && !(thinnest > 0 && thinnest < step)) thinnest = step;
    Affine map = kIdentity;
    for (std::size_t i = 0; i < 3; ++i) map[12 + i] = origin[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Flat images are written with a thickness of zero.
        const double step = spacing[axis] == 0 && whole.side(axis, false) == 1 ? thinnest : spacing[axis];
        const double first = double(whole.first[axis]) + (cells && whole.side(axis, false) > 1 ? 0.5 : 0);
        for (std::size_t i = 0; i < 3; ++i) {
            map[4 * axis + i] = direction[3 * i + axis] * step;
            map[12 + i] += map[4 * axis + i] * first;
        }
    }
    return map;
}

std::vector<Piece> piecesOf(const std::string& path, const pugi::xml_node& image, std::size_t chosen,
                            const VtkArray& array) {
    constexpr std::size_t kMostPieces = 4096;
    std::vector<Piece> pieces;
    for (const pugi::xml_node& node : image.children("Piece")) {
        Piece piece;
        piece.extent =
            extentOf(path, node.attribute("Extent").as_string(image.attribute("WholeExtent").as_string()));
        const std::vector<VtkArray> arrays = arraysOf(path, node);
        if (chosen >= arrays.size() || arrays[chosen].name != array.name ||
            arrays[chosen].cells != array.cells || arrays[chosen].components != array.components)
            refuse(path, "its pieces hold different arrays; write it as one piece");
        piece.array = arrays[chosen];
        pieces.push_back(std::move(piece));
        if (pieces.size() > kMostPieces)
            refuse(path, "is in over " + std::to_string(kMostPieces) + " pieces; write it as one");
    }
    return pieces;
}

}  // namespace

Raster readVti(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx) {
    VtkEncoding encoding;
    const std::string xml = cutAppended(content, encoding);
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
    if (!parsed) refuse(path, std::string("not a whole XML file: ") + parsed.description());
    const pugi::xml_node root = document.child("VTKFile"), image = root.child("ImageData"),
                         first = image.child("Piece");
    const std::string kind = root.attribute("type").as_string();
    if (!kind.empty() && kind != "ImageData")
        refuse(path, "is a VTK file of kind " + printableText(kind, 60) + "; only ImageData is read");
    if (!first) refuse(path, "not a VTK image (VTKFile, ImageData, Piece)");
    readEncoding(path, root, encoding);
    std::vector<std::string> names;
    const std::vector<VtkArray> arrays = arraysOf(path, first);
    const std::size_t chosen = choose(path, first, arrays, names, options, ctx);
    const VtkArray& array = arrays[chosen];
    const std::vector<Piece> pieces = piecesOf(path, image, chosen, array);
    const Extent whole = unionOf(pieces);
    requireFits(path, pieces, whole, (encoding.compressed ? 1100 : 1) * content.size());
    Raster raster = makeRaster(path, whole.side(0, array.cells), whole.side(1, array.cells),
                               whole.side(2, array.cells), 1, ctx);
    raster.white = whiteOfVtkType(path, array);
    readPieces(path, pieces, whole, encoding, raster, ctx);
    raster = alignedToWorld(path, std::move(raster), placeOf(path, image, whole, array.cells), ctx);
    raster.stack = true;
    raster.arrays = names;
    sayTurn(path, raster, ctx);
    return raster;
}

}  // namespace vdbsynth
