#include "libvdbsynth/io/readers/whole_file.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/readers/gzip.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <sys/stat.h>

namespace vdbsynth {

std::string readWholeFile(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) throw Error(ErrorCode::Io, path + ": no such file");
    if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::Io, path + ": is a directory; name a file");
    if (!S_ISREG(status.st_mode)) throw Error(ErrorCode::Io, path + ": is not a regular file");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(ErrorCode::Io, path + ": cannot be read: " + std::strerror(errno));
    std::string text;
    if (S_ISREG(status.st_mode)) text.reserve(std::size_t(status.st_size));
    char buffer[1 << 16];
    while (file.read(buffer, sizeof buffer) || file.gcount() > 0)
        text.append(buffer, std::size_t(file.gcount()));
    if (file.bad()) throw Error(ErrorCode::Io, path + ": reading failed");
    return isGzip(text) ? gunzip(path, text) : text;
}

void writeWholeFile(const std::string& path, const std::string& content) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!file) throw Error(ErrorCode::Io, path + ": cannot be written: " + std::strerror(errno));
    file.write(content.data(), std::streamsize(content.size()));
    file.close();
    if (!file) throw Error(ErrorCode::Io, path + ": writing failed: " + std::strerror(errno));
}

}  // namespace vdbsynth
