#include "tools/vdb_synth/batch/executor/output_locks.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

// Two names of one file have one lock.
std::string lockPath(const std::string& output) {
    std::error_code problem;
    std::filesystem::path real = std::filesystem::weakly_canonical(output, problem);
    if (problem) real = output;
    return folderOf(real.string()) + "/." + fileNameOf(real.string()) + ".batch.tmp";
}

// True if the file of this path is the one that is open: its last owner may have removed it meanwhile.
bool isStill(const std::string& path, int file) {
    struct stat named {
    }, opened{};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(file, &opened) == 0 &&
           named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

int locked(const std::string& path, const std::string& output) {
    for (;;) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (file < 0) throw Error(ErrorCode::Io, output + ": cannot be written: " + std::strerror(errno));
        if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
            ::close(file);
            throw Error(ErrorCode::Io,
                        output + ": another batch writes it now; wait for it, or give another output");
        }
        if (isStill(path, file)) return file;
        ::close(file);
    }
}

}  // namespace

OutputLocks::OutputLocks(const Plan& plan, const Job& job) {
    try {
        for (const std::string& output : job.writes) {
            const std::string path = lockPath(inFolder(plan, output));
            mFiles.emplace_back(path, locked(path, output));
        }
    } catch (const Error&) {
        release();
        throw;
    }
}

OutputLocks::~OutputLocks() {
    release();
}

void OutputLocks::release() {
    for (const auto& [path, file] : mFiles) {
        ::unlink(path.c_str());
        ::close(file);
    }
    mFiles.clear();
}

}  // namespace vdbsynth::cli::batch
