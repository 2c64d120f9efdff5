#include "libvdbsynth/base/run_context.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

#include <algorithm>
#include <utility>

namespace vdbsynth {

void throwIfCancelled(const RunContext& ctx) {
    if (ctx.cancel && ctx.cancel->load(std::memory_order_relaxed))
        throw Error(ErrorCode::Cancelled, "interrupted; nothing was written");
}

void message(const RunContext& ctx, MessageLevel level, const std::string& text) {
    if (ctx.onMessage) ctx.onMessage(level, text);
}

void requireMemory(const RunContext& ctx, double bytes, const std::string& what, const std::string& hint) {
    if (ctx.maxMemory == 0 || bytes <= double(ctx.maxMemory)) return;
    throw Error(ErrorCode::Memory, what + " needs about " + roundedText(bytes / 1e9, 3) +
                                       " GB, over `maxMemory` " +
                                       roundedText(double(ctx.maxMemory) / 1e9, 3) + " GB; " + hint);
}

Stage::Stage(const RunContext& ctx, std::string name, std::size_t total, bool reading) : mContext(ctx) {
    mProgress.stage = std::move(name);
    mProgress.total = std::max<std::size_t>(total, 1);
    mProgress.reading = reading;
    throwIfCancelled(ctx);
    if (ctx.onProgress) ctx.onProgress(mProgress);
}

void Stage::advance(std::size_t units) {
    throwIfCancelled(mContext);
    mProgress.done = std::min(mProgress.done + units, mProgress.total);
    if (!mContext.onProgress) return;
    if (mProgress.done < mProgress.total && (mProgress.done - mReported) * 100 < mProgress.total) return;
    mReported = mProgress.done;
    mContext.onProgress(mProgress);
}

}  // namespace vdbsynth
