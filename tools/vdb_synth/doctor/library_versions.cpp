#include "tools/vdb_synth/doctor/library_versions.h"

#include "tools/vdb_synth/doctor/built_with.h"
#include "tools/vdb_synth/version.h"

#include <algorithm>
#include <cstdlib>

#include <dlfcn.h>
#include <gnu/libc-version.h>
#include <link.h>

namespace vdbsynth::cli {
namespace {

// Libraries are asked by name, as their headers belong to the rooms that use them.
template <typename Function>
Function* function(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
}

std::string textFrom(const char* name) {
    const auto tell = function<const char*()>(name);
    const char* text = tell ? tell() : nullptr;
    return text ? text : "";
}

std::string pngVersion() {
    const auto tell = function<const char*(const void*)>("png_get_libpng_ver");
    return tell ? tell(nullptr) : "";
}

// "LIBTIFF, Version 4.5.0" and lines of copyright.
std::string tiffVersion() {
    const std::string text = textFrom("TIFFGetVersion"), before = "Version ";
    const std::size_t at = text.find(before);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + before.size();
    return text.substr(begin, text.find('\n', begin) - begin);
}

std::string openExrVersion() {
    const auto tell = function<void(int*, int*, int*, const char**)>("exr_get_library_version");
    if (!tell) return "";
    int major = 0, minor = 0, patch = 0;
    const char* extra = nullptr;
    tell(&major, &minor, &patch, &extra);
    return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

std::string xxhashVersion() {
    const auto tell = function<unsigned()>("XXH_versionNumber");
    if (!tell) return "";
    const unsigned number = tell();
    return std::to_string(number / 10000) + "." + std::to_string(number / 100 % 100) + "." +
           std::to_string(number % 100);
}

std::string withFile(const std::string& name, const std::string& file) {
    return file.empty() ? name : name + " (" + file + ")";
}

enum class Scheme {
    File,  // the file's version is the library's
    Tells  // the file's is another count, of its interface
};

struct Entry {
    const char *name, *built, *library;  // the library's name begins so; null: headers only
    Scheme scheme;
    std::string tells;
};

std::vector<Entry> table() {
    return {{"OpenVDB", kOpenVdbVersion, "libopenvdb", Scheme::File, ""},
            {"TBB", built::kTbb, "libtbb", Scheme::Tells, textFrom("TBB_runtime_version")},
            {"Boost", built::kBoost, "libboost_program_options", Scheme::File, ""},
            {"Blosc", "", "libblosc", Scheme::Tells, textFrom("blosc_get_version_string")},
            {"zlib", built::kZlib, "libz", Scheme::Tells, textFrom("zlibVersion")},
            {"libpng", built::kPng, "libpng16", Scheme::Tells, pngVersion()},
            {"libtiff", built::kTiffLibrary, "libtiff", Scheme::Tells, tiffVersion()},
            {"libjpeg", "", "libjpeg", Scheme::File, ""},
            {"OpenEXR", built::kOpenExr, "libOpenEXR", Scheme::Tells, openExrVersion()},
            {"pugixml", built::kPugixml, "libpugixml", Scheme::File, ""},
            {"yaml-cpp", built::kYaml, "libyaml-cpp", Scheme::File, ""},
            {"LZ4", "", "liblz4", Scheme::Tells, textFrom("LZ4_versionString")},
            {"xxHash", "", "libxxhash", Scheme::Tells, xxhashVersion()},
            {"nlohmann-json", built::kJson, nullptr, Scheme::File, ""},
            {"Eigen", built::kEigen, nullptr, Scheme::File, ""},
            {"nanoflann", built::kNanoflann, nullptr, Scheme::File, ""},
            {"libstdc++", "", "libstdc++", Scheme::File, ""},
            {"glibc", "", "libc", Scheme::Tells, ::gnu_get_libc_version()}};
}

// "libOpenEXR-3_1" is libOpenEXR, "libz" is not libzstd.
bool isNamed(const LoadedLibrary& library, const std::string& name) {
    if (library.name.compare(0, name.size(), name) != 0) return false;
    return library.name.size() == name.size() || library.name[name.size()] == '-';
}

// "1.74" and "1.74.0" are one version, "2021.8" and "2021.8.0" too.
bool sameVersion(std::string a, std::string b) {
    const auto cut = [](std::string& text) {
        while (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
    };
    cut(a);
    cut(b);
    return a == b;
}

int addLibrary(dl_phdr_info* info, std::size_t, void* to) {
    const std::string path = info->dlpi_name ? info->dlpi_name : "";
    if (path.find('/') == std::string::npos) return 0;  // the program itself, and the kernel's
    char* real = ::realpath(path.c_str(), nullptr);
    const std::string found = real ? real : path;
    std::free(real);
    static_cast<std::vector<LoadedLibrary>*>(to)->push_back(
        libraryOfFile(found.substr(found.rfind('/') + 1)));
    return 0;
}

}  // namespace

LoadedLibrary libraryOfFile(const std::string& file) {
    LoadedLibrary library;
    library.file = file;
    const std::size_t ending = file.find(".so");
    library.name = file.substr(0, ending);
    if (ending != std::string::npos && file.size() > ending + 4) library.version = file.substr(ending + 4);
    return library;
}

std::vector<LoadedLibrary> loadedLibraries() {
    std::vector<LoadedLibrary> libraries;
    ::dl_iterate_phdr(addLibrary, &libraries);
    return libraries;
}

std::vector<LibraryVersion> libraryVersions() {
    const std::vector<LoadedLibrary> loaded = loadedLibraries();
    std::vector<LibraryVersion> versions;
    for (const Entry& entry : table()) {
        LibraryVersion version;
        version.name = entry.name;
        version.built = entry.built;
        version.runs = entry.tells;
        const auto library = std::find_if(loaded.begin(), loaded.end(), [&](const LoadedLibrary& one) {
            return entry.library && isNamed(one, entry.library);
        });
        if (library != loaded.end()) {
            version.file = library->file;
            if (entry.scheme == Scheme::File) version.runs = library->version;
        }
        version.differs =
            !version.built.empty() && !version.runs.empty() && !sameVersion(version.built, version.runs);
        if (!version.built.empty() || !version.runs.empty()) versions.push_back(version);
    }
    return versions;
}

std::string libraryLine(const LibraryVersion& library) {
    if (!library.differs)
        return withFile(library.name + " " + (library.runs.empty() ? library.built : library.runs),
                        library.file);
    return library.name + " " + library.runs + " (built with " + library.built +
           (library.file.empty() ? "" : "; " + library.file) + ")";
}

}  // namespace vdbsynth::cli
