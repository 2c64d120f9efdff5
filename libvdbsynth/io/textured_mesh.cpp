#include "libvdbsynth/io/textured_mesh.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/mesh_check.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/ply_file.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace vdbsynth {
namespace {

std::vector<std::size_t> byMaterial(const TexturedMesh& textured) {
    std::vector<std::size_t> order(textured.mesh.triangles.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return textured.pictures[a] < textured.pictures[b];
    });
    return order;
}

// The triangles of one material, with vertices of their own for corners with other coordinates.
TexturedMesh partOf(const TexturedMesh& from, std::uint32_t material) {
    TexturedMesh part;
    part.mesh.origin = from.mesh.origin;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> numbers;
    std::vector<std::size_t> kept;
    std::vector<float> uv;
    for (std::size_t t = 0; t < from.mesh.triangles.size(); ++t) {
        if (from.pictures[t] != material) continue;
        Triangle made{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = from.mesh.triangles[t][k];
            const Vec2f at = from.corner[3 * t + k];
            const auto [entry, added] = numbers.try_emplace({v, at.x, at.y}, std::uint32_t(kept.size()));
            made[k] = entry->second;
            if (!added) continue;
            kept.push_back(v);
            uv.insert(uv.end(), {at.x, at.y});
        }
        part.mesh.triangles.push_back(made);
        part.pictures.push_back(material);
    }
    for (std::size_t v : kept) {
        part.mesh.points.push_back(from.mesh.points[v]);
        part.normals.push_back(from.normals[v]);
    }
    Attributes& attributes = part.mesh.attributes = selectRows(from.mesh.attributes, kept);
    attributes.erase(std::remove_if(attributes.begin(), attributes.end(),
                                    [](const Attribute& a) { return a.name == "uv"; }),
                     attributes.end());
    attributes.push_back({"uv", 2, std::move(uv)});
    return part;
}

void appendRow(std::string& text, const char* key, const float* values, std::size_t count) {
    text += key;
    for (std::size_t c = 0; c < count; ++c) text += ' ' + exactText(values[c]);
}

std::string vertexRows(const TexturedMesh& textured) {
    constexpr int kDigits = 14;
    const Mesh& mesh = textured.mesh;
    const Attribute* colour = findAttribute(mesh.attributes, "Cd");
    const bool far = length(mesh.origin) > 0;
    std::string text;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (far) {
            text += 'v';
            for (int axis = 0; axis < 3; ++axis)
                text += ' ' + roundedText(mesh.origin[axis] + double(mesh.points[i][axis]), kDigits);
        } else {
            appendRow(text, "v", &mesh.points[i].x, 3);
        }
        if (colour && colour->width == 3) appendRow(text, "", &colour->values[3 * i], 3);
        text += '\n';
    }
    for (const Vec3f& n : textured.normals) {
        appendRow(text, "vn", &n.x, 3);
        text += '\n';
    }
    return text;
}

}  // namespace

void writeTexturedGltf(const std::string& path, bool binary, const TexturedMesh& textured) {
    requireMesh(textured.mesh, path);
    std::vector<TexturedMesh> parts;
    for (std::uint32_t material = 0; material < textured.materials.size(); ++material) {
        parts.push_back(partOf(textured, material));
        if (parts.back().pictures.empty()) parts.pop_back();
    }
    writeWholeFile(path, texturedGltfBytes(parts, textured.materials, binary));
}

void writeTexturedObj(const std::string& path, const TexturedMesh& textured) {
    requireMesh(textured.mesh, path);
    std::string text = "# vdb_synth\n";
    for (const std::string& comment : textured.comments) text += "# " + comment + '\n';
    text += vertexRows(textured);
    std::map<std::pair<float, float>, std::size_t> numbers;
    std::string faces;
    const std::vector<std::size_t> order = byMaterial(textured);
    for (std::size_t n = 0; n < order.size(); ++n) {
        const std::size_t t = order[n];
        if (n == 0 || textured.pictures[t] != textured.pictures[order[n - 1]])
            faces += "usemtl " + textured.materials[textured.pictures[t]].name + '\n';
        faces += 'f';
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2f at = textured.corner[3 * t + k];
            const auto [entry, added] = numbers.try_emplace({at.x, at.y}, numbers.size() + 1);
            if (added) text += "vt " + exactText(at.x) + ' ' + exactText(at.y) + '\n';
            const std::string v = std::to_string(textured.mesh.triangles[t][k] + 1);
            faces += ' ' + v + '/' + std::to_string(entry->second) + '/' + v;
        }
        faces += '\n';
    }
    writeWholeFile(path, text + faces);
}

std::vector<std::string> plyComments(const std::string& path) {
    return plyCommentsIn(readWholeFile(path));
}

}  // namespace vdbsynth
