// Which primitives a glTF scene has, and what of them and of the file is not read.
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

namespace vdbsynth {
namespace {

// Beyond it files are made to take time: nodes may share a mesh of many.
constexpr std::size_t kMostPrimitives = 10000000;

std::string counted(std::size_t count, const std::string& what) {
    return std::to_string(count) + (count == 1 ? " primitive of " : " primitives of ") + what;
}

}  // namespace

std::uint64_t gltfMode(const GltfFile& file, const GltfJson& primitive) {
    const std::uint64_t mode = file.whole(primitive, "mode", kGltfTriangles);
    if (mode > kGltfTriangleFan) file.refuse("a primitive's mode is not one of glTF's");
    return mode;
}

const GltfJson& gltfPrimitives(const GltfFile& file, std::int64_t mesh) {
    static const GltfJson none = GltfJson::array();
    const GltfJson* primitives = gltfMember(file.item("meshes", mesh, "a mesh"), "primitives");
    if (primitives && !primitives->is_array()) file.refuse("the primitives of a mesh are no list");
    return primitives ? *primitives : none;
}

GltfKinds gltfKinds(const GltfFile& file, const GltfScene& scene) {
    std::map<std::int64_t, GltfKinds> known;
    GltfKinds sum;
    for (const GltfPart& part : scene.parts()) {
        const auto [found, isNew] = known.try_emplace(part.mesh);
        GltfKinds& kinds = found->second;
        if (isNew)
            for (const GltfJson& primitive : gltfPrimitives(file, part.mesh)) {
                const std::uint64_t mode = gltfMode(file, primitive);
                ++(mode == kGltfPoints      ? kinds.points
                   : mode <= kGltfLineStrip ? kinds.lines
                                            : kinds.triangles);
            }
        sum.triangles += kinds.triangles;
        sum.lines += kinds.lines;
        sum.points += kinds.points;
        if (sum.triangles + sum.lines + sum.points > kMostPrimitives)
            file.refuse("has over ten million primitives");
    }
    return sum;
}

void sayGltfKinds(const GltfFile& file, const GltfKinds& kinds, bool points) {
    std::string others;
    if (kinds.lines > 0) others = counted(kinds.lines, "lines");
    if (kinds.points > 0 && !points)
        others += (others.empty() ? "" : " and ") + counted(kinds.points, "points");
    if (!others.empty())
        file.say(MessageLevel::Note,
                 others + " left out; only " + (points ? "points" : "triangles") + " are read");
    const std::size_t animations = file.list("animations").size();
    if (animations > 0)
        file.say(MessageLevel::Note, std::to_string(animations) +
                                         (animations == 1 ? " animation" : " animations") +
                                         " left out; it is read in its default pose");
}

}  // namespace vdbsynth
