#include "libvdbsynth/io/mesh_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_readers.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/text_scanner.h"
#include "libvdbsynth/io/whole_file.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

namespace vdbsynth {
namespace {

void checkFaces(const std::string& path, const Mesh& mesh) {
    const auto check = [&](std::uint32_t index) {
        if (index >= mesh.points.size())
            throw Error(ErrorCode::BadData, path + ": a face uses vertex " + std::to_string(index) + " of " +
                                                std::to_string(mesh.points.size()) + " (counting from 0)");
    };
    for (const Triangle& t : mesh.triangles)
        for (std::uint32_t i : t) check(i);
    for (const Quad& q : mesh.quads)
        for (std::uint32_t i : q) check(i);
    if (mesh.faceCount() == 0)
        throw Error(ErrorCode::EmptyInput, path + ": no faces; a mesh with at least one face is needed");
}

void appendPoint(std::string& text, const Vec3f& p) {
    for (int axis = 0; axis < 3; ++axis) {
        if (axis) text += ' ';
        appendReal(text, p[axis]);
    }
    text += '\n';
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
    for (const Vec3f& p : mesh.points) {
        text += "v ";
        appendPoint(text, p);
    }
    appendFaces(text, mesh.triangles, "f", 1);
    appendFaces(text, mesh.quads, "f", 1);
    return text;
}

std::string offText(const Mesh& mesh) {
    std::string text =
        "OFF\n" + std::to_string(mesh.points.size()) + ' ' + std::to_string(mesh.faceCount()) + " 0\n";
    for (const Vec3f& p : mesh.points) appendPoint(text, p);
    appendFaces(text, mesh.triangles, "3", 0);
    appendFaces(text, mesh.quads, "4", 0);
    return text;
}

template <typename T>
void appendBytes(std::string& text, const T& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string plyBytes(const Mesh& mesh) {
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment vdb_synth\nelement vertex " +
                       std::to_string(mesh.points.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(mesh.faceCount()) +
                       "\nproperty list uchar uint vertex_indices\nend_header\n";
    for (const Vec3f& p : mesh.points) appendBytes(text, p);
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
        const Vec3f a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
        appendBytes(text, normalized(cross(b - a, c - a)));
        appendBytes(text, a);
        appendBytes(text, b);
        appendBytes(text, c);
        appendBytes(text, std::uint16_t(0));
    }
    return text;
}

}  // namespace

namespace {

bool formatOfExtension(const std::string& extension, MeshFormat& format) {
    static const std::pair<const char*, MeshFormat> formats[] = {{"obj", MeshFormat::Obj},
                                                                 {"ply", MeshFormat::Ply},
                                                                 {"stl", MeshFormat::Stl},
                                                                 {"off", MeshFormat::Off},
                                                                 {"mesh", MeshFormat::Medit}};
    for (const auto& [name, value] : formats)
        if (extension == name) {
            format = value;
            return true;
        }
    return false;
}

}  // namespace

bool meshFormatOf(const std::string& path, MeshFormat& format) {
    return formatOfExtension(readExtensionOf(path), format);
}

bool writableMeshFormatOf(const std::string& path, MeshFormat& format) {
    return formatOfExtension(extensionOf(path), format) && format != MeshFormat::Medit;
}

Mesh readMesh(const std::string& path, const RunContext& ctx) {
    MeshFormat format{};
    if (!meshFormatOf(path, format))
        throw Error(ErrorCode::InvalidOption,
                    path + ": unknown extension; meshes are .obj, .ply, .stl, .off or .mesh");
    Stage stage(ctx, "reading " + path, 2, /* reading= */ true);
    const std::string content = readWholeFile(path);
    stage.advance();
    if (content.empty()) throw Error(ErrorCode::BadData, path + ": the file is empty");
    Mesh mesh;
    switch (format) {
        case MeshFormat::Obj:
            mesh = readObj(path, content);
            break;
        case MeshFormat::Ply:
            mesh = readPly(path, content);
            break;
        case MeshFormat::Stl:
            mesh = readStl(path, content);
            break;
        case MeshFormat::Off:
            mesh = readOff(path, content);
            break;
        case MeshFormat::Medit:
            mesh = readMedit(path, content);
            break;
    }
    checkFaces(path, mesh);
    stage.advance();
    return mesh;
}

void writeMesh(const std::string& path, MeshFormat format, const Mesh& mesh) {
    switch (format) {
        case MeshFormat::Obj:
            return writeWholeFile(path, objText(mesh));
        case MeshFormat::Ply:
            return writeWholeFile(path, plyBytes(mesh));
        case MeshFormat::Stl:
            return writeWholeFile(path, stlBytes(mesh));
        case MeshFormat::Off:
            return writeWholeFile(path, offText(mesh));
        case MeshFormat::Medit:
            throw Error(ErrorCode::InvalidOption, path + ": MEDIT meshes are read, not written");
    }
}

void writePointsPly(const std::string& path, const PointCloud& cloud) {
    const bool normals = cloud.normals.size() == cloud.points.size();
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment vdb_synth\nelement vertex " +
                       std::to_string(cloud.points.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
    if (normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
    text += "end_header\n";
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        appendBytes(text, cloud.points[i]);
        if (normals) appendBytes(text, cloud.normals[i]);
    }
    writeWholeFile(path, text);
}

}  // namespace vdbsynth
