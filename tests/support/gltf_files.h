#pragma once
#include "tests/support/raster_files.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// Small glTF files, member by member, for tests.
namespace vdbsynth::test {

/// A .glb of these chunks; no second one if it is empty.
inline std::string glb(const std::string& json, const std::string& binary, std::uint32_t version = 2) {
    const std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
    std::string bytes = "glTF";
    append(bytes, version);
    append(bytes, std::uint32_t(12 + 8 + padded.size() + (binary.empty() ? 0 : 8 + binary.size())));
    append(bytes, std::uint32_t(padded.size()));
    bytes += "JSON" + padded;
    if (binary.empty()) return bytes;
    append(bytes, std::uint32_t(binary.size()));
    return bytes + "BIN" + std::string(1, '\0') + binary;
}

/// A file whose accessors are added one by one. It begins with a unit cube: accessor 0 is its corners, 1 its
/// triangles, mesh 0 both, node 0 the mesh in scene 0.
class GltfMaker {
public:
    GltfMaker() {
        std::vector<float> corners;
        for (int i = 0; i < 8; ++i)
            for (int axis = 0; axis < 3; ++axis) corners.push_back(float(i >> axis & 1));
        add<float>(corners, "VEC3", 5126);
        add<std::uint8_t>({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                          "SCALAR", 5121);
        json["asset"]["version"] = "2.0";
        json["scene"] = 0;
        json["scenes"] = {{{"nodes", {0}}}};
        json["nodes"] = {{{"mesh", 0}}};
        json["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
    }

    /// @return the index of an accessor of these numbers, in a buffer view of its own
    template <typename T>
    int add(const std::vector<T>& numbers, const std::string& type, int componentType,
            bool normalized = false) {
        const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : std::size_t(type[3] - '0');
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", numbers.size() * sizeof(T)}});
        binary += raw(numbers);
        binary.resize((binary.size() + 3) / 4 * 4);
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", componentType},
                                     {"count", numbers.size() / width},
                                     {"type", type}});
        if (normalized) json["accessors"].back()["normalized"] = true;
        return int(json["accessors"].size()) - 1;
    }

    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }

    std::string bytes() const {
        nlohmann::json whole = json;
        whole["buffers"] = {{{"byteLength", binary.size()}}};
        return glb(whole.dump(), binary);
    }

    nlohmann::json json;
    std::string binary;
};

/// Every kind of thing that moves a vertex: instances, a skin below a scaled node, a sparse morph target.
inline GltfMaker posedGltf() {
    GltfMaker maker;
    const int joints = maker.add<std::uint8_t>(std::vector<std::uint8_t>(32, 0), "VEC4", 5121),
              weights = maker.add<std::uint8_t>(std::vector<std::uint8_t>(32, 255), "VEC4", 5121, true),
              bind = maker.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4", 5126),
              rows = maker.add<std::uint16_t>({7}, "SCALAR", 5123),
              step = maker.add<float>({1, 1, 1}, "VEC3", 5126),
              places = maker.add<float>({0, 0, 0, 4, 0, 0}, "VEC3", 5126),
              turns = maker.add<std::int16_t>({0, 0, 0, 32767, 0, 0, 0, 32767}, "VEC4", 5122, true);
    nlohmann::json& accessors = maker.json["accessors"];
    accessors.push_back(
        {{"componentType", 5126},
         {"count", 8},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 1},
           {"indices", {{"bufferView", accessors[std::size_t(rows)]["bufferView"]}, {"componentType", 5123}}},
           {"values", {{"bufferView", accessors[std::size_t(step)]["bufferView"]}}}}}});
    maker.primitive()["targets"] = {{{"POSITION", accessors.size() - 1}}};
    maker.json["meshes"][0]["weights"] = {0.5};
    maker.json["meshes"].push_back(maker.json["meshes"][0]);
    maker.primitive()["attributes"]["JOINTS_0"] = joints;
    maker.primitive()["attributes"]["WEIGHTS_0"] = weights;
    maker.json["skins"] = {{{"joints", {2}}, {"inverseBindMatrices", bind}}};
    maker.json["nodes"][0]["skin"] = 0;
    maker.json["nodes"].push_back({{"scale", {2, 2, 2}}, {"children", {2}}});
    maker.json["nodes"].push_back({{"translation", {0, 0, 1}}});
    nlohmann::json copies;
    copies["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}, {"ROTATION", turns}};
    maker.json["nodes"].push_back({{"mesh", 1}, {"extensions", copies}});
    maker.json["scenes"][0]["nodes"] = {0, 1, 3};
    return maker;
}

inline GltfMaker pointsGltf() {
    GltfMaker maker;
    maker.primitive() = {{"mode", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 0}}}};
    return maker;
}

}  // namespace vdbsynth::test
