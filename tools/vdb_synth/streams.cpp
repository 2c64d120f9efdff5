#include "tools/vdb_synth/streams.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vdbsynth::cli {
namespace {

// "-" or "-.EXT"; a file of that name is "./-.EXT".
bool isStream(const std::string& path) {
    return path == "-" || path.compare(0, 2, "-.") == 0;
}

// True if --as names a kind of file, not what to write: "mesh" is what to write; MEDIT files are -.mesh.
bool namesExtension(const std::string& as) {
    return as != "mesh" && isKnownExtension(as);
}

[[noreturn]] void failFull() {
    throw Error(ErrorCode::Io, "standard input: does not fit on the disk of temporary files");
}

// @throw Error Io for what is not written, Cancelled
void writeAll(int file, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t put = ::write(file, bytes, count);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) failFull();
        bytes += put;
        count -= std::size_t(put);
    }
}

void readAll(int file, std::string& start) {
    std::vector<char> buffer(1 << 20);
    for (;;) {
        const ssize_t got = ::read(0, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR)
            throw Error(ErrorCode::Cancelled, "interrupted while reading standard input");
        if (got < 0)
            throw Error(ErrorCode::Io, std::string("standard input cannot be read: ") + std::strerror(errno));
        if (got == 0) return;
        if (start.size() < 4096) start.append(buffer.data(), std::size_t(got));
        writeAll(file, buffer.data(), std::size_t(got));
    }
}

}  // namespace

Streams::~Streams() {
    for (const Stream& stream : mStreams) ::unlink(stream.temporary.c_str());
    if (!mFolder.empty()) ::rmdir(mFolder.c_str());
}

std::string Streams::open(const std::string& name, const std::string& extension, bool output) {
    if (mFolder.empty()) {
        std::error_code problem;
        const std::filesystem::path place = std::filesystem::temp_directory_path(problem);
        if (problem) throw Error(ErrorCode::Io, "there is no folder for temporary files; set TMPDIR");
        // Others can write to that folder too and could place a link under a predictable name. mkdtemp's name
        // is unpredictable, and only this user can open the folder.
        std::string folder = (place / "vdb_synth.XXXXXX").string();
        if (!::mkdtemp(folder.data()))
            throw Error(ErrorCode::Io,
                        place.string() + ": no temporary folder can be made: " + std::strerror(errno));
        mFolder = folder;
        mOnTemporary(mFolder);
    }
    const std::string temporary = mFolder + (output ? "/out" : "/in") + extension;
    mOnTemporary(temporary);
    mStreams.push_back({name, temporary, output});
    return temporary;
}

void Streams::readInput(std::string& path, const Arguments& arguments) {
    std::string extension = path.substr(1);
    const std::string as = arguments.text("as");
    if (extension.empty() && namesExtension(as)) extension = "." + as;
    const std::string temporary = open(path, extension, false);
    std::string start;
    const int file =
        ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file < 0) failFull();
    try {
        readAll(file, start);
    } catch (...) {
        ::close(file);
        throw;
    }
    if (::close(file) != 0) failFull();
    if (start.empty()) throw Error(ErrorCode::BadData, path + ": standard input is empty");
    path = temporary;
    if (!extension.empty()) return;
    const std::string guess = extensionOfContent(start);
    if (guess.empty())
        throw Error(ErrorCode::InvalidOption,
                    "-: the kind of file on standard input is unknown; name it -.EXT, for example -.obj");
    path = open("-", "." + guess, false);
    if (::rename(temporary.c_str(), path.c_str()) != 0)
        throw Error(ErrorCode::Io, "standard input: its temporary file cannot be renamed");
}

Arguments Streams::spooled(Arguments arguments, bool inputsAreOutputs) {
    int inputs = 0, outputs = 0;
    for (const std::string& path : arguments.inputs) (inputsAreOutputs ? outputs : inputs) += isStream(path);
    for (const std::string& path : arguments.all("output")) outputs += isStream(path);
    const std::string as = arguments.text("as");
    const bool plain =
        std::find(arguments.inputs.begin(), arguments.inputs.end(), "-") != arguments.inputs.end();
    if (namesExtension(as) && !plain)
        throw Error(ErrorCode::InvalidOption,
                    "--as " + as + ": is the kind of file on standard input, but no input is -");
    if (inputs > 1) throw Error(ErrorCode::InvalidOption, "standard input can be one input only");
    if (outputs > 1)
        throw Error(ErrorCode::InvalidOption, "--output: standard output can take one output only");
    for (auto* paths : {inputsAreOutputs ? &arguments.inputs : nullptr,
                        outputs > 0 && arguments.has("output") ? &arguments.values["output"] : nullptr})
        for (std::size_t i = 0; paths && i < paths->size(); ++i) {
            std::string& path = (*paths)[i];
            if (!isStream(path)) continue;
            if (path == "-")
                throw Error(
                    ErrorCode::InvalidOption,
                    "--output -: give the kind of file for standard output as -.EXT, for example -.ply");
            path = open(path, path.substr(1), true);
        }
    for (std::string& path : arguments.inputs)
        if (!inputsAreOutputs && isStream(path)) readInput(path, arguments);
    return arguments;
}

void Streams::release() {
    for (const Stream& stream : mStreams) {
        if (!stream.output) continue;
        std::ifstream file(stream.temporary, std::ios::binary);
        std::vector<char> buffer(1 << 20);
        while (file.read(buffer.data(), std::streamsize(buffer.size())) || file.gcount() > 0)
            for (std::streamsize at = 0; at < file.gcount();) {
                const ssize_t put = ::write(1, buffer.data() + at, std::size_t(file.gcount() - at));
                if (put < 0 && errno == EINTR) continue;
                if (put < 0)
                    throw Error(ErrorCode::Io,
                                std::string("standard output cannot be written: ") + std::strerror(errno));
                at += put;
            }
    }
}

std::string Streams::named(std::string text) const {
    for (const Stream& stream : mStreams)
        for (std::size_t at; (at = text.find(stream.temporary)) != std::string::npos;)
            text.replace(at, stream.temporary.size(), stream.name);
    return text;
}

}  // namespace vdbsynth::cli
