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

}  // namespace

BatchLock::BatchLock(const std::string& folder, const RunContext& ctx) {
    mBatch = opened(folder + "/batch.lock");
    if (::flock(mBatch, LOCK_EX | LOCK_NB) != 0) {
        ::close(mBatch);
        throw Error(ErrorCode::Io,
                    folder + ": another batch runs here; wait for it, or give another --logs FOLDER");
    }
    try {
        mJobs = opened(folder + "/jobs.lock");
        for (int tries = 0; ::flock(mJobs, LOCK_EX | LOCK_NB) != 0; ++tries) {
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
        ::close(mBatch);
        if (mJobs >= 0) ::close(mJobs);
        throw;
    }
}

BatchLock::~BatchLock() {
    ::close(mJobs);
    ::close(mBatch);
}

}  // namespace vdbsynth::cli::batch
