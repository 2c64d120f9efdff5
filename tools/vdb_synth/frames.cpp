#include "tools/vdb_synth/frames.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>

namespace vdbsynth::cli {
namespace {

// Calls visit(path, written) for every path that the arguments name.
template <typename Visit>
void forPaths(const Arguments& arguments, bool inputsAreOutputs, const Visit& visit) {
    for (const std::string& input : arguments.inputs) visit(input, inputsAreOutputs, std::string());
    for (const Option& option : optionsOf(arguments.command()))
        for (const std::string& value : arguments.all(option.name)) {
            const std::string path = pathIn(option, value);
            // A folder keeps what all frames write to it.
            if (!path.empty() && path != kNoValue && option.kind != Kind::Folder)
                visit(value, !readsPath(option), "--" + option.name + " ");
        }
}

}  // namespace

Arguments atFrame(const Arguments& arguments, int frame) {
    Arguments result = arguments;
    for (std::string& input : result.inputs) input = atFrame(input, frame);
    for (auto& [name, values] : result.values) {
        const Option* option = findOption(arguments.command(), name);
        if (!option) continue;
        for (std::string& value : values)
            if (value != kNoValue && !pathIn(*option, value).empty()) value = atFrame(value, frame);
    }
    return result;
}

void checkFrames(const Arguments& arguments, bool inputsAreOutputs) {
    std::vector<int> frames;
    const bool given = arguments.has("frames") && readFrames(arguments.text("frames"), frames);
    bool any = false;
    forPaths(
        arguments, inputsAreOutputs, [&](const std::string& path, bool written, const std::string& option) {
            const bool names = namesFrames(path);
            any = any || names;
            // A file may be called so; one that is written might be as well, but hardly on purpose.
            // A turntable fills them in itself.
            if (!given && names && written && !arguments.has("turntable") &&
                path.find("##") != std::string::npos)
                throw Error(ErrorCode::InvalidOption,
                            option + path + ": #### stands for the number of a frame; add --frames 1-20");
            if (frames.size() > 1 && !names && written)
                throw Error(ErrorCode::InvalidOption,
                            option + path +
                                ": every frame would replace it; write #### where the "
                                "frame's number is to stand");
        });
    if (given && arguments.has("turntable"))
        throw Error(ErrorCode::InvalidOption, "--turntable and --frames: give one of them");
    if (given && !any)
        throw Error(ErrorCode::InvalidOption,
                    "--frames: no file names frames; write #### where a frame's number stands, as in "
                    "shot.####.vdb");
}

FrameCache::FrameCache(const Arguments& arguments) {
    forPaths(arguments, false, [&](const std::string& path, bool, const std::string&) {
        if (!namesFrames(path)) mShared.insert(path);
    });
}

}  // namespace vdbsynth::cli
