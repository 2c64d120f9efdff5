// Attributes of the vertices of glTF primitives.
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <cmath>

namespace vdbsynth {
namespace {

float missingOf(const std::string& name) {
    return name == "Cd" || name == "Alpha" ? 1.f : 0.f;
}

// `width` columns of the values, from `column` on.
Attribute columnsOf(const std::string& name, const GltfValues& values, std::size_t column,
                    std::size_t width) {
    Attribute attribute{name, width, {}};
    attribute.values.reserve(values.count * width);
    for (std::size_t i = 0; i < values.count; ++i)
        for (std::size_t c = 0; c < width; ++c) {
            const float value = float(values.numbers[i * values.width + column + c]);
            attribute.values.push_back(std::isfinite(value) ? value : 0.f);
        }
    return attribute;
}

}  // namespace

Attributes GltfAttributes::read(const GltfFile& file, const GltfJson& primitive, std::size_t count) const {
    Attributes result;
    const GltfJson* attributes = gltfMember(primitive, "attributes");
    if (!attributes || !attributes->is_object()) return result;
    requireMemory(file.context(), 24.0 * double(attributes->size()) * double(count),
                  file.path() + ": its attributes", "export fewer of them");
    for (const auto& [name, index] : attributes->items()) {
        const bool colour = name == "COLOR_0", texture = name == "TEXCOORD_0";
        if (!colour && !texture && (name.size() < 2 || name[0] != '_')) continue;
        const std::int64_t accessor = file.index(*attributes, name.c_str());
        if (accessor < 0) continue;
        GltfValues values = gltfValues(file, accessor);
        if (values.count != count)
            file.refuse(gltfShown(name) + " has " + std::to_string(values.count) + " values for " +
                        std::to_string(count) + " vertices");
        if (colour && (values.width == 3 || values.width == 4)) {
            result.push_back(columnsOf("Cd", values, 0, 3));
            if (values.width == 4) result.push_back(columnsOf("Alpha", values, 3, 1));
        } else if (texture && values.width == 2) {
            for (std::size_t i = 1; i < values.numbers.size(); i += 2)
                values.numbers[i] = 1 - values.numbers[i];
            result.push_back(columnsOf("uv", values, 0, 2));
        } else if (name[0] == '_' && values.width <= 3) {
            result.push_back(columnsOf(name.substr(1), values, 0, values.width));
        }
    }
    return result;
}

void GltfAttributes::append(const Attributes& values, std::size_t first) {
    for (const Attribute& added : values) {
        const std::size_t width = added.width;
        Attribute& all = mAttributes.try_emplace(added.name, Attribute{added.name, width, {}}).first->second;
        if (all.width != width) continue;
        all.values.resize(first * width, missingOf(added.name));
        all.values.insert(all.values.end(), added.values.begin(), added.values.end());
    }
}

Attributes GltfAttributes::finished(std::size_t count) {
    Attributes result;
    for (auto& [name, attribute] : mAttributes) {
        attribute.values.resize(count * attribute.width, missingOf(name));
        result.push_back(std::move(attribute));
    }
    return result;
}

}  // namespace vdbsynth
