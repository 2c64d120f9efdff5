// A model part of a 3MF package: units, objects, what is built. Core specification 1.3, materials 1.2,
// production 1.1.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/mesh_readers_3mf_steps.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first);
}

// Extensions that change nothing of the mesh that is read; by the middle of their namespaces.
bool isReadExtension(std::string_view address) {
    for (const char* known : {"3dmanufacturing/core/", "3dmanufacturing/material/",
                              "3dmanufacturing/production/", "3dmanufacturing/slice/", "/trianglesets/"})
        if (address.find(known) != address.npos) return true;
    return false;
}

void requireExtensions(const ThreemfPackage& package, pugi::xml_node model) {
    const std::string_view required = threemfText(model, "requiredextensions");
    for (std::size_t at = 0; (at = required.find_first_not_of(" \t\r\n", at)) != required.npos;) {
        const std::size_t end = std::min(required.find_first_of(" \t\r\n", at), required.size());
        const std::string prefix(required.substr(at, end - at));
        const std::string address = model.attribute(("xmlns:" + prefix).c_str()).value();
        if (!isReadExtension(address))
            package.refuse("requires the extension " +
                           printableText(address.empty() ? prefix : address, 200) +
                           ", which is not read; export it as a plain mesh");
        at = end;
    }
}

// Twelve numbers, row by row, of rows that are multiplied from the left: the columns of an Affine.
Affine placeOf(const ThreemfPackage& package, pugi::xml_node node) {
    Affine place = kIdentity;
    const std::string_view text = threemfText(node, "transform");
    if (trimmed(text).empty()) return place;
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n", at)) != text.npos; ++count) {
        const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
        double value = 0;
        if (count >= 12 || !parseReal(text.substr(at, end - at), value)) break;
        place[count / 3 * 4 + count % 3] = value;
        at = end;
        if (count == 11 && text.find_first_not_of(" \t\r\n", at) == text.npos) return place;
    }
    package.refuse("a transform is not twelve finite numbers: " + printableText(text, 120));
}

ThreemfPlace placedOf(const ThreemfPackage& package, pugi::xml_node node) {
    ThreemfPlace placed;
    placed.model = threemfText(node, "path");
    const std::optional<std::uint32_t> object = threemfWhole(package, node, "objectid");
    if (!object) package.refuse("an item or a component names no object");
    placed.object = *object;
    placed.place = placeOf(package, node);
    return placed;
}

// Reads the mesh of one object.
class MeshReader {
public:
    MeshReader(ThreemfPackage& package, const ThreemfGroups& groups, pugi::xml_node object,
               ThreemfObject& result)
        : mPackage(package), mGroups(groups), mObject(result) {
        mGroup = threemfWhole(package, object, "pid").value_or(kNone);
        mIndex = threemfWhole(package, object, "pindex").value_or(kNone);
    }

    void read(pugi::xml_node mesh) {
        for (pugi::xml_node node : threemfChild(mesh, "vertices").children()) readVertex(node);
        for (pugi::xml_node node : threemfChild(mesh, "triangles").children()) readTriangle(node);
        for (pugi::xml_node node : threemfChild(threemfChild(mesh, "beamlattice"), "beams").children())
            mPackage.counts.beams += threemfLocal(node.name()) == "beam";
    }

private:
    void readVertex(pugi::xml_node node) {
        if (threemfLocal(node.name()) != "vertex") return;
        Vec3d p;
        int found = 0;
        for (pugi::xml_attribute attribute : node.attributes()) {
            const char axis = attribute.name()[0];
            if (axis < 'x' || axis > 'z' || attribute.name()[1] != 0) continue;
            double value = 0;
            if (!parseReal(trimmed(attribute.value()), value))
                mPackage.refuse("a vertex has a coordinate that is no finite number: " +
                                printableText(attribute.value(), 40));
            p[axis - 'x'] = value;
            found |= 1 << (axis - 'x');
        }
        if (found != 7) mPackage.refuse("a vertex lacks a coordinate");
        mObject.points.push_back(p);
    }

    std::uint32_t wholeOf(const char* text) const {
        int value = 0;
        if (!parseWhole(trimmed(text), value) || value < 0)
            mPackage.refuse("a triangle has an index that is no whole number: " + printableText(text, 40));
        return std::uint32_t(value);
    }

    void readTriangle(pugi::xml_node node) {
        if (threemfLocal(node.name()) != "triangle") return;
        std::uint32_t v[3] = {kNone, kNone, kNone}, p[3] = {kNone, kNone, kNone}, group = kNone;
        for (pugi::xml_attribute attribute : node.attributes()) {
            const std::string_view name(attribute.name());
            if (name.size() == 2 && name[1] >= '1' && name[1] <= '3' && (name[0] == 'v' || name[0] == 'p'))
                (name[0] == 'v' ? v : p)[name[1] - '1'] = wholeOf(attribute.value());
            else if (name == "pid")
                group = wholeOf(attribute.value());
            else if (name == "paint_color" || threemfLocal(attribute.name()) == "mmu_segmentation")
                ++mPackage.counts.painted;
        }
        for (std::uint32_t corner : v)
            if (corner >= mObject.points.size())
                mPackage.refuse(corner == kNone ? "a triangle lacks a corner"
                                                : "a triangle uses vertex " + std::to_string(corner) +
                                                      " of " + std::to_string(mObject.points.size()) +
                                                      " of its object (counting from 0)");
        // Kept for now: slicers count triangles.
        mObject.corners.insert(mObject.corners.end(), v, v + 3);
        if (group == kNone) group = mGroup;
        if (p[0] == kNone) p[0] = mIndex;
        for (std::size_t k = 1; k < 3; ++k)
            if (p[k] == kNone) p[k] = p[0];
        colour(group, p);
    }

    void colour(std::uint32_t id, const std::uint32_t* indices) {
        std::int32_t colours[3] = {-1, -1, -1};
        if (id != kNone) {
            if (id != mLastId) {
                const auto found = mGroups.find(id);
                mLast = found == mGroups.end() ? nullptr : &found->second;
                mLastId = id;
            }
            if (mLast && mLast->kind != ThreemfGroup::Kind::Colours)
                ++(mLast->kind == ThreemfGroup::Kind::Texture ? mPackage.counts.textured
                                                              : mPackage.counts.mixed);
            bool known = mLast != nullptr;
            for (std::size_t k = 0; mLast && k < 3; ++k) {
                if (indices[k] < mLast->colours.size()) colours[k] = mLast->colours[indices[k]];
                known = known && (colours[k] >= 0 || mLast->kind != ThreemfGroup::Kind::Colours);
            }
            mPackage.counts.unknownColours += !known;
        }
        if (mObject.colours.empty() && colours[0] < 0 && colours[1] < 0 && colours[2] < 0) return;
        mObject.colours.resize(mObject.corners.size() - 3, -1);
        mObject.colours.insert(mObject.colours.end(), colours, colours + 3);
    }

    ThreemfPackage& mPackage;
    const ThreemfGroups& mGroups;
    ThreemfObject& mObject;
    std::uint32_t mGroup, mIndex, mLastId = kNone;
    const ThreemfGroup* mLast = nullptr;
};

ThreemfType typeOf(std::string_view type) {
    if (type == "support" || type == "solidsupport") return ThreemfType::Support;
    return type == "other" ? ThreemfType::Other : ThreemfType::Solid;
}

ThreemfObject objectOf(ThreemfPackage& package, const ThreemfGroups& groups, pugi::xml_node node) {
    ThreemfObject object;
    object.type = typeOf(threemfText(node, "type"));
    const pugi::xml_node mesh = threemfChild(node, "mesh"), components = threemfChild(node, "components");
    if (mesh) MeshReader(package, groups, node, object).read(mesh);
    if (!object.colours.empty()) object.colours.resize(object.corners.size(), -1);
    for (pugi::xml_node component : components.children())
        if (threemfLocal(component.name()) == "component")
            object.components.push_back(placedOf(package, component));
    package.counts.shapeless += !mesh && !components;
    package.counts.sliced += !threemfText(node, "slicestackid").empty();
    throwIfCancelled(package.context());
    return object;
}

}  // namespace

ThreemfModel threemfModel(ThreemfPackage& package, pugi::xml_node model) {
    requireExtensions(package, model);
    ThreemfModel result;
    result.unit = threemfText(model, "unit");
    const pugi::xml_node resources = threemfChild(model, "resources");
    const ThreemfGroups groups = threemfGroups(package, resources);
    for (pugi::xml_node node : resources.children()) {
        if (threemfLocal(node.name()) != "object") continue;
        const std::optional<std::uint32_t> id = threemfWhole(package, node, "id");
        if (!id) package.refuse("an object has no id");
        if (!result.objects.emplace(*id, objectOf(package, groups, node)).second)
            package.refuse("two objects have the id " + std::to_string(*id));
    }
    for (pugi::xml_node node : threemfChild(model, "build").children())
        if (threemfLocal(node.name()) == "item") result.items.push_back(placedOf(package, node));
    return result;
}

}  // namespace vdbsynth
