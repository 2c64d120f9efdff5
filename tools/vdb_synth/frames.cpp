#include "tools/vdb_synth/frames.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace vdbsynth::cli {
namespace {

// The place for a number in a path: its characters, and its least number of digits.
struct FramePlace {
    std::size_t at = std::string::npos, length = 0;
    int digits = 0;
};

FramePlace placeIn(const std::string& path) {
    const std::size_t sign = path.find('#');
    if (sign != std::string::npos) {
        const std::size_t end = std::min(path.find_first_not_of('#', sign), path.size());
        return {sign, end - sign, int(end - sign)};
    }
    // %d, %4d and %04d.
    for (std::size_t at = path.find('%'); at != std::string::npos; at = path.find('%', at + 1)) {
        const std::size_t end = path.find_first_not_of("0123456789", at + 1);
        if (end == std::string::npos || path[end] != 'd' || end - at > 3) continue;
        if (end + 1 < path.size() && std::isalnum(static_cast<unsigned char>(path[end + 1])))
            continue;  // "100%done"
        return {at, end + 1 - at, std::max(1, std::atoi(path.c_str() + at + 1))};
    }
    return {};
}

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

bool namesFrames(const std::string& path) {
    return placeIn(path).length > 0;
}

std::string atFrame(const std::string& path, int frame) {
    const FramePlace place = placeIn(path);
    if (place.length == 0) return path;
    std::string number = std::to_string(frame);
    if (int(number.size()) < place.digits) number.insert(0, std::size_t(place.digits) - number.size(), '0');
    return path.substr(0, place.at) + number + path.substr(place.at + place.length);
}

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
