// The writers behind writeMesh and writePointsPly, except glTF's and 3MF's.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/mesh_check.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/text_scanner.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "libvdbsynth/io/textured_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbsynth {
namespace {

// The colours, if all fit a file's 8 bits; null otherwise.
const Attribute* plainColour(const Attributes& attributes) {
    const Attribute* colour = findAttribute(attributes, "Cd");
    const auto plain = [](float value) { return value >= -0.002f && value <= 1.002f; };
    return colour && colour->width == 3 && std::all_of(colour->values.begin(), colour->values.end(), plain)
               ? colour
               : nullptr;
}

std::uint8_t byteOf(float value) {
    return std::uint8_t(std::lround(double(std::clamp(value, 0.f, 1.f)) * 255));
}

// Floats exactly; with an origin the digits that a float beside it has.
void appendPoint(std::string& text, const Vec3f& p, const Vec3d& origin) {
    constexpr int kDigits = 14;
    const bool far = length(origin) > 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (axis) text += ' ';
        text += far ? roundedText(origin[axis] + double(p[axis]), kDigits) : exactText(p[axis]);
    }
}

template <typename Face>
void appendFaces(std::string& text, const std::vector<Face>& faces, const std::string& prefix,
                 std::uint32_t first) {
    for (const Face& face : faces) {
        text += prefix;
        for (std::uint32_t index : face) text += ' ' + std::to_string(index + first);
        text += '\n';
    }
}

std::string objText(const Mesh& mesh) {
    std::string text = "# vdb_synth\n";
    const Attribute* colour = plainColour(mesh.attributes);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        text += "v ";
        appendPoint(text, mesh.points[i], mesh.origin);
        for (std::size_t c = 0; colour && c < 3; ++c) {
            text += ' ';
            text += exactText(colour->values[3 * i + c]);
        }
        text += '\n';
    }
    appendFaces(text, mesh.triangles, "f", 1);
    appendFaces(text, mesh.quads, "f", 1);
    return text;
}

std::string offText(const Mesh& mesh) {
    const Attribute* colour = plainColour(mesh.attributes);
    std::string text = std::string(colour ? "COFF\n" : "OFF\n") + std::to_string(mesh.points.size()) + ' ' +
                       std::to_string(mesh.faceCount()) + " 0\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        appendPoint(text, mesh.points[i], mesh.origin);
        for (std::size_t c = 0; colour && c < 3; ++c)
            text += ' ' + std::to_string(byteOf(colour->values[3 * i + c]));
        text += colour ? " 255\n" : "\n";
    }
    appendFaces(text, mesh.triangles, "3", 0);
    appendFaces(text, mesh.quads, "4", 0);
    return text;
}

template <typename T>
void appendBytes(std::string& text, const T& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// A name of one word.
std::string wordOf(std::string name) {
    for (char& c : name)
        if (c <= ' ' || c == 127) c = '_';
    return name.empty() ? "value" : name;
}

// The vertices of a PLY file: their properties and their bytes.
class PlyVertices {
public:
    PlyVertices(const std::vector<Vec3f>& points, const Vec3d& origin, const std::vector<Vec3f>& normals,
                const Attributes& attributes)
        : mPoints(points),
          mOrigin(origin),
          mFar(length(origin) > 0),
          mNormals(normals),
          mColour(plainColour(attributes)) {
        const Attribute* alpha = findAttribute(attributes, "Alpha");
        mAlpha = mColour && alpha && alpha->width == 1 ? alpha : nullptr;
        for (const Attribute& attribute : attributes)
            if (&attribute != mColour && &attribute != mAlpha) mOthers.push_back(&attribute);
    }

    std::string header() const {
        const std::string type = mFar ? "double" : "float";
        std::string text = "element vertex " + std::to_string(mPoints.size()) + "\nproperty " + type +
                           " x\nproperty " + type + " y\nproperty " + type + " z\n";
        if (!mNormals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
        if (mColour) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
        if (mAlpha) text += "property uchar alpha\n";
        static const char* const axes[3] = {"_x", "_y", "_z"};
        for (const Attribute* attribute : mOthers)
            for (std::size_t c = 0; c < attribute->width; ++c) {
                const bool texture = attribute->name == "uv" && attribute->width == 2;
                text += "property float " +
                        (texture ? std::string(c ? "t" : "s")
                                 : wordOf(attribute->name) + (attribute->width > 1 ? axes[c] : "")) +
                        "\n";
            }
        return text;
    }

    void append(std::string& text) const {
        for (std::size_t i = 0; i < mPoints.size(); ++i) {
            if (mFar)
                appendBytes(text, mOrigin + cast<double>(mPoints[i]));
            else
                appendBytes(text, mPoints[i]);
            if (!mNormals.empty()) appendBytes(text, mNormals[i]);
            for (std::size_t c = 0; mColour && c < 3; ++c) text += char(byteOf(mColour->values[3 * i + c]));
            if (mAlpha) text += char(byteOf(mAlpha->values[i]));
            for (const Attribute* attribute : mOthers)
                for (std::size_t c = 0; c < attribute->width; ++c)
                    appendBytes(text, attribute->values[i * attribute->width + c]);
        }
    }

private:
    const std::vector<Vec3f>& mPoints;
    Vec3d mOrigin;
    bool mFar;  // coordinates are written as doubles
    const std::vector<Vec3f>& mNormals;
    const Attribute *mColour, *mAlpha = nullptr;
    std::vector<const Attribute*> mOthers;
};

std::string plyStart(const std::vector<std::string>& comments) {
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment vdb_synth\n";
    for (const std::string& comment : comments) text += "comment " + comment + '\n';
    return text;
}

std::string plyBytes(const Mesh& mesh, const std::vector<Vec3f>& normals,
                     const std::vector<std::string>& comments) {
    const PlyVertices vertices(mesh.points, mesh.origin, normals, mesh.attributes);
    std::string text = plyStart(comments) + vertices.header() + "element face " +
                       std::to_string(mesh.faceCount()) +
                       "\nproperty list uchar uint vertex_indices\nend_header\n";
    vertices.append(text);
    for (const Triangle& t : mesh.triangles) {
        text += char(3);
        appendBytes(text, t);
    }
    for (const Quad& q : mesh.quads) {
        text += char(4);
        appendBytes(text, q);
    }
    return text;
}

std::string stlBytes(const Mesh& mesh) {
    std::string text = "vdb_synth";
    text.resize(80, ' ');
    const std::vector<Triangle> triangles = triangulated(mesh);
    appendBytes(text, std::uint32_t(triangles.size()));
    for (const Triangle& t : triangles) {
        const auto corner = [&](std::size_t k) {
            return cast<float>(mesh.origin + cast<double>(mesh.points[t[k]]));
        };
        const Vec3f a = corner(0), b = corner(1), c = corner(2);
        appendBytes(text, normalized(cross(b - a, c - a)));
        appendBytes(text, a);
        appendBytes(text, b);
        appendBytes(text, c);
        appendBytes(text, std::uint16_t(0));
    }
    return text;
}

}  // namespace

void writeMesh(const std::string& path, MeshFormat format, const Mesh& mesh) {
    requireMesh(mesh, path);
    switch (format) {
        case MeshFormat::Obj:
            return writeWholeFile(path, objText(mesh));
        case MeshFormat::Ply:
            return writeWholeFile(path, plyBytes(mesh, {}, {}));
        case MeshFormat::Stl:
            return writeWholeFile(path, stlBytes(mesh));
        case MeshFormat::Off:
            return writeWholeFile(path, offText(mesh));
        case MeshFormat::Gltf:
            return writeWholeFile(path, gltfBytes(mesh, /* binary= */ false));
        case MeshFormat::Glb:
            return writeWholeFile(path, gltfBytes(mesh, /* binary= */ true));
        case MeshFormat::ThreeMf:
            return writeWholeFile(path, threemfBytes(mesh));
        case MeshFormat::Medit:
            throw Error(ErrorCode::InvalidOption, path + ": MEDIT meshes are read, not written");
    }
}

void writePly(const std::string& path, const Mesh& mesh, const std::vector<Vec3f>& normals,
              const std::vector<std::string>& comments) {
    requireMesh(mesh, path);
    writeWholeFile(path, plyBytes(mesh, normals, comments));
}

void writePly(const std::string& path, const PointCloud& cloud, const std::vector<std::string>& comments) {
    static const std::vector<Vec3f> none;
    const PlyVertices vertices(cloud.points, cloud.origin,
                               cloud.normals.size() == cloud.points.size() ? cloud.normals : none,
                               cloud.attributes);
    std::string text = plyStart(comments) + vertices.header() + "end_header\n";
    vertices.append(text);
    writeWholeFile(path, text);
}

void writePointsPly(const std::string& path, const PointCloud& cloud) {
    writePly(path, cloud, {});
}

}  // namespace vdbsynth
