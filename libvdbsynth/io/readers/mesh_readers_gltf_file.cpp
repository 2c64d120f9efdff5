// The JSON of a glTF file: its container, its version, and members with their checks.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

[[noreturn]] void refuseFile(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::BadData, path + ": " + what);
}

std::uint32_t wordAt(const std::string& content, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, content.data() + at, 4);
    return word;
}

[[noreturn]] void refuseVersion(const std::string& path, const std::string& version) {
    refuseFile(path, "glTF " + version + " is not read; convert it to 2.0, or export it again as glTF 2.0");
}

// JSON is UTF-8; names by old exporters may not be.
GltfJson parsed(const std::string& path, std::string_view text, bool& replaced) {
    const auto parse = [](std::string_view json) {
        return GltfJson::parse(json.begin(), json.end(), nullptr, true, /* ignore_comments= */ true);
    };
    try {
        return parse(text);
    } catch (const GltfJson::exception&) {
    }
    std::string ascii(text);
    std::replace_if(
        ascii.begin(), ascii.end(), [](unsigned char c) { return c >= 128; }, '?');
    replaced = ascii != text;
    try {
        return parse(ascii);
    } catch (const GltfJson::parse_error& error) {
        refuseFile(path, "not a whole glTF file: its JSON is invalid or cut off at byte " +
                             std::to_string(error.byte) + " of " + std::to_string(text.size()));
    } catch (const GltfJson::exception&) {
        refuseFile(path, "not a whole glTF file: its JSON has a number that is too large");
    }
}

// The version as text: "2.0", or 2.0 by careless writers. Empty if there is none.
std::string versionOf(const GltfJson& asset, const char* name) {
    const GltfJson* version = gltfMember(asset, name);
    if (!version) return "";
    if (version->is_number())
        return std::to_string(int(std::clamp(version->get<double>(), 0.0, 99.0))) + ".0";
    return version->is_string() ? gltfShown(version->get<std::string>()) : "";
}

void checkVersion(const GltfFile& file, const std::string& path, const GltfJson& root) {
    if (!root.is_object()) refuseFile(path, "not a whole glTF file: its JSON is no object");
    const GltfJson* asset = gltfMember(root, "asset");
    const GltfJson none = GltfJson::object();
    const std::string version = versionOf(asset ? *asset : none, "version"),
                      least = versionOf(asset ? *asset : none, "minVersion");
    const auto major = [](const std::string& text) { return text.substr(0, text.find('.')); };
    const GltfJson *meshes = gltfMember(root, "meshes"), *accessors = gltfMember(root, "accessors");
    // Version 1 has objects where version 2 has arrays.
    if (major(version) == "1" || (meshes && meshes->is_object()) || (accessors && accessors->is_object()))
        refuseVersion(path, "1.0");
    if (version.empty()) {
        if (!meshes || !accessors) refuseFile(path, "not a whole glTF file: it names no version of glTF");
        file.say(MessageLevel::Note, "names no version of glTF; read as 2.0");
    } else if (major(version) != "2") {
        refuseVersion(path, version);
    }
    if (!least.empty() && least != "2" && least != "2.0") refuseVersion(path, least);
}

// The first chunk of a kind at `at` or, for writers that count no padding, at the next multiple of four.
std::size_t chunkAt(const std::string& content, std::size_t at) {
    const std::size_t padded = (at + 3) / 4 * 4;
    const auto isBinary = [&](std::size_t place) {
        return place + 8 <= content.size() && wordAt(content, place + 4) == kBinaryChunk;
    };
    return !isBinary(at) && isBinary(padded) ? padded : at;
}

}  // namespace

GltfChunks gltfChunks(const std::string& path, const std::string& content) {
    GltfChunks chunks;
    if (content.compare(0, 4, "glTF") != 0) {
        chunks.json = content;
        return chunks;
    }
    if (content.size() < 20) refuseFile(path, "not a whole glTF file: it is cut off in its header");
    const std::uint32_t version = wordAt(content, 4);
    if (version != 2) refuseVersion(path, std::to_string(version) + ".0 (binary)");
    const std::size_t length = wordAt(content, 12);
    if (wordAt(content, 16) != kJsonChunk)
        refuseFile(path, "not a whole glTF file: its first chunk is no JSON");
    if (length > content.size() - 20)
        refuseFile(path, "not a whole glTF file: its JSON is cut off (" +
                             std::to_string(content.size() - 20) + " of " + std::to_string(length) +
                             " bytes)");
    chunks.json = std::string_view(content).substr(20, length);
    for (std::size_t at = chunkAt(content, 20 + length); at + 8 <= content.size();) {
        const std::size_t claimed = wordAt(content, at), present = content.size() - at - 8;
        if (wordAt(content, at + 4) == kBinaryChunk) {
            chunks.binary = std::string_view(content).substr(at + 8, std::min(claimed, present));
            chunks.missing = claimed > present ? claimed - present : 0;
            break;
        }
        if (claimed > present) break;
        at = chunkAt(content, at + 8 + claimed);
    }
    return chunks;
}

const GltfJson* gltfMember(const GltfJson& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() || found->is_null() ? nullptr : &*found;
}

const GltfJson* gltfExtension(const GltfJson& object, const char* name) {
    const GltfJson* extensions = gltfMember(object, "extensions");
    return extensions ? gltfMember(*extensions, name) : nullptr;
}

std::string gltfShown(const std::string& text) {
    std::string shown = text.substr(0, 100);
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return shown;
}

GltfFile::GltfFile(const std::string& path, const std::string& content, const RunContext& ctx)
    : mPath(path), mContent(content), mContext(ctx) {
    const GltfChunks chunks = gltfChunks(path, content);
    bool replaced = false;
    mJson = parsed(path, chunks.json, replaced);
    mBinary = chunks.binary;
    checkVersion(*this, path, mJson);
    checkGltfExtensions(*this, mJson);
    if (replaced) say(MessageLevel::Note, "its JSON is not UTF-8; letters beyond ASCII are read as ?");
    if (chunks.missing > 0)
        say(MessageLevel::Warning,
            "is cut off: the last " + std::to_string(chunks.missing) +
                (chunks.missing == 1 ? " byte of its data is" : " bytes of its data are") +
                " missing; download or export it again");
}

void GltfFile::refuse(const std::string& what) const {
    refuseFile(mPath, what);
}

void GltfFile::say(MessageLevel level, const std::string& what) const {
    message(mContext, level, mPath + ": " + what);
}

std::int64_t GltfFile::defaultScene() const {
    return std::max<std::int64_t>(0, index(mJson, "scene"));
}

const GltfJson& GltfFile::list(const char* name) const {
    static const GltfJson none = GltfJson::array();
    const GltfJson* found = gltfMember(mJson, name);
    if (found && !found->is_array()) refuse("its \"" + std::string(name) + "\" are no list");
    return found ? *found : none;
}

const GltfJson& GltfFile::item(const char* name, std::int64_t index, const char* what) const {
    const GltfJson& all = list(name);
    if (index < 0 || std::uint64_t(index) >= all.size()) refuse(std::string(what) + " does not exist");
    const GltfJson& found = all[std::size_t(index)];
    if (!found.is_object()) refuse(std::string(what) + " is no object");
    return found;
}

std::int64_t GltfFile::index(const GltfJson& object, const char* name) const {
    const GltfJson* found = gltfMember(object, name);
    // Some writers say -1 for none.
    if (!found || *found == -1) return -1;
    return std::int64_t(whole(object, name));
}

namespace {

bool isWhole(const GltfJson& value) {
    const double number = value.is_number() ? value.get<double>() : -1;
    return number >= 0 && number <= 1e15 && number == std::floor(number);
}

}  // namespace

std::vector<std::int64_t> GltfFile::indices(const GltfJson& object, const char* name) const {
    std::vector<std::int64_t> result;
    const GltfJson* found = gltfMember(object, name);
    if (!found) return result;
    const bool good = found->is_array() && std::all_of(found->begin(), found->end(), isWhole);
    if (!good) refuse("\"" + std::string(name) + "\" is not a list of whole numbers");
    for (const GltfJson& value : *found) result.push_back(std::int64_t(value.get<double>()));
    return result;
}

std::uint64_t GltfFile::whole(const GltfJson& object, const char* name, std::uint64_t missing) const {
    const GltfJson* found = gltfMember(object, name);
    if (!found) return missing;
    if (!isWhole(*found)) refuse("\"" + std::string(name) + "\" is not a whole number from 0 to 1e15");
    return std::uint64_t(found->get<double>());
}

std::vector<double> GltfFile::numbers(const GltfJson& object, const char* name, std::size_t size) const {
    std::vector<double> result;
    const GltfJson* found = gltfMember(object, name);
    if (!found) return result;
    const auto isNumber = [](const GltfJson& value) { return value.is_number(); };
    if (!found->is_array() || !std::all_of(found->begin(), found->end(), isNumber))
        refuse("\"" + std::string(name) + "\" is not a list of numbers");
    if (size > 0 && found->size() != size)
        refuse("\"" + std::string(name) + "\" has " + std::to_string(found->size()) + " numbers, not " +
               std::to_string(size));
    for (const GltfJson& value : *found) result.push_back(value.get<double>());
    return result;
}

std::size_t GltfFile::bytes() const {
    std::size_t sum = mContent.size();
    for (const auto& [index, bytes] : mBuffers) sum += bytes.size();
    return sum;
}

}  // namespace vdbsynth
