#pragma once
#include "libvdbsynth/io/frame_path.h"
#include "tools/vdb_synth/option_set.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace vdbsynth::cli {

using vdbsynth::atFrame;  // of a path
using vdbsynth::namesFrames;
/// The arguments of a frame.
Arguments atFrame(const Arguments& arguments, int frame);

/// Refuses --frames without a path that names frames, several frames with an output that does not, and paths
/// that name frames without --frames. @throw Error InvalidOption
void checkFrames(const Arguments& arguments, bool inputsAreOutputs);

/// What the frames of one run share: models that are the same for all of them, and what was made of these
/// alone.
class FrameCache {
public:
    /// @param arguments  before frames are filled in
    explicit FrameCache(const Arguments& arguments);

    /// True if what a path names is the same for every frame.
    bool isShared(const std::string& path) const { return mShared.count(path) > 0; }
    /// What was kept under a name, or what `make` returns, kept.
    template <typename T>
    std::shared_ptr<T> kept(const std::string& name, const std::function<std::shared_ptr<T>()>& make) {
        std::shared_ptr<void>& place = mKept[name];
        if (!place) place = make();
        return std::static_pointer_cast<T>(place);
    }

private:
    std::set<std::string> mShared;
    std::map<std::string, std::shared_ptr<void>> mKept;
};

}  // namespace vdbsynth::cli
