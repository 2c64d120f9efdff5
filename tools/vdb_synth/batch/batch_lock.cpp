#include "tools/vdb_synth/batch/batch_lock.h"

#include "libvdbsynth/base/error.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace vdbsynth::cli::batch {
namespace {

int opened(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) throw Error(ErrorCode::Io, path + ": cannot be written: " + std::strerror(errno));
    return file;
}

// The file of the jobs' lock, once nobody holds it against `kind`.
int lockedJobs(const std::string& folder, int kind, const RunContext& ctx) {
    const int file = opened(folder + "/jobs.lock");
    try {
        for (int tries = 0; ::flock(file, kind | LOCK_NB) != 0; ++tries) {
            if (tries == 0)
                message(ctx, MessageLevel::Note,
                        folder + ": waiting for the last jobs of a batch that was killed");
            throwIfCancelled(ctx);
            if (tries == 150)
                throw Error(ErrorCode::Io,
                            folder + ": jobs of a batch that was killed still run; end them first");
            ::usleep(100000);
        }
    } catch (const Error&) {
        ::close(file);
        throw;
    }
    return file;
}

}  // namespace

BatchLock::BatchLock(const std::string& folder, bool jobsHere, const RunContext& ctx) {
    mBatch = opened(folder + "/batch.lock");
    if (::flock(mBatch, LOCK_EX | LOCK_NB) != 0) {
        ::close(mBatch);
        throw Error(ErrorCode::Io,
                    folder + ": another batch runs here; wait for it, or give another --logs FOLDER");
    }
    if (!jobsHere) return;
    try {
        mJobs = lockedJobs(folder, LOCK_EX, ctx);
    } catch (const Error&) {
        ::close(mBatch);
        throw;
    }
}

BatchLock::~BatchLock() {
    if (mJobs >= 0) ::close(mJobs);
    ::close(mBatch);
}

JobsLock::JobsLock(const std::string& folder, const RunContext& ctx)
    : mFile(lockedJobs(folder, LOCK_SH, ctx)) {}

JobsLock::~JobsLock() {
    ::close(mFile);
}

}  // namespace vdbsynth::cli::batch
