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

    bool nothing() const { return notes.empty() && warnings.empty(); }
    bool noted(const std::string& part) const { return found(notes, part); }
    bool warned(const std::string& part) const { return found(warnings, part); }
    std::string all() const {
        std::string text;
        for (const auto& list : {notes, warnings})
            for (const std::string& line : list) text += line + "\n";
        return text;
    }

private:
    static bool found(const std::vector<std::string>& said, const std::string& part) {
        for (const std::string& text : said)
            if (text.find(part) != std::string::npos) return true;
        return false;
    }
};

}  // namespace vdbsynth::test
