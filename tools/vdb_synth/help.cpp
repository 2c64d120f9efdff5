#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/options.h"

#include <algorithm>

namespace vdbsynth::cli {
namespace {

constexpr std::size_t kColumn = 30, kWidth = 110;

// Breaks lines at kWidth columns; each begins at kColumn.
std::string wrapped(const std::string& text) {
    std::string lines;
    std::size_t column = kColumn;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        if (column > kColumn && column + 1 + word.size() > kWidth) {
            lines += "\n" + std::string(kColumn, ' ');
            column = kColumn;
        } else if (column > kColumn) {
            lines += ' ';
            ++column;
        }
        lines += word;
        column += word.size();
        at = end + 1;
    }
    return lines;
}

std::string lineOf(const Option& option) {
    std::string left = "  " + (option.letter ? std::string("-") + option.letter + ", " : std::string()) +
                       "--" + option.name + (option.argument.empty() ? "" : " " + option.argument);
    if (left.size() + 1 < kColumn)
        left.resize(kColumn, ' ');
    else
        left += "\n" + std::string(kColumn, ' ');
    return left + wrapped(helpLine(option)) + "\n";
}

}  // namespace

std::string helpText(const Command& command) {
    std::string text = command.summary + "\n\nUsage: vdb_synth " + command.usage + "\n";
    const std::vector<Option>& options = optionsOf(command.name);
    for (std::size_t i = 0; i < options.size(); ++i) {
        if (i == 0 || options[i].group != options[i - 1].group)
            text += std::string("\n") + headingOf(options[i].group) + ":\n";
        text += lineOf(options[i]);
    }
    return text + "\nExample:\n  " + command.example + "\n";
}

}  // namespace vdbsynth::cli
