#include "libvdbsynth/io/output_set.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vdbsynth {
namespace {

[[noreturn]] void failIo(const std::string& path, const std::string& what) {
    throw Error(ErrorCode::Io, path + ": " + what + ": " + std::strerror(errno));
}

// A killed process whose parent does not reap it stays in the table as a zombie; it writes no more.
bool stillRuns(pid_t process) {
    if (::kill(process, 0) != 0 && errno == ESRCH) return false;
    std::ifstream status("/proc/" + std::to_string(process) + "/stat");
    std::string line;
    if (!std::getline(status, line)) return true;
    const std::size_t name = line.rfind(") ");
    return name == std::string::npos || (line[name + 2] != 'Z' && line[name + 2] != 'X');
}

// Removes ".NAME.<pid>.tmp" and ".NAME.<pid>-<n>.tmp" of processes that no longer run.
void removeStale(const std::string& folder, const std::string& name) {
    const std::string prefix = "." + name + ".";
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        const std::string found = entry.path().filename().string();
        if (found.size() <= prefix.size() + 4 || found.compare(0, prefix.size(), prefix) != 0 ||
            found.compare(found.size() - 4, 4, ".tmp") != 0)
            continue;
        const std::string middle = found.substr(prefix.size(), found.size() - prefix.size() - 4);
        const std::string digits = middle.substr(0, middle.find('-'));
        pid_t process = 0;
        if (digits.find_first_not_of("0123456789") != std::string::npos || !parseWhole(digits, process))
            continue;
        if (!stillRuns(process)) std::filesystem::remove(entry.path(), ignored);
    }
}

// Which folder a path means now.
struct FolderIdentity {
    dev_t device = 0;
    ino_t number = 0;
    bool operator==(const FolderIdentity& other) const {
        return device == other.device && number == other.number;
    }
};

FolderIdentity identityOf(const std::string& folder) {
    struct stat status {};
    if (::stat(folder.c_str(), &status) != 0) return {};
    return {status.st_dev, status.st_ino};
}

// Temporary files of this process, and the folders they were created in: two concurrent calls may write one
// file, for example a cached index.
class NamesInUse {
public:
    std::string take(const std::string& beginning) {
        const std::lock_guard<std::mutex> lock(mMutex);
        const FolderIdentity folder = identityOf(folderOf(beginning));
        std::string name = beginning + ".tmp";
        for (int n = 2; !mNames.insert({name, folder}).second; ++n)
            name = beginning + "-" + std::to_string(n) + ".tmp";
        return name;
    }
    // False once a folder's name means another one, as when a share was unmounted.
    bool inSameFolder(const std::string& name) {
        const std::lock_guard<std::mutex> lock(mMutex);
        return mNames.at(name) == identityOf(folderOf(name));
    }
    void giveBack(const std::string& name) {
        const std::lock_guard<std::mutex> lock(mMutex);
        mNames.erase(name);
    }

private:
    std::mutex mMutex;
    std::map<std::string, FolderIdentity> mNames;
};

NamesInUse& namesInUse() {
    static NamesInUse names;
    return names;
}

// A result written into another folder of that name would be lost under a share that comes back. File systems
// that number their folders anew, or mount themselves again, still show the file reserved before.
void requireSameFolder(const std::string& temporary, const std::string& path) {
    if (::access(temporary.c_str(), F_OK) == 0 || namesInUse().inSameFolder(temporary)) return;
    throw Error(
        ErrorCode::Io,
        path +
            ": cannot be written: the folder is gone, or another than at the start; was a share unmounted?");
}

void syncToDisk(const std::string& temporary, const std::string& path) {
    const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) failIo(path, "cannot be written");
    const int result = ::fsync(file);
    const int reason = errno;
    ::close(file);
    errno = reason;
    if (result != 0 && reason != EINVAL) failIo(path, "writing failed");
}

}  // namespace

OutputSet::OutputSet(std::function<void(const std::string&)> onTemporary)
    : mOnTemporary(std::move(onTemporary)) {}

OutputSet::~OutputSet() {
    for (const Entry& entry : mEntries) {
        ::unlink(entry.temporary.c_str());
        namesInUse().giveBack(entry.temporary);
    }
}

void OutputSet::reserve(const std::string& path) {
    for (const Entry& entry : mEntries)
        if (entry.path == path) return;
    open(path);
}

std::string OutputSet::add(const std::string& path) {
    for (Entry& entry : mEntries) {
        if (entry.path != path) continue;
        if (entry.taken) throw Error(ErrorCode::InvalidOption, path + ": named as an output twice");
        requireSameFolder(entry.temporary, path);
        entry.taken = true;
        return entry.temporary;
    }
    open(path);
    mEntries.back().taken = true;
    return mEntries.back().temporary;
}

void OutputSet::open(const std::string& path) {
    struct stat status {};
    std::string target = path;
    if (::stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) throw Error(ErrorCode::Io, path + ": is a directory; name a file");
        if (!S_ISREG(status.st_mode))
            throw Error(ErrorCode::Io, path + ": is not a regular file; name a file to write");
        // Through a link, the file it points to is the output.
        std::error_code problem;
        const std::filesystem::path real = std::filesystem::canonical(path, problem);
        if (!problem) target = real.string();
    }
    const std::string folder = folderOf(target), name = fileNameOf(target);
    if (::stat(folder.c_str(), &status) != 0)
        throw Error(ErrorCode::Io, path + ": the folder " + folder + " does not exist");
    std::error_code problem;
    const std::string unique = (std::filesystem::canonical(folder, problem) / name).string();
    for (const Entry& entry : mEntries)
        if (entry.unique == unique)
            throw Error(ErrorCode::InvalidOption,
                        path + ": the same file as " + entry.path + "; named as an output twice");
    removeStale(folder, name);
    const std::string temporary = namesInUse().take(folder + "/." + name + "." + std::to_string(::getpid()));
    if (mOnTemporary) mOnTemporary(temporary);
    ::unlink(temporary.c_str());
    const int file = ::open(temporary.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_NOFOLLOW | O_CLOEXEC, 0666);
    const int reason = errno;
    if (file < 0) {
        namesInUse().giveBack(temporary);
        // The folder is there: one of the system's own, as /proc.
        if (reason == ENOENT && ::stat(folder.c_str(), &status) == 0)
            throw Error(ErrorCode::Io, path + ": cannot be written: " + folder + " takes no new files");
        errno = reason;
        failIo(path, "cannot be written");
    }
    ::close(file);
    mEntries.push_back({path, target, unique, temporary, false});
}

std::string OutputSet::withoutTemporaries(std::string text) const {
    for (const Entry& entry : mEntries)
        for (std::size_t at; (at = text.find(entry.temporary)) != std::string::npos;)
            text.replace(at, entry.temporary.size(), entry.path);
    return text;
}

void OutputSet::commit() {
    // A reserved but unwritten temporary file would replace a good file by an empty one.
    const auto unwritten = std::stable_partition(mEntries.begin(), mEntries.end(),
                                                 [](const Entry& entry) { return entry.taken; });
    for (auto entry = unwritten; entry != mEntries.end(); ++entry) ::unlink(entry->temporary.c_str());
    mEntries.erase(unwritten, mEntries.end());
    for (const Entry& entry : mEntries) syncToDisk(entry.temporary, entry.path);
    while (!mEntries.empty()) {
        const Entry entry = mEntries.front();
        if (::rename(entry.temporary.c_str(), entry.target.c_str()) != 0)
            failIo(entry.path, "cannot be written");
        namesInUse().giveBack(entry.temporary);
        mEntries.erase(mEntries.begin());
    }
}

}  // namespace vdbsynth
