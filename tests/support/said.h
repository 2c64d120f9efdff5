#pragma once
#include "libvdbsynth/base/run_context.h"

#include <string>
#include <vector>

namespace vdbsynth::test {

/// What a run says: notes and warnings, one a line.
struct Said {
    RunContext ctx;
    std::vector<std::string> notes{}, warnings{};

    Said() {
        ctx.onMessage = [this](MessageLevel level, const std::string& text) {
            if (level == MessageLevel::Note) notes.push_back(text);
            if (level == MessageLevel::Warning) warnings.push_back(text);
        };
    }
    Said(const Said&) = delete;
    Said& operator=(const Said&) = delete;

    std::string all() const {
        std::string text;
        for (const auto& list : {notes, warnings})
            for (const std::string& line : list) text += line + "\n";
        return text;
    }
};

}  // namespace vdbsynth::test
