// glTF through tinygltf, in the only file that includes it. It parses the JSON and fetches buffers; the
// targets of accessors are checked here before they are read.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"
#include "libvdbsynth/math/affine.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <locale>
#include <map>
#include <set>
#include <sstream>

namespace vdbsynth {
namespace {

constexpr std::size_t kMostNodes = 1000000;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": " + what);
}

Affine matrixOf(const tinygltf::Node& node) {
    Affine m = kIdentity;
    if (node.matrix.size() == 16) {
        std::copy(node.matrix.begin(), node.matrix.end(), m.begin());
        return m;
    }
    if (node.rotation.size() == 4)
        m = rotation(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]);
    for (std::size_t c = 0; node.scale.size() == 3 && c < 3; ++c)
        for (std::size_t r = 0; r < 3; ++r) m[c * 4 + r] *= node.scale[c];
    for (std::size_t r = 0; node.translation.size() == 3 && r < 3; ++r) m[12 + r] = node.translation[r];
    return m;
}

// Divisor of normalised integers, 0 for real numbers.
double whiteOf(int componentType) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return 127;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 255;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return 32767;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 65535;
        default:
            return 0;
    }
}

double numberAt(const unsigned char* bytes, int componentType) {
    const auto as = [bytes](auto value) {
        std::memcpy(&value, bytes, sizeof value);
        return double(value);
    };
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return as(std::int8_t());
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return as(std::uint8_t());
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return as(std::int16_t());
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return as(std::uint16_t());
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as(std::uint32_t());
        default:
            return as(float());
    }
}

// Reads the meshes of a parsed file.
class Reader {
public:
    Reader(const std::string& path, const tinygltf::Model& model) : mPath(path), mModel(model) {}

    MeshContent read() {
        std::vector<int> roots;
        if (!mModel.scenes.empty()) {
            const std::size_t scene = mModel.defaultScene >= 0 ? std::size_t(mModel.defaultScene) : 0;
            if (scene >= mModel.scenes.size()) refuse(mPath, "its scene does not exist");
            roots = mModel.scenes[scene].nodes;
        } else {
            roots = rootNodes();
        }
        struct Visit {
            int node;
            Affine matrix;
        };
        std::vector<Visit> open;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, kIdentity});
        std::set<int> seen;
        while (!open.empty()) {
            const Visit visit = open.back();
            open.pop_back();
            if (visit.node < 0 || std::size_t(visit.node) >= mModel.nodes.size())
                refuse(mPath, "a node does not exist");
            if (!seen.insert(visit.node).second || seen.size() > kMostNodes)
                refuse(mPath, "its nodes are not a tree");
            const tinygltf::Node& node = mModel.nodes[std::size_t(visit.node)];
            const Affine matrix = multiplied(visit.matrix, matrixOf(node));
            if (node.mesh >= 0) readMesh(node.mesh, matrix);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.push_back({*child, matrix});
        }
        return finished();
    }

private:
    std::vector<int> rootNodes() const {
        std::set<int> children;
        for (const tinygltf::Node& node : mModel.nodes)
            children.insert(node.children.begin(), node.children.end());
        std::vector<int> roots;
        for (std::size_t i = 0; i < mModel.nodes.size(); ++i)
            if (!children.count(int(i))) roots.push_back(int(i));
        return roots;
    }

    template <typename T>
    const T& at(const std::vector<T>& list, int index, const char* what) const {
        if (index < 0 || std::size_t(index) >= list.size())
            refuse(mPath, std::string(what) + " does not exist");
        return list[std::size_t(index)];
    }

    // `count` elements of a view, each `width` numbers, with checks against the buffer.
    void readView(int viewIndex, std::size_t offset, int componentType, std::size_t count, std::size_t width,
                  std::vector<double>& out) const {
        const tinygltf::BufferView& view = at(mModel.bufferViews, viewIndex, "a buffer view");
        const std::vector<unsigned char>& bytes = at(mModel.buffers, view.buffer, "a buffer").data;
        const std::size_t number =
            std::size_t(std::max(0, tinygltf::GetComponentSizeInBytes(std::uint32_t(componentType))));
        if (number == 0 || componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE)
            refuse(mPath, "an accessor's component type is not one of glTF's");
        const std::size_t element = number * width, stride = view.byteStride > 0 ? view.byteStride : element;
        const bool inside = view.byteOffset <= bytes.size() &&
                            view.byteLength <= bytes.size() - view.byteOffset && offset <= view.byteLength &&
                            element <= view.byteLength - offset &&
                            (count == 0 || (count - 1) <= (view.byteLength - offset - element) / stride);
        if (!inside && count > 0)
            refuse(mPath, "an accessor reaches beyond its buffer; the file is truncated");
        out.reserve(count * width);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < width; ++c)
                out.push_back(numberAt(bytes.data() + view.byteOffset + offset + i * stride + c * number,
                                       componentType));
    }

    std::vector<double> readAccessor(int index, std::size_t& width, std::size_t& count) const {
        const tinygltf::Accessor& accessor = at(mModel.accessors, index, "an accessor");
        const int components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
        if (components < 1 || components > 4) refuse(mPath, "an accessor's type is not a scalar or vector");
        width = std::size_t(components);
        count = accessor.count;
        std::size_t most = 0;
        for (const tinygltf::Buffer& buffer : mModel.buffers) most += buffer.data.size();
        if (count > most)
            refuse(mPath, "an accessor has more elements than its buffers bytes; the file is truncated");
        std::vector<double> values;
        if (accessor.bufferView >= 0)
            readView(accessor.bufferView, accessor.byteOffset, accessor.componentType, count, width, values);
        else
            values.assign(count * width, 0.0);
        if (accessor.sparse.isSparse) applySparse(accessor, width, values);
        const double white = accessor.normalized ? whiteOf(accessor.componentType) : 0;
        if (white > 0)
            for (double& value : values) value = std::max(-1.0, value / white);
        return values;
    }

    void applySparse(const tinygltf::Accessor& accessor, std::size_t width,
                     std::vector<double>& values) const {
        const auto& sparse = accessor.sparse;
        if (sparse.count < 0) refuse(mPath, "a sparse accessor has a negative count");
        std::vector<double> indices, replaced;
        const std::size_t count = std::size_t(sparse.count);
        readView(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset),
                 sparse.indices.componentType, count, 1, indices);
        readView(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), accessor.componentType,
                 count, width, replaced);
        for (std::size_t i = 0; i < count; ++i) {
            if (!(indices[i] >= 0) || indices[i] >= double(accessor.count))
                refuse(mPath, "a sparse accessor replaces an element that does not exist");
            const std::size_t row = std::size_t(indices[i]);
            std::copy_n(replaced.begin() + std::ptrdiff_t(i * width), width,
                        values.begin() + std::ptrdiff_t(row * width));
        }
    }

    void readMesh(int index, const Affine& matrix) {
        const bool mirrored = determinant(matrix) < 0;
        for (const tinygltf::Primitive& primitive : at(mModel.meshes, index, "a mesh").primitives) {
            const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
            if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
                mode != TINYGLTF_MODE_TRIANGLE_FAN)
                continue;
            const auto position = primitive.attributes.find("POSITION");
            if (position == primitive.attributes.end()) continue;
            std::size_t width = 0, count = 0;
            const std::vector<double> places = readAccessor(position->second, width, count);
            if (width != 3) refuse(mPath, "positions are not vectors of three");
            const std::size_t first = mMesh.points.size();
            if (first + count > 0xfffffffeu) refuse(mPath, "has over four billion vertices");
            for (std::size_t i = 0; i < count; ++i) {
                mMesh.points.push_back(
                    transformed(matrix, {places[3 * i], places[3 * i + 1], places[3 * i + 2]}));
            }
            readAttributes(primitive, first, count);
            std::vector<double> corners;
            if (primitive.indices >= 0) {
                std::size_t indices = 0;
                corners = readAccessor(primitive.indices, width, indices);
                if (width != 1) refuse(mPath, "indices are not whole numbers");
            } else {
                for (std::size_t i = 0; i < count; ++i) corners.push_back(double(i));
            }
            appendFaces(mode, corners, first, count, mirrored);
        }
    }

    void appendFaces(int mode, const std::vector<double>& corners, std::size_t first, std::size_t count,
                     bool mirrored) {
        for (double corner : corners)
            if (!(corner >= 0) || corner >= double(count) || corner != std::floor(corner))
                refuse(mPath, "a face uses a vertex that does not exist");
        const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
        for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
            const auto corner = [&](std::size_t k) {
                return std::uint32_t(first) + std::uint32_t(corners[k]);
            };
            Triangle t{corner(i), corner(i + 1), corner(i + 2)};
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN) t = {corner(0), corner(i + 1), corner(i + 2)};
            if ((mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1) != mirrored) std::swap(t[0], t[1]);
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mMesh.polygons.add(t.data(), 3);
        }
    }

    // COLOR_0 is Cd (and Alpha), TEXCOORD_0 uv with v upwards as other formats have it, _NAME is NAME.
    void readAttributes(const tinygltf::Primitive& primitive, std::size_t first, std::size_t count) {
        for (const auto& [name, index] : primitive.attributes) {
            const bool colour = name == "COLOR_0", texture = name == "TEXCOORD_0";
            if (!colour && !texture && (name.size() < 2 || name[0] != '_')) continue;
            std::size_t width = 0, rows = 0;
            const std::vector<double> values = readAccessor(index, width, rows);
            if (rows != count)
                refuse(mPath, name + " has " + std::to_string(rows) + " values for " + std::to_string(count) +
                                  " vertices");
            if (colour && width >= 3) {
                store("Cd", 3, 1, values, width, 0, first);
                if (width == 4) store("Alpha", 1, 1, values, width, 3, first);
            } else if (texture && width == 2) {
                std::vector<double> flipped = values;
                for (std::size_t i = 1; i < flipped.size(); i += 2) flipped[i] = 1 - flipped[i];
                store("uv", 2, 0, flipped, width, 0, first);
            } else if (name[0] == '_' && width <= 3) {
                store(name.substr(1), width, 0, values, width, 0, first);
            }
        }
    }

    // Stores values for the vertices from `first` on; other vertices of the file have `missing`.
    void store(const std::string& name, std::size_t width, float missing, const std::vector<double>& values,
               std::size_t stride, std::size_t column, std::size_t first) {
        Attribute& attribute = mAttributes.try_emplace(name, Attribute{name, width, {}}).first->second;
        if (attribute.width != width) return;
        mMissing[name] = missing;
        attribute.values.resize(first * width, missing);
        for (std::size_t i = 0; i * stride < values.size(); ++i)
            for (std::size_t c = 0; c < width; ++c) {
                const float value = float(values[i * stride + column + c]);
                attribute.values.push_back(std::isfinite(value) ? value : 0.f);
            }
    }

    MeshContent finished() {
        for (auto& [name, attribute] : mAttributes) {
            attribute.values.resize(mMesh.points.size() * attribute.width, mMissing[name]);
            mMesh.attributes.push_back(std::move(attribute));
        }
        return std::move(mMesh);
    }

    const std::string& mPath;
    const tinygltf::Model& mModel;
    MeshContent mMesh;
    std::map<std::string, Attribute> mAttributes;
    std::map<std::string, float> mMissing;
};

bool skipImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
               void*) {
    return true;
}

// The folder that URIs are read from, and why the last one was not. tinygltf looks up a URI below the given
// folder, then in the working directory, where a file of that name would be another one. So the given folder
// is kMark, which marks the rest of the path as the URI.
struct Folder {
    std::string path, problem{};
};
constexpr const char* kMark = "/";

bool findUri(const std::string& name, void* user) {
    Folder& folder = *static_cast<Folder*>(user);
    if (name.compare(0, 1, kMark) != 0) return false;
    const std::string uri = name.substr(1);
    std::string why, shown = uri.substr(0, 200);
    pathBelow(folder.path, uri, why);
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c >= 0 && c < ' '; }, '?');
    folder.problem = why.empty() ? "" : "its file \"" + shown + "\" " + why;
    return why.empty();
}

bool readUri(std::vector<unsigned char>* out, std::string* problem, const std::string& name, void* user) {
    Folder& folder = *static_cast<Folder*>(user);
    try {
        std::string why, path = pathBelow(folder.path, name.substr(1), why);
        // tinygltf decodes a plus as a space, as in a web form.
        std::string plus = path;
        std::replace(plus.begin(), plus.end(), ' ', '+');
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored) && std::filesystem::exists(plus, ignored)) path = plus;
        const std::string content = readWholeFile(path);
        out->assign(content.begin(), content.end());
        return true;
    } catch (const std::exception& error) {
        *problem = folder.problem = error.what();
        return false;
    }
}

// Buffers in files: only those in or below the glTF file's folder. Images are not read.
tinygltf::FsCallbacks fileAccess(Folder& folder) {
    tinygltf::FsCallbacks files{};
    files.FileExists = findUri;
    files.ExpandFilePath = [](const std::string& name, void*) { return name; };
    files.ReadWholeFile = readUri;
    files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    files.user_data = &folder;
    return files;
}

}  // namespace

MeshContent readGltf(const std::string& path, const std::string& content, const RunContext&) {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(skipImage, nullptr);
    Folder folder{folderOf(path)};
    loader.SetFsCallbacks(fileAccess(folder));
    tinygltf::Model model;
    std::string problem, warning;
    bool good = false;
    if (content.size() > 0xfffffff0u) refuse(path, "is over 4 GB");
    try {
        good = content.compare(0, 4, "glTF") == 0
                   ? loader.LoadBinaryFromMemory(&model, &problem, &warning,
                                                 reinterpret_cast<const unsigned char*>(content.data()),
                                                 unsigned(content.size()), kMark)
                   : loader.LoadASCIIFromString(&model, &problem, &warning, content.data(),
                                                unsigned(content.size()), kMark);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(path, std::string("not a whole glTF file: ") + error.what());
    }
    if (!good && !folder.problem.empty()) refuse(path, folder.problem);
    if (!good) refuse(path, "not a whole glTF file: " + problem.substr(0, problem.find('\n')));
    for (const std::string& extension : model.extensionsRequired)
        if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression")
            refuse(path, "is compressed with " + extension + ", which is not supported; export it without");
    return Reader(path, model).read();
}

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
