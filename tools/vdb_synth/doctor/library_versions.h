#pragma once
#include <string>
#include <vector>

namespace vdbsynth::cli {

/// A shared library that this process has loaded.
struct LoadedLibrary {
    std::string name;     ///< "libopenvdb"
    std::string version;  ///< of its file: "10.0.1" of libopenvdb.so.10.0.1; empty if the name has none
    std::string file;     ///< name of the file that links lead to, without its folder
};

/// Splits "libz.so.1.2.13" into name and version.
LoadedLibrary libraryOfFile(const std::string& file);

/// All libraries of this process, in the order they were loaded. The kernel's own (vdso) is left out.
std::vector<LoadedLibrary> loadedLibraries();

/// A library as the program was built with it and as it runs.
struct LibraryVersion {
    std::string name;   ///< "OpenVDB"
    std::string built;  ///< version the program was compiled with; empty if the build does not know it
    std::string runs;   ///< version that runs, as the library or its file tells; empty if neither does
    std::string file;   ///< the file loaded; empty for libraries of headers only, and where it is linked in
    bool differs = false;  ///< built and runs are both known, of one scheme, and not equal
};

/// The libraries the program uses, the most telling first.
/// @par Cost  under a millisecond: names and functions of what is loaded already
std::vector<LibraryVersion> libraryVersions();

/// "OpenVDB 10.0.1 (libopenvdb.so.10.0.1)"; where they differ "zlib 1.3 (built with 1.2.13; libz.so.1.3)".
std::string libraryLine(const LibraryVersion& library);

}  // namespace vdbsynth::cli
