#include "libvdbsynth/io/path.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <utility>

namespace vdbsynth {

std::string fileNameOf(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::string extensionOf(const std::string& path) {
    const std::string name = fileNameOf(path);
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0) return "";
    std::string extension = name.substr(dot + 1);
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

std::string readExtensionOf(const std::string& path) {
    const std::string extension = extensionOf(path);
    return extension == "gz" ? extensionOf(path.substr(0, path.size() - 3)) : extension;
}

std::string folderOf(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return ".";
    return slash == 0 ? "/" : path.substr(0, slash);
}

std::string pathBelow(const std::string& folder, const std::string& name, std::string& problem) {
    namespace fs = std::filesystem;
    const fs::path relative = fs::path(name).lexically_normal();
    if (name.find('\0') != std::string::npos)
        problem = "is not a valid file name";
    else if (name.find("://") != std::string::npos)
        problem = "is an address; only files in or below the folder of the file that names it are read";
    else if (relative.is_absolute() || (!relative.empty() && *relative.begin() == ".."))
        problem =
            "is outside the folder of the file that names it; only files in or below that folder are read";
    return (fs::path(folder) / relative).string();
}

bool isKnownExtension(const std::string& extension) {
    static const std::set<std::string> known{
        "vdb", "obj", "ply", "stl",  "off", "mesh", "gltf",   "glb", "3mf",   "xyz",   "pwn",
        "pcd", "pts", "txt", "asc",  "csv", "xyzn", "xyzrgb", "png", "jpg",   "jpeg",  "pgm",
        "ppm", "pnm", "tif", "tiff", "exr", "npy",  "vti",    "nii", "sgems", "gslib", "inr"};
    return known.count(extension.size() > 3 && extension.compare(extension.size() - 3, 3, ".gz") == 0
                           ? extension.substr(0, extension.size() - 3)
                           : extension) > 0;
}

std::string extensionOfContent(const std::string& start) {
    static const std::pair<std::string, const char*> beginnings[] = {
        {" BDV", "vdb"},
        {"ply", "ply"},
        {"glTF", "glb"},
        {"PK\x03\x04", "3mf"},
        {"\x89PNG", "png"},
        {"\xff\xd8\xff", "jpg"},
        {"II*", "tif"},
        {"MM", "tif"},
        {"II+", "tif"},
        {"\x76\x2f\x31\x01", "exr"},
        {"\x93NUMPY", "npy"},
        {"#INRIMAGE", "inr"},
        {"# .PCD", "pcd"},
        {"VERSION", "pcd"},
        {"P2", "pgm"},
        {"P3", "ppm"},
        {"P5", "pgm"},
        {"P6", "ppm"},
        {"OFF", "off"},
        {"COFF", "off"},
        {"NOFF", "off"},
        {"solid", "stl"},
        {"MeshVersionFormatted", "mesh"},
        {"<VTKFile", "vti"},
        {std::string("\x5c\x01\x00\x00", 4), "nii"}};
    for (const auto& [bytes, extension] : beginnings)
        if (start.compare(0, bytes.size(), bytes) == 0) return extension;
    if (start.compare(0, 5, "<?xml") == 0 && start.find("<VTKFile") != std::string::npos) return "vti";
    return "";
}

}  // namespace vdbsynth
