#include "tools/vdb_synth/doctor/doctor_report.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "tools/vdb_synth/doctor/built_with.h"
#include "tools/vdb_synth/doctor/library_versions.h"
#include "tools/vdb_synth/doctor/machine.h"
#include "tools/vdb_synth/version.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace vdbsynth::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kLittleSpace = 1000000000;  // [bytes] a result and its temporaries may need that

// What the compiler was told to use; a processor without it ends the program with signal 4.
const char* compiledFor() {
#if defined(__AVX512F__)
    return "AVX-512";
#elif defined(__AVX2__)
    return "AVX2";
#elif defined(__AVX__)
    return "AVX";
#elif defined(__SSE4_2__)
    return "SSE4.2";
#else
    return "the least of its processors";
#endif
}

Json bytesOrNull(std::uint64_t bytes) {
    return bytes == kNoLimit ? Json() : Json(bytes);
}

Json programJson() {
    return {{"name", "vdb_synth"},
            {"version", kVersion},
            {"build_type", *built::kType ? built::kType : "none"},
            {"compiler", built::kCompiler},
            {"built_for", built::kProcessor},
            {"instructions", compiledFor()},
            {"sanitizers", built::kSanitizers},
            {"tiff", std::string(built::kTiff) == "ON"}};
}

Json librariesJson() {
    Json all = Json::array();
    for (const LibraryVersion& library : libraryVersions())
        all.push_back({{"name", library.name},
                       {"built", library.built},
                       {"runs", library.runs},
                       {"file", library.file},
                       {"differs", library.differs}});
    return all;
}

Json processorJson(const RunContext& context) {
    const ProcessorFacts facts = processorFacts();
    return {{"model", facts.model},
            {"instructions", facts.instructions},
            {"present", facts.present},
            {"usable", facts.usable},
            {"group_share", facts.share > 0 ? Json(facts.share) : Json()},
            {"threads", context.threads > 0 ? context.threads : facts.usable}};
}

Json memoryJson(const RunContext& context) {
    const MemoryFacts facts = memoryFacts();
    return {{"present", facts.present},
            {"available", facts.available},
            {"swap", facts.swap},
            {"group_limit", bytesOrNull(facts.group)},
            {"most_used", context.maxMemory}};
}

Json limitsJson() {
    Json limits = Json::object();
    for (const auto& [name, value] : processLimits()) limits[name] = bytesOrNull(value);
    return limits;
}

Json folderJson(const std::string& path) {
    const FolderFacts facts = folderFacts(path);
    return {{"there", facts.there}, {"writable", facts.writable}, {"free", facts.free}};
}

Json temporaryJson() {
    std::error_code problem;
    const std::string path = std::filesystem::temp_directory_path(problem).string();
    Json json = folderJson(path);
    // A folder that the user chose may name the user.
    json["from"] = path == "/tmp" ? path : "TMPDIR";
    return json;
}

Json localeJson() {
    const LocaleFacts facts = localeFacts();
    Json variables = Json::object();
    for (const auto& [name, value] : facts.variables) variables[name] = value;
    return {{"variables", variables}, {"installed", facts.installed}, {"decimal_point", facts.decimalPoint}};
}

Json terminalJson() {
    const TerminalFacts facts = terminalFacts();
    return {{"input", facts.input},     {"output", facts.output}, {"error", facts.error},
            {"columns", facts.columns}, {"rows", facts.rows},     {"type", facts.type}};
}

Json ownVariables() {
    Json variables = Json::object();
    for (const char* name : {"VDBSYNTH_READ_TIMEOUT"})
        if (const char* value = std::getenv(name)) variables[name] = value;
    return variables;
}

std::string gigabytes(double bytes) {
    if (bytes < 1e9) return roundedText(bytes / 1e6, 3) + " MB";
    return roundedText(bytes / 1e9, 3) + " GB";
}

std::string gigabytes(const Json& bytes) {
    return bytes.is_null() ? "no limit" : gigabytes(bytes.get<double>());
}

Json notesOn(const Json& report) {
    Json notes = Json::array();
    for (const Json& library : report.at("libraries"))
        if (library.at("differs"))
            notes.push_back(library.at("name").get<std::string>() + " " +
                            library.at("runs").get<std::string>() + " runs, but the program was built with " +
                            library.at("built").get<std::string>());
    if (!report.at("program").at("sanitizers").get<std::string>().empty())
        notes.push_back("this build has sanitizers and is slow");
    const std::string type = report.at("program").at("build_type");
    if (type != "Release" && type != "RelWithDebInfo" && type != "MinSizeRel")
        notes.push_back("this build (" + type + ") is not optimised and is slow");
    for (const char* place : {"temporary", "working_folder"}) {
        const Json& folder = report.at(place);
        const std::string name =
            std::string(place) == "temporary" ? "the folder for temporary files" : "the working folder";
        if (!folder.at("there").get<bool>())
            notes.push_back(name + " is not there; set TMPDIR to one that is");
        else if (!folder.at("writable").get<bool>())
            notes.push_back(name + " is not writable");
        else if (folder.at("free").get<std::uint64_t>() < kLittleSpace)
            notes.push_back(name + " has only " + gigabytes(folder.at("free")) + " free");
    }
    for (const char* name : {"virtual memory", "data", "file size"})
        if (!report.at("limits").at(name).is_null())
            notes.push_back(std::string("the limit of ") + name + " is " +
                            gigabytes(report.at("limits").at(name)) + " (ulimit); more is refused");
    if (!report.at("locale").at("installed").get<bool>())
        notes.push_back("the locale of the environment is not installed; results do not depend on it");
    return notes;
}

std::string yesNo(const Json& value, const char* yes, const char* no) {
    return value.get<bool>() ? yes : no;
}

std::string limitText(const std::string& name, const Json& value) {
    if (value.is_null()) return name + " no limit";
    if (name == "open files" || name == "processes") return name + " " + value.dump();
    if (name == "processor time") return name + " " + value.dump() + " s";
    return name + " " + gigabytes(value);
}

std::string folderText(const Json& folder) {
    if (!folder.at("there").get<bool>()) return "is not there";
    return gigabytes(folder.at("free")) + " free, " +
           yesNo(folder.at("writable"), "writable", "not writable");
}

std::string programText(const Json& p) {
    const std::string sanitizers = p.at("sanitizers");
    return p.at("build_type").get<std::string>() + ", " + p.at("compiler").get<std::string>() + ", " +
           p.at("built_for").get<std::string>() + " (" + p.at("instructions").get<std::string>() + "), " +
           yesNo(p.at("tiff"), "with TIFF", "without TIFF") +
           (sanitizers.empty() ? "" : ", sanitizers " + sanitizers);
}

std::string processorText(const Json& p) {
    const std::string model = p.at("model"), instructions = p.at("instructions");
    return (model.empty() ? "unknown" : model) + (instructions.empty() ? "" : " (" + instructions + ")") +
           "; " + p.at("usable").dump() + " of " + p.at("present").dump() + " usable, control group allows " +
           (p.at("group_share").is_null() ? "all" : roundedText(p.at("group_share").get<double>(), 3)) +
           ", threads used " + p.at("threads").dump();
}

std::string memoryText(const Json& m) {
    return gigabytes(m.at("present")) + ", " + gigabytes(m.at("available")) + " available, swap " +
           gigabytes(m.at("swap")) + ", control group " + gigabytes(m.at("group_limit")) + ", used at most " +
           gigabytes(m.at("most_used"));
}

std::string localeText(const Json& locale) {
    std::string text;
    for (const auto& [name, value] : locale.at("variables").items())
        text += name + "=" + value.get<std::string>() + " ";
    return (text.empty() ? "none set " : text) + "(" +
           (locale.at("installed").get<bool>()
                ? "decimal point " + locale.at("decimal_point").get<std::string>()
                : "not installed") +
           ")";
}

std::string terminalText(const Json& t) {
    std::string streams;
    for (const char* name : {"input", "output", "error"})
        if (t.at(name).get<bool>()) streams += (streams.empty() ? "" : ", ") + std::string(name);
    std::string text = streams.empty() ? "no standard stream is one" : "standard " + streams;
    if (t.at("columns").get<int>() > 0) text += ", " + t.at("columns").dump() + "x" + t.at("rows").dump();
    const std::string type = t.at("type");
    return text + (type.empty() ? "" : ", TERM=" + type);
}

std::string lineOf(const std::string& name, const std::string& text) {
    std::string left = name;
    left.resize(16, ' ');
    return left + printableText(text) + "\n";
}

}  // namespace

Json doctorReport(const RunContext& context) {
    const SystemFacts system = systemFacts();
    Json report{
        {"program", programJson()},
        {"libraries", librariesJson()},
        {"system", {{"name", system.name}, {"kernel", system.kernel}, {"container", system.container}}},
        {"processor", processorJson(context)},
        {"memory", memoryJson(context)},
        {"limits", limitsJson()},
        {"temporary", temporaryJson()},
        {"working_folder", folderJson(".")},
        {"locale", localeJson()},
        {"terminal", terminalJson()},
        {"variables", ownVariables()}};
    report["notes"] = notesOn(report);
    return report;
}

std::string doctorText(const Json& report) {
    const Json& system = report.at("system");
    std::string name = system.at("name");
    std::string text =
        lineOf("program", "vdb_synth " + report.at("program").at("version").get<std::string>());
    text += lineOf("built", programText(report.at("program")));
    for (const Json& library : report.at("libraries")) {
        const LibraryVersion version{library.at("name"), library.at("built"), library.at("runs"),
                                     library.at("file"), library.at("differs")};
        text += lineOf(&library == &report.at("libraries").front() ? "libraries" : "", libraryLine(version));
    }
    text +=
        lineOf("system", (name.empty() ? "unknown" : name) + ", " + system.at("kernel").get<std::string>() +
                             yesNo(system.at("container"), ", in a container", ""));
    text += lineOf("processor", processorText(report.at("processor")));
    text += lineOf("memory", memoryText(report.at("memory")));
    std::string limits;
    for (const auto& [limit, value] : report.at("limits").items())
        limits += (limits.empty() ? "" : ", ") + limitText(limit, value);
    text += lineOf("limits", limits);
    text += lineOf("temporary files", report.at("temporary").at("from").get<std::string>() + ": " +
                                          folderText(report.at("temporary")));
    text += lineOf("working folder", folderText(report.at("working_folder")));
    text += lineOf("locale", localeText(report.at("locale")));
    text += lineOf("terminal", terminalText(report.at("terminal")));
    for (const auto& [variable, value] : report.at("variables").items())
        text += lineOf("variable", variable + "=" + value.get<std::string>());
    for (const Json& note : report.at("notes")) text += lineOf("note", note.get<std::string>());
    if (report.at("notes").empty()) text += lineOf("note", "nothing here looks wrong");
    return text;
}

std::string versionText() {
    const std::vector<LibraryVersion> libraries = libraryVersions();
    const std::string& runs = libraries.front().runs;
    std::string text =
        std::string("vdb_synth ") + kVersion + " (OpenVDB " + (runs.empty() ? kOpenVdbVersion : runs) + ")\n";
    for (const LibraryVersion& library : libraries) text += "  " + libraryLine(library) + "\n";
    return text;
}

}  // namespace vdbsynth::cli
