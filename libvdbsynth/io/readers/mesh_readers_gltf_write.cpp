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

void addAttributes(tinygltf::Model& model, const Mesh& mesh, bool pictured, tinygltf::Primitive& primitive) {
    for (const Attribute& attribute : mesh.attributes) {
        const bool texture = attribute.name == "uv" && attribute.width == 2,
                   colour = attribute.name == "Cd" && attribute.width == 3 && !pictured;
        std::vector<float> values = attribute.values;
        for (std::size_t i = 1; texture && i < values.size(); i += 2) values[i] = 1 - values[i];
        primitive.attributes[texture  ? "TEXCOORD_0"
                             : colour ? "COLOR_0"
                                      : "_" + asciiOf(attribute.name)] =
            addFloats(model, values.data(), mesh.points.size(), attribute.width);
    }
}

// Positions, normals and attributes of the vertices; primitives share them.
tinygltf::Primitive addVertices(tinygltf::Model& model, const Mesh& mesh, const std::vector<Vec3f>& normals,
                                bool pictured) {
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
    addAttributes(model, mesh, pictured, primitive);
    return primitive;
}

int addTriangles(tinygltf::Model& model, const Triangle* first, std::size_t count) {
    return addBlock(model, first, count * 3, count * sizeof(Triangle), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                    TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
}

tinygltf::Model startedModel() {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "vdb_synth";
    model.buffers.emplace_back();
    return model;
}

// The scene of one mesh, and the file's bytes.
std::string finished(tinygltf::Model& model, const std::vector<tinygltf::Primitive>& primitives,
                     const Vec3d& origin, bool binary) {
    tinygltf::Mesh made;
    made.name = "surface";
    made.primitives = primitives;
    model.meshes.push_back(made);
    tinygltf::Node node;
    node.name = "surface";
    node.mesh = 0;
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

// A picture in the file's buffer, and a texture of it. @return the texture's index, -1 without a picture
int addPicture(tinygltf::Model& model, const std::string& png, int sampler, const std::string& name) {
    if (png.empty()) return -1;
    std::vector<unsigned char>& buffer = model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = png.size();
    buffer.insert(buffer.end(), png.begin(), png.end());
    buffer.resize((buffer.size() + 3) / 4 * 4);  // what follows is aligned
    model.bufferViews.push_back(view);
    tinygltf::Image image;
    image.bufferView = int(model.bufferViews.size()) - 1;
    image.mimeType = "image/png";
    image.name = name;
    model.images.push_back(image);
    tinygltf::Texture texture;
    texture.source = int(model.images.size()) - 1;
    texture.sampler = sampler;
    model.textures.push_back(texture);
    return int(model.textures.size()) - 1;
}

void addMaterial(tinygltf::Model& model, const MeshPictures& pictures) {
    tinygltf::Sampler sampler;
    sampler.wrapS = sampler.wrapT =
        pictures.repeats ? TINYGLTF_TEXTURE_WRAP_REPEAT : TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    model.samplers.push_back(sampler);
    const int number = int(model.samplers.size()) - 1;
    tinygltf::Material material;
    material.name = asciiOf(pictures.name);
    tinygltf::PbrMetallicRoughness& base = material.pbrMetallicRoughness;
    base.baseColorTexture.index = addPicture(model, pictures.colour, number, "colour");
    base.metallicRoughnessTexture.index = addPicture(model, pictures.roughness, number, "roughness");
    base.metallicFactor = pictures.roughness.empty() ? 0 : 1;
    material.normalTexture.index = addPicture(model, pictures.normal, number, "normal");
    model.materials.push_back(material);
}

}  // namespace

std::string gltfBytes(const Mesh& mesh, bool binary) {
    const std::vector<Triangle> triangles = triangulated(mesh);
    tinygltf::Model model = startedModel();
    tinygltf::Primitive primitive =
        addVertices(model, mesh, vertexNormals(mesh, triangles), /* pictured= */ false);
    primitive.indices = addTriangles(model, triangles.data(), triangles.size());
    return finished(model, {primitive}, mesh.origin, binary);
}

std::string texturedGltfBytes(const std::vector<TexturedMesh>& parts,
                              const std::vector<MeshPictures>& materials, bool binary) {
    tinygltf::Model model = startedModel();
    std::vector<tinygltf::Primitive> primitives;
    for (const TexturedMesh& part : parts) {
        primitives.push_back(addVertices(model, part.mesh, part.normals, /* pictured= */ true));
        primitives.back().indices =
            addTriangles(model, part.mesh.triangles.data(), part.mesh.triangles.size());
        primitives.back().material = int(part.pictures.front());
    }
    for (const MeshPictures& pictures : materials) addMaterial(model, pictures);
    return finished(model, primitives, parts.front().mesh.origin, binary);
}

}  // namespace vdbsynth
