#pragma once
#include "libvdbsynth/base/run_context.h"

#include <openvdb/util/NullInterrupter.h>

namespace vdbsynth {

/// Lets OpenVDB's tools stop when the context is cancelled. Pass it as util::NullInterrupter&: a tool
/// instantiated for this type itself takes 37 s to compile instead of 8 s.
class Interrupter final : public openvdb::util::NullInterrupter {
public:
    explicit Interrupter(const RunContext& ctx) : mContext(ctx) {}
    bool wasInterrupted(int = -1) override {
        return mContext.cancel && mContext.cancel->load(std::memory_order_relaxed);
    }

private:
    const RunContext& mContext;
};

}  // namespace vdbsynth
