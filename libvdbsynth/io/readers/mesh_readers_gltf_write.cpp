// The writer of glTF, through tinygltf, in the only file that includes it.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <locale>
#include <sstream>

namespace vdbsynth {
namespace {

// Vertex normals, from the adjacent faces weighted by area.
std::vector<Vec3f> vertexNormals(const Mesh& mesh, const std::vector<Triangle>& triangles) {
    std::vector<Vec3d> sums(mesh.points.size());
    for (const Triangle& t : triangles) {
        const Vec3d a = cast<double>(mesh.points[t[0]]), b = cast<double>(mesh.points[t[1]]),
                    c = cast<double>(mesh.points[t[2]]);
        const Vec3d normal = cross(b - a, c - a);
        for (std::uint32_t i : t) sums[i] = sums[i] + normal;
    }
    std::vector<Vec3f> normals;
    for (const Vec3d& sum : sums)
        normals.push_back(length(sum) > 0 ? cast<float>(normalized(sum)) : Vec3f{0, 0, 1});
    return normals;
}

// Appends a block of numbers to the file's buffer, with its view and accessor. @return the accessor's index
int addBlock(tinygltf::Model& model, const void* data, std::size_t count, std::size_t bytes,
             int componentType, int type, int target) {
    std::vector<unsigned char>& buffer = model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = bytes;
    view.target = target;
    const unsigned char* from = static_cast<const unsigned char*>(data);
    buffer.insert(buffer.end(), from, from + bytes);
    model.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = int(model.bufferViews.size()) - 1;
    accessor.componentType = componentType;
    accessor.count = count;
    accessor.type = type;
    model.accessors.push_back(accessor);
    return int(model.accessors.size()) - 1;
}

int addFloats(tinygltf::Model& model, const float* values, std::size_t count, std::size_t width) {
    const int types[4] = {0, TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3};
    return addBlock(model, values, count, count * width * sizeof(float), TINYGLTF_COMPONENT_TYPE_FLOAT,
                    types[width], TINYGLTF_TARGET_ARRAY_BUFFER);
}

// JSON is UTF-8; names from other formats may have any bytes.
std::string asciiOf(std::string name) {
    for (char& c : name)
        if (c < ' ' || c > '~') c = '_';
    return name;
}

void addAttributes(tinygltf::Model& model, const Mesh& mesh, tinygltf::Primitive& primitive) {
    for (const Attribute& attribute : mesh.attributes) {
        const bool texture = attribute.name == "uv" && attribute.width == 2,
                   colour = attribute.name == "Cd" && attribute.width == 3;
        std::vector<float> values = attribute.values;
        for (std::size_t i = 1; texture && i < values.size(); i += 2) values[i] = 1 - values[i];
        primitive.attributes[texture  ? "TEXCOORD_0"
                             : colour ? "COLOR_0"
                                      : "_" + asciiOf(attribute.name)] =
            addFloats(model, values.data(), mesh.points.size(), attribute.width);
    }
}

}  // namespace

std::string gltfBytes(const Mesh& mesh, bool binary) {
    const std::vector<Triangle> triangles = triangulated(mesh);
    const std::vector<Vec3f> normals = vertexNormals(mesh, triangles);
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "vdb_synth";
    model.buffers.emplace_back();
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const int position = addFloats(model, &mesh.points[0].x, mesh.points.size(), 3);
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            std::minmax_element(mesh.points.begin(), mesh.points.end(),
                                [axis](const Vec3f& a, const Vec3f& b) { return a[axis] < b[axis]; });
        model.accessors[std::size_t(position)].minValues.push_back(double((*low)[axis]));
        model.accessors[std::size_t(position)].maxValues.push_back(double((*high)[axis]));
    }
    primitive.attributes["POSITION"] = position;
    primitive.attributes["NORMAL"] = addFloats(model, &normals[0].x, normals.size(), 3);
    addAttributes(model, mesh, primitive);
    primitive.indices = addBlock(model, triangles.data(), triangles.size() * 3,
                                 triangles.size() * sizeof(Triangle), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                 TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Mesh made;
    made.name = "surface";
    made.primitives.push_back(primitive);
    model.meshes.push_back(made);
    tinygltf::Node node;
    node.name = "surface";
    node.mesh = 0;
    const Vec3d& origin = mesh.origin;
    if (!(origin.x == 0 && origin.y == 0 && origin.z == 0)) node.translation = {origin.x, origin.y, origin.z};
    model.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    model.scenes.push_back(scene);
    model.defaultScene = 0;
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model, stream, /* prettyPrint= */ false, binary))
        throw Error(ErrorCode::Solver, "the glTF file cannot be composed");
    return stream.str();
}

}  // namespace vdbsynth
