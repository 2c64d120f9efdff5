// The package of a 3MF file: which part is its model, and what slicers add.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/mesh_readers_3mf_steps.h"

#include <algorithm>

namespace vdbsynth {
namespace {

const char* const kModelType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

bool endsIn(const std::string& name, const std::string& end) {
    return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

bool isNegative(std::string_view kind) {
    return kind == "NegativeVolume" || kind == "negative_part";
}

}  // namespace

std::int32_t ThreemfPalette::add(std::uint32_t rgba) {
    const auto [at, fresh] = mPlaces.try_emplace(rgba, std::int32_t(mColours.size()));
    if (fresh) mColours.push_back(rgba);
    return at->second;
}

std::string threemfKey(std::string_view name) {
    std::string key(name.substr(std::min(name.find_first_not_of('/'), name.size())));
    for (char& c : key)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return key;
}

std::string_view threemfLocal(const char* name) {
    const std::string_view all(name);
    const std::size_t colon = all.rfind(':');
    return colon == std::string_view::npos ? all : all.substr(colon + 1);
}

pugi::xml_node threemfChild(pugi::xml_node node, std::string_view name) {
    for (pugi::xml_node child : node.children())
        if (threemfLocal(child.name()) == name) return child;
    return {};
}

std::string_view threemfText(pugi::xml_node node, std::string_view name) {
    for (pugi::xml_attribute attribute : node.attributes())
        if (threemfLocal(attribute.name()) == name) return attribute.value();
    return {};
}

std::optional<std::uint32_t> threemfWhole(const ThreemfPackage& package, pugi::xml_node node,
                                          std::string_view name) {
    const std::string_view text = threemfText(node, name);
    if (text.empty()) return std::nullopt;
    int value = 0;
    if (!parseWhole(text, value) || value < 0)
        package.refuse("`" + std::string(name) + "` of an element " + printableText(node.name(), 40) +
                       " is no whole number: " + printableText(text, 40));
    return std::uint32_t(value);
}

ThreemfPackage::ThreemfPackage(const std::string& path, const std::string& content, const RunContext& ctx)
    : mPath(path), mContext(ctx), mZip(path, content) {
    mRoot = rootName();
    ThreemfModifiers modifiers;
    for (const char* name : {"Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"}) {
        ThreemfXml config;
        if (parse(name, config)) addThreemfModifiers(threemfChild(config.document, "config"), modifiers);
    }
    takeOutModifiers(*this, modifiers, model(mRoot));
}

void ThreemfPackage::refuse(const std::string& what) const {
    throw Error(ErrorCode::BadData, mPath + ": " + what);
}

void ThreemfPackage::say(MessageLevel level, const std::string& what) const {
    message(mContext, level, mPath + ": " + what);
}

// @return false if there is no such entry
bool ThreemfPackage::parse(const std::string& name, ThreemfXml& xml) {
    const ZipFile::Entry* entry = mZip.find(name);
    if (!entry) return false;
    const std::string shown = printableText(entry->name, 200);
    xml.text = mZip.read(*entry, mContext);
    // The text of numbers, and a tree of it.
    requireMemory(mContext, double(xml.text.size()) * 6, mPath + " (" + shown + ")",
                  "export fewer triangles, or another format");
    const pugi::xml_parse_result result = xml.document.load_buffer_inplace(
        xml.text.data(), xml.text.size(), pugi::parse_minimal | pugi::parse_escapes);
    if (result.status == pugi::status_out_of_memory)
        throw Error(ErrorCode::Memory, mPath + " (" + shown + "): out of memory");
    if (!result)
        refuse("the XML of " + shown + " is truncated or corrupt at byte " + std::to_string(result.offset) +
               " (" + result.description() + ")");
    return true;
}

std::string ThreemfPackage::rootName() {
    ThreemfXml relations;
    if (parse("_rels/.rels", relations))
        for (pugi::xml_node node : threemfChild(relations.document, "Relationships").children())
            if (threemfText(node, "Type") == kModelType && mZip.find(threemfKey(threemfText(node, "Target"))))
                return threemfKey(threemfText(node, "Target"));
    std::string found = mZip.find("3D/3dmodel.model") ? "3D/3dmodel.model" : "";
    for (const ZipFile::Entry& entry : mZip.entries())
        if (found.empty() && endsIn(entry.name, ".model")) found = entry.name;
    if (found.empty()) refuse("holds no 3D model; it may be a package of another kind");
    say(MessageLevel::Note,
        "does not say which part is its model; " + printableText(found, 200) + " is read");
    return threemfKey(found);
}

ThreemfModel& ThreemfPackage::model(const std::string& name) {
    const std::string part = threemfKey(name);
    const auto known = mModels.find(part);
    if (known != mModels.end()) return known->second;
    ThreemfXml xml;
    if (!parse(part, xml))
        refuse("refers to " + printableText(part, 200) + ", which the package does not hold");
    const pugi::xml_node element = threemfChild(xml.document, "model");
    if (!element) refuse(printableText(part, 200) + " is no 3D model");
    return mModels.emplace(part, threemfModel(*this, element)).first->second;
}

void addThreemfModifiers(pugi::xml_node config, ThreemfModifiers& modifiers) {
    const auto whole = [](pugi::xml_node node, const char* name) {
        return std::uint32_t(std::max(0, node.attribute(name).as_int(0)));
    };
    for (pugi::xml_node object : config.children("object")) {
        const std::uint32_t id = whole(object, "id");
        for (pugi::xml_node volume : object.children("volume")) {
            std::string_view kind = "ModelPart";
            for (pugi::xml_node data : volume.children("metadata"))
                if (threemfText(data, "key") == "volume_type") kind = threemfText(data, "value");
            if (kind != "ModelPart" && !kind.empty())
                modifiers.ranges[id].push_back(
                    {whole(volume, "firstid"), whole(volume, "lastid"), isNegative(kind)});
        }
        for (pugi::xml_node part : object.children("part")) {
            const std::string_view kind = threemfText(part, "subtype");
            if (kind != "normal_part" && !kind.empty())
                modifiers.components[{id, whole(part, "id")}] = isNegative(kind);
        }
    }
}

void takeOutModifiers(ThreemfPackage& package, const ThreemfModifiers& modifiers, ThreemfModel& root) {
    const auto count = [&](bool negative) {
        ++(negative ? package.counts.negatives : package.counts.modifiers);
    };
    for (auto& [id, object] : root.objects) {
        std::vector<ThreemfPlace> kept;
        for (const ThreemfPlace& part : object.components) {
            const auto found = modifiers.components.find({id, part.object});
            if (found == modifiers.components.end())
                kept.push_back(part);
            else
                count(found->second);
        }
        object.components = std::move(kept);
        const auto ranges = modifiers.ranges.find(id);
        if (ranges == modifiers.ranges.end()) continue;
        std::vector<char> out(object.corners.size() / 3, 0);
        for (const ThreemfModifiers::Range& range : ranges->second) {
            if (range.first < out.size()) count(range.negative);
            for (std::uint64_t t = range.first; t <= range.last && t < out.size(); ++t) out[t] = 1;
        }
        std::size_t next = 0;
        for (std::size_t i = 0; i < object.corners.size(); ++i) {
            if (out[i / 3]) continue;
            object.corners[next] = object.corners[i];
            if (!object.colours.empty()) object.colours[next] = object.colours[i];
            ++next;
        }
        object.corners.resize(next);
        if (!object.colours.empty()) object.colours.resize(next);
    }
}

}  // namespace vdbsynth
