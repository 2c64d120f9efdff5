#include "libvdbsynth/io/mesh_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <utility>

namespace vdbsynth {
namespace {

MeshContent readFormat(MeshFormat format, const std::string& path, const std::string& content,
                       const RunContext& ctx) {
    switch (format) {
        case MeshFormat::Obj:
            return readObj(path, content, ctx);
        case MeshFormat::Ply:
            return readPly(path, content, ctx);
        case MeshFormat::Stl:
            return readStl(path, content, ctx);
        case MeshFormat::Off:
            return readOff(path, content, ctx);
        case MeshFormat::Medit:
            return readMedit(path, content, ctx);
        case MeshFormat::Gltf:
        case MeshFormat::Glb:
            return readGltf(path, content, ctx);
        case MeshFormat::ThreeMf:
            return read3mf(path, content, ctx);
    }
    return {};
}

bool formatOfExtension(const std::string& extension, MeshFormat& format) {
    static const std::pair<const char*, MeshFormat> formats[] = {
        {"obj", MeshFormat::Obj}, {"ply", MeshFormat::Ply},    {"stl", MeshFormat::Stl},
        {"off", MeshFormat::Off}, {"mesh", MeshFormat::Medit}, {"gltf", MeshFormat::Gltf},
        {"glb", MeshFormat::Glb}, {"3mf", MeshFormat::ThreeMf}};
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
        throw Error(
            ErrorCode::InvalidOption,
            path + ": unknown extension; meshes are .obj, .ply, .stl, .off, .gltf, .glb, .3mf or .mesh");
    Stage stage(ctx, "reading " + path, 2, /* reading= */ true);
    const std::string content = readWholeFile(path);
    stage.advance();
    if (content.empty()) throw Error(ErrorCode::BadData, path + ": the file is empty");
    Mesh mesh = meshOf(path, readFormat(format, path, content, ctx), ctx);
    stage.advance();
    return mesh;
}

}  // namespace vdbsynth
