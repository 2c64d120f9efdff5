#include "libvdbsynth/io/mesh_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"

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

bool formatOfExtension(const std::string& extension, MeshFormat& format) {
    static const std::pair<const char*, MeshFormat> formats[] = {
        {"obj", MeshFormat::Obj}, {"ply", MeshFormat::Ply},    {"stl", MeshFormat::Stl},
        {"off", MeshFormat::Off}, {"mesh", MeshFormat::Medit}, {"gltf", MeshFormat::Gltf},
        {"glb", MeshFormat::Glb}};
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
                    path + ": unknown extension; meshes are .obj, .ply, .stl, .off, .gltf, .glb or .mesh");
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
        case MeshFormat::Gltf:
        case MeshFormat::Glb:
            mesh = readGltf(path, content);
            break;
    }
    checkFaces(path, mesh);
    stage.advance();
    return mesh;
}

}  // namespace vdbsynth
