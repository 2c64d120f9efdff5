// The writer of 3MF: one model part, whose text is made and packed in pieces.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/package/zip_file.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/solid/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::size_t kRows = 65536;  // elements of a piece

const char* const kTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";
const char* const kRelations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel-1\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";
const char* const kBegin =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<model unit=\"millimeter\" xml:lang=\"en-US\" "
    "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
    "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n"
    "<metadata name=\"Application\">vdb_synth</metadata>\n<resources>\n";

std::uint32_t byteOf(float value) {
    return std::uint32_t(std::lround(double(std::clamp(value, 0.f, 1.f)) * 255));
}

// Colours of the vertices, each once.
struct Palette {
    std::vector<std::uint32_t> colours;  // red first in the four bytes
    std::vector<std::uint32_t> ofVertex;
};

Palette paletteOf(const Mesh& mesh) {
    Palette palette;
    const Attribute *colour = findAttribute(mesh.attributes, "Cd"),
                    *alpha = findAttribute(mesh.attributes, "Alpha");
    if (!holds3mfColours(mesh)) return palette;
    std::unordered_map<std::uint32_t, std::uint32_t> places;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        std::uint32_t rgba = 0;
        for (std::size_t c = 0; c < 3; ++c) rgba = rgba << 8 | byteOf(colour->values[3 * i + c]);
        rgba = rgba << 8 | (alpha && alpha->width == 1 ? byteOf(alpha->values[i]) : 255);
        const auto [at, fresh] = places.try_emplace(rgba, std::uint32_t(palette.colours.size()));
        if (fresh) palette.colours.push_back(rgba);
        palette.ofVertex.push_back(at->second);
    }
    return palette;
}

// One object of the file.
struct Part {
    std::vector<std::uint32_t> faces;     // of the mesh's triangles
    std::vector<std::uint32_t> vertices;  // of the welded mesh, ascending
};

// The part that a part is written with: cavities, and what adds nothing, with the solid around them; open
// ones, which bound nothing by themselves, all with the first.
std::size_t ownerOf(const MeshParts& parts, std::size_t part, std::size_t firstOpen) {
    const auto role = [&] { return parts.parts[part].role; };
    while ((role() == PartRole::Cavity || role() == PartRole::United) && parts.parts[part].around >= 0)
        part = std::size_t(parts.parts[part].around);
    return role() == PartRole::Open ? firstOpen : part;
}

// Of a mesh of triangles, welded. Triangles with two corners at one place are left out: their edges cancel.
std::vector<Part> partsOf(const Mesh& welded) {
    const MeshParts all = meshParts(welded);
    const std::size_t firstOpen =
        std::size_t(std::find_if(all.parts.begin(), all.parts.end(),
                                 [](const MeshPart& part) { return part.role == PartRole::Open; }) -
                    all.parts.begin());
    std::vector<std::size_t> place(all.parts.size(), all.parts.size());
    std::vector<Part> parts;
    for (std::size_t f = 0; f < welded.triangles.size(); ++f) {
        const Triangle& t = welded.triangles[f];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        const std::size_t owner = ownerOf(all, all.partOf[f], firstOpen);
        if (place[owner] == all.parts.size()) {
            place[owner] = parts.size();
            parts.emplace_back();
        }
        parts[place[owner]].faces.push_back(std::uint32_t(f));
    }
    for (Part& part : parts) {
        for (std::uint32_t f : part.faces)
            part.vertices.insert(part.vertices.end(), welded.triangles[f].begin(), welded.triangles[f].end());
        std::sort(part.vertices.begin(), part.vertices.end());
        part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
        part.vertices.shrink_to_fit();
    }
    return parts;
}

// The text of the model, in pieces of whole rows.
class ModelText {
public:
    explicit ModelText(const Mesh& mesh)
        : mTriangles(triangulated(mesh)), mPalette(paletteOf(mesh)), mFar(length(mesh.origin) > 0) {
        mWelded.points = mesh.points;
        mWelded.origin = mesh.origin;
        mWelded.triangles = mTriangles;
        weldVertices(mWelded);
        mParts = partsOf(mWelded);
        mLocal.resize(mParts.size() == 1 ? mesh.points.size() : 0);
        for (std::size_t i = 0; !mLocal.empty() && i < mParts[0].vertices.size(); ++i)
            mLocal[mParts[0].vertices[i]] = std::uint32_t(i);
        plan();
    }

    std::size_t pieces() const { return mPieces.size(); }
    std::string piece(std::size_t index) const {
        std::string text;
        for (const Rows& rows : mPieces[index]) append(text, rows);
        return text;
    }

private:
    enum class Kind { Begin, Colours, Vertices, Triangles, End };
    struct Rows {
        Kind kind;
        std::size_t part, first, last, count;
    };

    void plan() {
        std::size_t room = 0;
        const auto add = [&](Kind kind, std::size_t part, std::size_t count) {
            for (std::size_t first = 0; first < std::max<std::size_t>(count, 1);) {
                if (room == 0) {
                    mPieces.emplace_back();
                    room = kRows;
                }
                const std::size_t last = std::min(count, first + room);
                mPieces.back().push_back({kind, part, first, last, count});
                room -= last - first;
                first = std::max(last, first + 1);
            }
        };
        add(Kind::Begin, 0, 0);
        if (!mPalette.colours.empty()) add(Kind::Colours, 0, mPalette.colours.size());
        for (std::size_t p = 0; p < mParts.size(); ++p) {
            add(Kind::Vertices, p, mParts[p].vertices.size());
            add(Kind::Triangles, p, mParts[p].faces.size());
        }
        add(Kind::End, 0, 0);
    }

    void append(std::string& text, const Rows& rows) const {
        switch (rows.kind) {
            case Kind::Begin:
                text += kBegin;
                break;
            case Kind::Colours:
                if (rows.first == 0) text += "<m:colorgroup id=\"1\">\n";
                for (std::size_t i = rows.first; i < rows.last; ++i) appendColour(text, mPalette.colours[i]);
                if (rows.last == rows.count) text += "</m:colorgroup>\n";
                break;
            case Kind::Vertices:
                if (rows.first == 0) appendObject(text, rows.part);
                for (std::size_t i = rows.first; i < rows.last; ++i)
                    appendVertex(text, mParts[rows.part].vertices[i]);
                if (rows.last == rows.count) text += "</vertices>\n<triangles>\n";
                break;
            case Kind::Triangles:
                for (std::size_t i = rows.first; i < rows.last; ++i)
                    appendTriangle(text, rows.part, mParts[rows.part].faces[i]);
                if (rows.last == rows.count) text += "</triangles></mesh></object>\n";
                break;
            case Kind::End:
                appendBuild(text);
                break;
        }
    }

    static void appendColour(std::string& text, std::uint32_t rgba) {
        text += "<m:color color=\"#";
        for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789ABCDEF"[rgba >> shift & 15];
        text += "\"/>\n";
    }

    static std::string idOf(std::size_t part) { return std::to_string(part + 2); }

    void appendObject(std::string& text, std::size_t part) const {
        text += "<object id=\"" + idOf(part) + "\" type=\"model\"";
        if (!mPalette.colours.empty()) text += " pid=\"1\" pindex=\"0\"";
        text += "><mesh>\n<vertices>\n";
    }

    // Floats exactly; with an origin the digits that a float beside it has.
    void appendVertex(std::string& text, std::uint32_t vertex) const {
        constexpr int kDigits = 14;
        static const char* const names[3] = {"<vertex x=\"", "\" y=\"", "\" z=\""};
        for (int axis = 0; axis < 3; ++axis) {
            const float value = mWelded.points[vertex][axis];
            text += names[axis];
            text += mFar ? roundedText(mWelded.origin[axis] + double(value), kDigits) : exactText(value);
        }
        text += "\"/>\n";
    }

    std::uint32_t localOf(std::size_t part, std::uint32_t vertex) const {
        if (!mLocal.empty()) return mLocal[vertex];
        const std::vector<std::uint32_t>& all = mParts[part].vertices;
        return std::uint32_t(std::lower_bound(all.begin(), all.end(), vertex) - all.begin());
    }

    void appendTriangle(std::string& text, std::size_t part, std::uint32_t face) const {
        static const char* const corners[3] = {"<triangle v1=\"", "\" v2=\"", "\" v3=\""};
        static const char* const colours[3] = {"\" p1=\"", "\" p2=\"", "\" p3=\""};
        for (std::size_t k = 0; k < 3; ++k) {
            text += corners[k];
            text += std::to_string(localOf(part, mWelded.triangles[face][k]));
        }
        if (!mPalette.colours.empty()) {
            text += "\" pid=\"1";
            for (std::size_t k = 0; k < 3; ++k) {
                text += colours[k];
                text += std::to_string(mPalette.ofVertex[mTriangles[face][k]]);
            }
        }
        text += "\"/>\n";
    }

    void appendBuild(std::string& text) const {
        std::string built = idOf(0);
        if (mParts.size() > 1) {
            built = idOf(mParts.size());
            text += "<object id=\"" + built + "\" type=\"model\"><components>\n";
            for (std::size_t p = 0; p < mParts.size(); ++p)
                text += "<component objectid=\"" + idOf(p) + "\"/>\n";
            text += "</components></object>\n";
        }
        text += "</resources>\n<build><item objectid=\"" + built + "\"/></build>\n</model>\n";
    }

    std::vector<Triangle> mTriangles;
    Palette mPalette;
    bool mFar;
    Mesh mWelded;
    std::vector<Part> mParts;
    std::vector<std::uint32_t> mLocal;  // of a file of one part
    std::vector<std::vector<Rows>> mPieces;
};

}  // namespace

bool holds3mfColours(const Mesh& mesh) {
    const Attribute* colour = findAttribute(mesh.attributes, "Cd");
    const auto plain = [](float value) { return value >= -0.002f && value <= 1.002f; };
    return colour && colour->width == 3 && std::all_of(colour->values.begin(), colour->values.end(), plain);
}

std::string threemfBytes(const Mesh& mesh) {
    const ModelText text(mesh);
    ZipWriter zip;
    zip.add("[Content_Types].xml", kTypes);
    zip.add("_rels/.rels", kRelations);
    zip.add("3D/3dmodel.model", text.pieces(), [&](std::size_t i) { return text.piece(i); });
    return zip.finish();
}

std::string lostIn3mf(const Mesh& mesh) {
    std::string lost;
    for (const Attribute& attribute : mesh.attributes) {
        const bool colour = attribute.name == "Cd" || (attribute.name == "Alpha" && attribute.width == 1);
        if (colour && holds3mfColours(mesh)) continue;
        lost += (lost.empty() ? "" : ", ") + attribute.name;
    }
    return lost;
}

}  // namespace vdbsynth
