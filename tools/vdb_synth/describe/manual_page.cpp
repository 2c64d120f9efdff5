#include "tools/vdb_synth/describe/manual_page.h"

#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/doctor/built_with.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/version.h"

#include <cctype>

namespace vdbsynth::cli {
namespace {

std::string bold(const std::string& text) {
    return "\\fB" + roffText(text) + "\\fR";
}

std::string slanted(const std::string& text) {
    return "\\fI" + roffText(text) + "\\fR";
}

std::string section(const std::string& name) {
    return ".SH " + name + "\n";
}

std::string title(const std::string& name) {
    std::string upper;
    for (const char c : name) upper += char(std::toupper(static_cast<unsigned char>(c)));
    return ".\\\" Made by vdb_synth help --man from the descriptions of its options.\n.TH \"" +
           roffText(upper) + "\" 1 " + built::kDate + " \"vdb_synth " + kVersion + "\" \"User Commands\"\n";
}

std::string sentence(std::string text) {
    text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return roffText(text) + ".\n";
}

// What stands for a form of its own: "synth A -o OUT | synth [A] --keep B" are two, the "|" of "--size X,Y |
// --onto MODEL" is a choice within one.
std::vector<std::string> formsOf(const Command& command) {
    std::vector<std::string> forms;
    const std::string between = " | " + command.name + " ";
    std::size_t begin = 0;
    for (std::size_t end; (end = command.usage.find(between, begin)) != std::string::npos; begin = end + 3)
        forms.push_back(command.usage.substr(begin, end - begin));
    forms.push_back(command.usage.substr(begin));
    return forms;
}

std::string synopsis(const Command& command) {
    std::string text = section("SYNOPSIS");
    bool first = true;
    for (const std::string& form : formsOf(command)) {
        text += first ? "" : ".br\n";
        text +=
            bold("vdb_synth " + command.name) + " " + roffText(form.substr(command.name.size() + 1)) + "\n";
        first = false;
    }
    return text;
}

std::string entryOf(const Option& option) {
    std::string text = ".TP\n";
    if (option.letter) text += bold(std::string("-") + option.letter) + ", ";
    text += bold("--" + option.name);
    if (!option.argument.empty()) text += " " + slanted(option.argument);
    return text + "\n" + sentence(helpLine(option));
}

std::string optionsSection(const Command& command) {
    std::string text = section("OPTIONS");
    const std::vector<Option>& options = optionsOf(command.name);
    for (std::size_t i = 0; i < options.size(); ++i) {
        if (i == 0 || options[i].group != options[i - 1].group)
            text += std::string(".SS ") + headingOf(options[i].group) + "\n";
        text += entryOf(options[i]);
    }
    return text;
}

std::string exitStatus() {
    std::string text = section("EXIT STATUS");
    for (const auto& [code, meaning] : {std::pair<const char*, const char*>{"0", "done"},
                                        {"1", "an input can be read but not used"},
                                        {"2", "the command line is wrong"},
                                        {"3", "a file is missing, damaged or cannot be written"},
                                        {"130, 143", "stopped by SIGINT or SIGTERM; files are as they were"}})
        text += std::string(".TP\n") + bold(code) + "\n" + sentence(meaning);
    return text;
}

std::string seeAlso(const std::string& pages) {
    return section("SEE ALSO") + pages + "\n";
}

std::string pageOf(const std::string& name) {
    return bold(name) + "(1)";
}

}  // namespace

std::string roffText(const std::string& text) {
    std::string safe;
    bool lineBegins = true;
    for (const char c : text) {
        if (lineBegins && (c == '.' || c == '\'')) safe += "\\&";
        lineBegins = c == '\n';
        switch (c) {
            case '\\':
                safe += "\\e";
                break;
            case '-':
                safe += "\\-";
                break;
            case '"':
                safe += "\\(dq";
                break;
            case '\'':
                safe += "\\(aq";
                break;
            case '`':
                safe += "\\(ga";
                break;
            case '^':
                safe += "\\(ha";
                break;
            case '~':
                safe += "\\(ti";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

std::string manualPage(const Command& command) {
    const std::string name = "vdb_synth-" + command.name;
    std::string summary = command.summary;
    summary[0] = char(std::tolower(static_cast<unsigned char>(summary[0])));
    return title(name) + section("NAME") + roffText(name) + " \\- " + roffText(summary) + "\n" +
           synopsis(command) + section("DESCRIPTION") + sentence(command.summary) + optionsSection(command) +
           section("EXAMPLE") + ".nf\n" + roffText(command.example) + "\n.fi\n" + exitStatus() +
           seeAlso(pageOf("vdb_synth"));
}

std::string programManual() {
    std::string text =
        title("vdb_synth") + section("NAME") + roffText("vdb_synth - make new geometry from examples") +
        "\n" + section("SYNOPSIS") + bold("vdb_synth") + " " + slanted("COMMAND INPUTS") + " " + bold("-o") +
        " " + slanted("OUTPUT") + roffText(" [options]") + "\n.br\n" + bold("vdb_synth help") +
        roffText(" [--man] [") + slanted("COMMAND") + "]\n.br\n" + bold("vdb_synth completion") +
        roffText(" bash|zsh|fish") + "\n.br\n" + bold("vdb_synth --version") + "\n" + section("DESCRIPTION") +
        sentence(
            "the extension of a file decides its kind. Standard output carries data "
            "only; messages and progress go to standard error. Outputs appear whole or "
            "not at all. The same inputs, options and seed give the same bytes, whatever "
            "the number of threads");
    text += section("COMMANDS");
    std::string pages;
    for (const Command* command : commands()) {
        text += ".TP\n" + bold(command->name) + "\n" + sentence(command->summary);
        pages += (pages.empty() ? "" : ",\n") + pageOf("vdb_synth-" + command->name);
    }
    text += section("ENVIRONMENT");
    text += ".TP\n" + bold("TMPDIR") + "\n" +
            sentence("folder for temporary files of standard input and output; default /tmp");
    text += ".TP\n" + bold("VDBSYNTH_READ_TIMEOUT") + "\n" +
            sentence(
                "seconds without progress after which reading a file is stopped; default 20 and 5 for "
                "each megabyte of the file");
    return text + exitStatus() + seeAlso(pages);
}

}  // namespace vdbsynth::cli
