// Buffers of glTF: the binary chunk, base64 in the JSON, files beside it.
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/base64.h"
#include "libvdbsynth/io/readers/mesh_readers_gltf_steps.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <algorithm>
#include <filesystem>
#include <new>

namespace vdbsynth {
namespace {

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// %20 is a blank; a % without two digits is itself.
std::string percentDecoded(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape =
            text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
        decoded += escape ? char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return decoded;
}

std::string dataBytes(const std::string& path, const std::string& uri) {
    const std::size_t comma = uri.find(',');
    const std::string_view text =
        std::string_view(uri).substr(comma == std::string::npos ? uri.size() : comma + 1);
    std::string bytes;
    if (uri.rfind(";base64", comma) == std::string::npos) return percentDecoded(text);
    // Some writers escape + / = as in an address.
    const std::string plain = text.find('%') == std::string_view::npos ? std::string() : percentDecoded(text);
    bytes.reserve(text.size() / 4 * 3);
    decodeBase64(path, plain.empty() ? text : plain, 0, std::string::npos, bytes);
    return bytes;
}

// The file that a URI names: as it should be, else as careless writers mean it: not escaped, or with the
// slashes of Windows. `problem` as of pathBelow.
std::string fileOf(const std::string& folder, const std::string& uri, std::string& problem) {
    std::string slashes = uri;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const std::string first = pathBelow(folder, percentDecoded(uri), problem);
    if (!problem.empty()) return first;
    for (const std::string& name : {percentDecoded(uri), uri, percentDecoded(slashes)}) {
        std::string wrong;
        const std::string path = pathBelow(folder, name, wrong);
        std::error_code ignored;
        if (wrong.empty() && std::filesystem::exists(path, ignored)) return path;
    }
    return first;
}

}  // namespace

std::string_view GltfFile::buffer(std::int64_t index) const {
    const GltfJson& described = item("buffers", index, "a buffer");
    // A buffer that stands for decompressed data has none.
    const bool own = !gltfMember(described, "uri") && gltfCompression(described).empty();
    if (index == 0 && own && mBinary.data()) return mBinary;
    const auto known = mBuffers.find(index);
    return known != mBuffers.end() ? known->second
                                   : mBuffers.emplace(index, bufferBytes(index)).first->second;
}

std::string GltfFile::bufferBytes(std::int64_t index) const {
    const GltfJson* member = gltfMember(item("buffers", index, "a buffer"), "uri");
    if (!member || !member->is_string())
        refuse("its buffer " + std::to_string(index) + " names no file and has no data of its own");
    const std::string& uri = member->get_ref<const std::string&>();
    if (uri.compare(0, 5, "data:") == 0) return dataBytes(mPath, uri);
    std::string problem;
    const std::string path = fileOf(folderOf(mPath), uri, problem);
    if (!problem.empty()) refuse("its file \"" + gltfShown(uri) + "\" " + problem);
    try {
        return readWholeFile(path);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        std::string reason = error.what();
        // Escapes may be bytes that are no text.
        if (uri.find('%') != std::string::npos) reason = gltfShown(reason);
        refuse(reason);
    }
}

}  // namespace vdbsynth
