#include "tools/vdb_synth/batch/referred_files.h"

#include "libvdbsynth/io/path.h"

#include <cstdlib>
#include <fstream>
#include <set>

#include <sys/stat.h>

namespace vdbsynth::cli::batch {
namespace {

void addFile(const std::string& folder, std::string name, std::set<std::string>& files) {
    while (!name.empty() && (name.back() == '\r' || name.back() == ' ')) name.pop_back();
    struct stat status {};
    std::string problem;
    if (name.empty() || name.size() > 4096) return;
    const std::string path = pathBelow(folder, name, problem);
    if (problem.empty() && ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) files.insert(path);
}

std::string unescaped(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i)
        if (uri[i] == '%' && i + 2 < uri.size()) {
            text += char(std::strtol(uri.substr(i + 1, 2).c_str(), nullptr, 16));
            i += 2;
        } else {
            text += uri[i];
        }
    return text;
}

// What follows a keyword: the whole rest, which may hold spaces, and its last word, as options may stand
// before.
void readLines(const std::string& path, const std::string& keyword, std::set<std::string>& files) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        const std::size_t at = line.find_first_not_of(" \t");
        if (at == std::string::npos || line.compare(at, keyword.size(), keyword) != 0) continue;
        const std::size_t space = line.find_first_of(" \t", at);
        if (space == std::string::npos) continue;
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
        const std::size_t begin = line.find_first_not_of(" \t", space), last = line.find_last_of(" \t");
        if (begin == std::string::npos) continue;
        addFile(folderOf(path), line.substr(begin), files);
        if (last + 1 > begin) addFile(folderOf(path), line.substr(last + 1), files);
    }
}

// Every string of the text after "uri".
void readUris(const std::string& path, std::set<std::string>& files) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || status.st_size > 256000000) return;
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (std::size_t at = text.find("\"uri\""); at != std::string::npos; at = text.find("\"uri\"", at + 5)) {
        const std::size_t begin = text.find('"', at + 5), end = text.find('"', begin + 1);
        if (begin == std::string::npos || end == std::string::npos) return;
        if (text.compare(begin + 1, 5, "data:") == 0) continue;
        addFile(folderOf(path), unescaped(text.substr(begin + 1, end - begin - 1)), files);
    }
}

}  // namespace

std::vector<std::string> referredFiles(const std::string& path) {
    std::set<std::string> files;
    const std::string extension = extensionOf(path);
    if (extension == "gltf") readUris(path, files);
    if (extension == "obj") {
        readLines(path, "mtllib", files);
        const std::set<std::string> materials = files;
        for (const std::string& material : materials) {
            readLines(material, "map_", files);
            readLines(material, "norm", files);
            readLines(material, "bump", files);
        }
    }
    return {files.begin(), files.end()};
}

}  // namespace vdbsynth::cli::batch
