// OFF and its variants with extra numbers per vertex (NOFF, COFF, STOFF, CNOFF): ascii only.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"

namespace vdbsynth {
namespace {

// One component of a colour; `white` becomes 1 if it is not an integer.
void readColour(TextScanner& scanner, AttributeColumn& column) {
    const std::string_view word = scanner.wordOnLine();
    float value = 0;
    if (!parseAnyReal(word, value)) return;
    if (word.find('.') != std::string_view::npos) column.white = 1;
    column.values.push_back(value);
}

}  // namespace

MeshContent readOff(const std::string& path, const std::string& content, const RunContext&) {
    TextScanner scanner(path, content);
    std::string_view header = scanner.word();
    const std::size_t suffix = header.size() >= 3 ? header.size() - 3 : 0;
    if (header.size() < 3 || header.substr(suffix) != "OFF" || header.size() > 6)
        scanner.fail("not an OFF file: it must begin with OFF");
    if (header.find('4') != std::string_view::npos)
        scanner.fail("4-dimensional OFF is not supported; convert it to OFF");
    {
        TextScanner ahead = scanner;
        if (ahead.wordOnLine() == "BINARY")
            scanner.fail("binary OFF is not supported; convert it to ascii OFF or ply");
    }
    const std::int64_t vertices = scanner.whole(), faces = scanner.whole();
    scanner.whole();  // edges, often 0 and never needed
    // Every vertex takes at least six characters and every face eight.
    if (vertices < 0 || faces < 0 || vertices > std::int64_t(content.size() / 6 + 1) ||
        faces > std::int64_t(content.size() / 4 + 1))
        throw Error(ErrorCode::BadData, path + ": the header claims " + std::to_string(vertices) +
                                            " vertices and " + std::to_string(faces) +
                                            " faces, more than the file can hold");
    const bool normals = header.find('N') != std::string_view::npos,
               colours = header.find('C') != std::string_view::npos;
    std::vector<AttributeColumn> colour;
    if (colours) colour = {{"red", 0, {}}, {"green", 0, {}}, {"blue", 0, {}}};
    MeshContent mesh;
    mesh.points.reserve(std::size_t(vertices));
    for (std::int64_t i = 0; i < vertices; ++i) {
        Vec3d p;
        p.x = scanner.real();
        p.y = scanner.real();
        p.z = scanner.real();
        mesh.points.push_back(p);
        for (int k = 0; k < (normals ? 3 : 0); ++k) scanner.wordOnLine();
        for (std::size_t k = 0; k < colour.size(); ++k) readColour(scanner, colour[k]);
        scanner.skipLine();  // opacity, texture coordinates
    }
    bool coloured = colours && vertices > 0;
    for (const AttributeColumn& column : colour)
        coloured = coloured && column.values.size() == mesh.points.size();
    if (coloured) {
        // Integers range to 255, even if none is over 1.
        bool real = false;
        for (const AttributeColumn& column : colour) real = real || column.white == 1;
        for (AttributeColumn& column : colour) column.white = real ? 0 : 255;
        mesh.attributes = groupColumns(std::move(colour));
    }
    std::vector<std::uint32_t> corners;
    for (std::int64_t i = 0; i < faces; ++i) {
        const std::int64_t count = scanner.whole();
        if (count < 1 || count > vertices) scanner.fail("a face of " + std::to_string(count) + " corners");
        corners.clear();
        for (std::int64_t c = 0; c < count; ++c) {
            const std::int64_t index = scanner.whole();
            if (index < 0 || index >= vertices)
                scanner.fail("vertex " + std::to_string(index) + " of " + std::to_string(vertices) +
                             " does not exist (counting from 0)");
            corners.push_back(std::uint32_t(index));
        }
        mesh.polygons.add(corners.data(), corners.size());
        scanner.skipLine();  // colours
    }
    return mesh;
}

}  // namespace vdbsynth
