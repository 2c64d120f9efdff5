// Extensions of glTF: those that change the shape are read or refused by name.
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <algorithm>
#include <cctype>

namespace vdbsynth {
namespace {

// How surfaces look, what they mean, how they move: none of it changes the shape.
constexpr const char* kHarmlessBeginnings[] = {"KHR_materials_",
                                               "KHR_texture_",
                                               "EXT_texture_",
                                               "MSFT_texture_",
                                               "MSFT_packing_",
                                               "KHR_lights_",
                                               "EXT_lights_",
                                               "KHR_xmp",
                                               "ADOBE_materials_",
                                               "KHR_animation_",
                                               "KHR_audio",
                                               "KHR_techniques_",
                                               "EXT_material_",
                                               "EXT_materials_",
                                               "GOOGLE_texture_",
                                               "FB_material",
                                               "VRM",
                                               "KHR_interactivity",
                                               "KHR_physics",
                                               "OMI_"};
constexpr const char* kHarmless[] = {
    "EXT_mesh_features",        "EXT_instance_features", "EXT_structural_metadata",
    "EXT_feature_metadata",     "EXT_mesh_manifold",     "EXT_mesh_primitive_edge_visibility",
    "CESIUM_primitive_outline", "FB_ngon_encoding",      "KHR_node_hoverability",
    "KHR_node_selectability",   "AGI_articulations",     "AGI_stk_metadata",
    "EXT_property_animation",   "EXT_property_semantics"};
// Their effect is read.
constexpr const char* kHonoured[] = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization",
                                     "MESHOPT_quantized_geometry", "KHR_node_visibility",
                                     "KHR_accessor_float64"};

bool isKnown(const std::string& name) {
    const auto same = [&](const char* other) { return name == other; };
    const auto begins = [&](const char* start) { return name.rfind(start, 0) == 0; };
    return std::any_of(std::begin(kHarmless), std::end(kHarmless), same) ||
           std::any_of(std::begin(kHonoured), std::end(kHonoured), same) ||
           std::any_of(std::begin(kHarmlessBeginnings), std::end(kHarmlessBeginnings), begins);
}

// Draco, meshopt under its names, and any other that says so; not that of textures.
bool isCompression(const std::string& name) {
    if (isKnown(name)) return false;
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return lower.find("compression") != std::string::npos || lower.find("draco") != std::string::npos;
}

std::vector<std::string> namesOf(const GltfFile& file, const GltfJson& root, const char* member) {
    std::vector<std::string> names;
    const GltfJson* list = gltfMember(root, member);
    if (!list) return names;
    if (!list->is_array()) file.refuse("its \"" + std::string(member) + "\" are no list");
    for (const GltfJson& name : *list)
        if (name.is_string()) names.push_back(name.get<std::string>());
    return names;
}

}  // namespace

void refuseGltfCompression(const GltfFile& file, const std::string& extension) {
    file.refuse("is compressed with " + gltfShown(extension) +
                ", which is not supported; export it without, or save it again without compression");
}

std::string gltfCompression(const GltfJson& object) {
    const GltfJson* extensions = gltfMember(object, "extensions");
    if (!extensions || !extensions->is_object()) return "";
    for (const auto& [name, value] : extensions->items())
        if (isCompression(name)) return name;
    return "";
}

void checkGltfExtensions(const GltfFile& file, const GltfJson& root) {
    const std::vector<std::string> required = namesOf(file, root, "extensionsRequired");
    for (const std::string& name : required)
        if (isCompression(name)) refuseGltfCompression(file, name);
    for (const std::string& name : required)
        if (!isKnown(name))
            file.refuse("requires the extension " + gltfShown(name) +
                        ", which is not supported; export it without");
    std::string ignored;
    for (const std::string& name : namesOf(file, root, "extensionsUsed"))
        if (!isKnown(name) && !isCompression(name) && ignored.size() < 300)
            ignored += (ignored.empty() ? "" : ", ") + gltfShown(name);
    if (!ignored.empty()) file.say(MessageLevel::Note, "read without what these extensions add: " + ignored);
}

}  // namespace vdbsynth
