// Properties of 3MF's materials: base materials and colours; what else there is has no colour here.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/readers/mesh_readers_3mf_steps.h"

namespace vdbsynth {
namespace {

int digitOf(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

// "#RRGGBB" or "#RRGGBBAA", sRGB. @return its number in the palette, -1 if it is no colour
std::int32_t colourOf(ThreemfPackage& package, std::string_view text) {
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return -1;
    std::uint32_t rgba = 0;
    for (char c : text.substr(1)) {
        const int digit = digitOf(c);
        if (digit < 0) return -1;
        rgba = rgba << 4 | std::uint32_t(digit);
    }
    return package.palette.add(text.size() == 7 ? rgba << 8 | 0xff : rgba);
}

ThreemfGroup coloursOf(ThreemfPackage& package, pugi::xml_node group, const char* element,
                       const char* value) {
    ThreemfGroup result;
    for (pugi::xml_node node : group.children())
        if (threemfLocal(node.name()) == element)
            result.colours.push_back(colourOf(package, threemfText(node, value)));
    return result;
}

std::vector<std::uint32_t> numbersOf(std::string_view text) {
    std::vector<std::uint32_t> numbers;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n", at)) != text.npos;) {
        const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
        int value = 0;
        numbers.push_back(parseWhole(text.substr(at, end - at), value) && value >= 0 ? std::uint32_t(value)
                                                                                     : 0xffffffff);
        at = end;
    }
    return numbers;
}

// Of several properties at once the first with colours is taken. A missing index is 0.
ThreemfGroup multipleOf(const ThreemfGroups& groups, pugi::xml_node node) {
    ThreemfGroup result;
    result.kind = ThreemfGroup::Kind::Mixed;
    const std::vector<std::uint32_t> layers = numbersOf(threemfText(node, "pids"));
    std::size_t layer = 0;
    const ThreemfGroup* colours = nullptr;
    for (; layer < layers.size() && !colours; ++layer) {
        const auto found = groups.find(layers[layer]);
        if (found != groups.end() && found->second.kind == ThreemfGroup::Kind::Colours)
            colours = &found->second;
    }
    for (pugi::xml_node multi : node.children()) {
        if (threemfLocal(multi.name()) != "multi") continue;
        const std::vector<std::uint32_t> indices = numbersOf(threemfText(multi, "pindices"));
        const std::size_t index = layer <= indices.size() && layer > 0 ? indices[layer - 1] : 0;
        result.colours.push_back(colours && index < colours->colours.size() ? colours->colours[index] : -1);
    }
    return result;
}

}  // namespace

ThreemfGroups threemfGroups(ThreemfPackage& package, pugi::xml_node resources) {
    ThreemfGroups groups;
    for (pugi::xml_node node : resources.children()) {
        const std::string_view name = threemfLocal(node.name());
        ThreemfGroup group;
        if (name == "basematerials")
            group = coloursOf(package, node, "base", "displaycolor");
        else if (name == "colorgroup")
            group = coloursOf(package, node, "color", "color");
        else if (name == "texture2dgroup")
            group.kind = ThreemfGroup::Kind::Texture;
        else if (name == "compositematerials")
            group.kind = ThreemfGroup::Kind::Mixed;
        else if (name == "multiproperties")
            group = multipleOf(groups, node);
        else
            continue;
        const std::optional<std::uint32_t> id = threemfWhole(package, node, "id");
        if (!id || !groups.emplace(*id, std::move(group)).second)
            package.refuse("two of its resources have one id, or one has none");
    }
    return groups;
}

}  // namespace vdbsynth
