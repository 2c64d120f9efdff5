#include "tools/vdb_synth/option_set.h"

#include "libvdbsynth/base/error.h"
#include "tools/vdb_synth/options.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <cctype>

namespace po = boost::program_options;

namespace vdbsynth::cli {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

po::options_description describe(const std::vector<Option>& options) {
    po::options_description description;
    for (const Option& option : options) {
        const std::string names = option.letter ? option.name + "," + option.letter : option.name;
        if (option.kind == Kind::Flag)
            description.add_options()(names.c_str(), "");
        else
            description.add_options()(names.c_str(), po::value<std::vector<std::string>>(), "");
    }
    description.add_options()("inputs", po::value<std::vector<std::string>>(), "");
    return description;
}

// "--option" whose value may be left out becomes "--option=" or "--option=value".
std::vector<std::string> bindOptionalValues(const std::vector<Option>& options,
                                            const std::vector<std::string>& words) {
    std::vector<std::string> bound;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto optional = std::find_if(options.begin(), options.end(), [&](const Option& o) {
            return o.valueOptional && (words[i] == "--" + o.name || words[i] == "-" + o.name);
        });
        bound.push_back(words[i]);
        if (optional == options.end()) continue;
        const std::string ending = "." + optional->extensions.front();
        const std::string next = i + 1 < words.size() ? words[i + 1] : "";
        const bool hasValue = next.size() > ending.size() &&
                              next.compare(next.size() - ending.size(), ending.size(), ending) == 0;
        bound.back() += "=" + (hasValue ? words[++i] : kNoValue);
    }
    return bound;
}

// Boost would take "-.obj", the name of a stream, for an option: it is passed with another first letter.
constexpr char kStreamMark = '\x01';

std::vector<std::string> hideStreams(std::vector<std::string> words) {
    for (std::string& word : words)
        if (word.size() > 2 && word.compare(0, 2, "-.") == 0 &&
            std::isalpha(static_cast<unsigned char>(word[2])))
            word[0] = kStreamMark;
    return words;
}

std::vector<std::string> shownStreams(std::vector<std::string> words) {
    for (std::string& word : words)
        if (!word.empty() && word[0] == kStreamMark) word[0] = '-';
    return words;
}

std::string dashed(std::string name) {
    while (!name.empty() && name[0] == '-') name.erase(0, 1);
    return name.substr(0, name.find('='));
}

void take(Arguments& arguments, const po::option& given) {
    const std::vector<std::string> value = shownStreams(given.value);
    if (given.string_key == "inputs") {
        arguments.inputs.insert(arguments.inputs.end(), value.begin(), value.end());
        return;
    }
    auto& values = arguments.values[given.string_key];
    if (value.empty())
        values = {"true"};
    else
        values.insert(values.end(), value.begin(), value.end());
}

}  // namespace

bool Arguments::takes(const std::string& name) const {
    return findOption(mCommand, name) != nullptr;
}

std::string Arguments::text(const std::string& name) const {
    const auto it = values.find(name);
    if (it != values.end() && !it->second.empty()) return it->second.front();
    const Option* option = findOption(mCommand, name);
    return option ? option->initial : "";
}

std::vector<std::string> Arguments::all(const std::string& name) const {
    const auto it = values.find(name);
    return it == values.end() ? std::vector<std::string>{} : it->second;
}

void Arguments::check() const {
    for (const auto& [name, given] : values)
        if (const Option* option = findOption(mCommand, name))
            for (const std::string& value : given)
                if (value != kNoValue || !option->valueOptional) normalValue(*option, value);
}

std::map<std::string, std::vector<std::string>> Arguments::normalised() const {
    std::map<std::string, std::vector<std::string>> normal;
    for (const Option& option : optionsOf(mCommand)) {
        if (option.incidental) continue;
        std::vector<std::string> given = all(option.name);
        if (given.empty() && !option.initial.empty()) given = {option.initial};
        for (std::string& value : given) value = normalValue(option, value);
        if (!given.empty()) normal[option.name] = given;
    }
    return normal;
}

int Arguments::whole(const std::string& name) const {
    // Not given and no default: 0, which means the default in the library's structs.
    double value = 0;
    readReal(text(name), value);
    return int(value);
}

double Arguments::real(const std::string& name) const {
    double value = 0;
    readReal(text(name), value);
    return value;
}

std::uint64_t Arguments::wide(const std::string& name) const {
    std::uint64_t value = 0;
    const Option* option = findOption(mCommand, name);
    if (option && option->kind == Kind::Bytes)
        readBytes(text(name), value);
    else
        readSeed(text(name), value);
    return value;
}

std::array<double, 3> Arguments::triple(const std::string& name) const {
    std::array<double, 3> parts{};
    readWorldTriple(text(name), parts);  // of other units the `w` was refused
    return parts;
}

Index3 Arguments::wholeTriple(const std::string& name) const {
    Index3 parts{0, 0, 0};
    readWholeTriple(text(name), parts);
    return parts;
}

std::vector<double> Arguments::lengths(const std::string& name) const {
    std::vector<double> lengths;
    if (has(name)) readLengths(text(name), lengths);
    return lengths;
}

std::pair<double, double> Arguments::range(const std::string& name) const {
    std::pair<double, double> ends{0, 0};
    readRange(text(name), ends.first, ends.second);
    return ends;
}

BoxValue Arguments::box(const std::string& name) const {
    BoxValue box;
    readBox(text(name), box);
    return box;
}

std::array<SizeValue, 2> Arguments::sheetSizes(const std::string& name) const {
    std::array<SizeValue, 2> sizes;
    readSheetSizes(text(name), sizes);
    return sizes;
}

std::array<SizeValue, 3> Arguments::sizes(const std::string& name) const {
    std::array<SizeValue, 3> sizes;
    readSizes(text(name), sizes);
    return sizes;
}

std::array<int, 2> Arguments::pixels(const std::string& name) const {
    std::array<int, 2> size{};
    readPixels(text(name), size[0], size[1]);
    return size;
}

SliceValue Arguments::slice(const std::string& name) const {
    SliceValue slice;
    readSlice(text(name), slice);
    return slice;
}

std::vector<std::pair<double, double>> Arguments::labels(const std::string& name) const {
    std::vector<std::pair<double, double>> labels;
    if (has(name)) readLabels(text(name), labels);
    return labels;
}

std::array<bool, 3> Arguments::axes(const std::string& name) const {
    std::array<bool, 3> axes{};
    readAxes(text(name), axes);
    return axes;
}

Arguments parseArguments(const std::string& command, const std::vector<std::string>& words) {
    const std::vector<Option>& options = optionsOf(command);
    const po::options_description description = describe(options);
    po::positional_options_description positional;
    positional.add("inputs", -1);
    namespace style = po::command_line_style;
    const int flags = (style::unix_style | style::allow_long_disguise) & ~style::allow_guessing;
    Arguments arguments(command);
    try {
        const po::parsed_options parsed =
            po::command_line_parser(hideStreams(bindOptionalValues(options, words)))
                .options(description)
                .positional(positional)
                .style(flags)
                .run();
        for (const po::option& given : parsed.options) take(arguments, given);
    } catch (const po::unknown_option& e) {
        refuse(unknownOption(command, dashed(e.get_option_name())));
    } catch (const po::error_with_option_name& e) {
        refuse("--" + dashed(e.get_option_name()) + ": needs a value; see --help");
    } catch (const po::error& e) {
        refuse(std::string(e.what()) + "; see --help");
    }
    for (const Option& option : options)
        if (!option.repeats && arguments.all(option.name).size() > 1)
            refuse("--" + option.name + ": given twice");
    return arguments;
}

}  // namespace vdbsynth::cli
